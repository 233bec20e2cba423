#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/detail/json_value.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::detail {

/// A JSON value as text, with its key.
using JsonMember = std::pair<std::string, std::string>;

std::string json_object(const std::vector<JsonMember>& members);
std::string json_array(const std::vector<std::string>& values);

template <class Range, class Text>
std::string json_array_of(const Range& range, const Text& text) {
  std::vector<std::string> values;
  for (const auto& value : range) values.push_back(text(value));
  return json_array(values);
}

inline std::string json_bool(bool value) {
  return value ? "true" : "false";
}
std::string json_numbers(const Eigen::Ref<const Eigen::VectorXd>& values);
std::string json_numbers(const std::vector<double>& values);
std::string json_texts(const std::vector<std::string>& texts);
/// xyz and quat_xyzw.
std::string json_pose(const Pose& T);
/// As plan.json has shapes; `name` stands in messages. Throws InvalidInput for a shape that it has not.
std::string json_shapes(const std::vector<LinkShape>& shapes, const std::string& name);
/// SHA-256 of a file's content, quoted.
std::string json_file_sha256(const std::string& path);

}  // namespace mmgrasp::detail
