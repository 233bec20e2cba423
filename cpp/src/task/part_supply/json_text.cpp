#include "task/part_supply/json_text.hpp"

#include <type_traits>
#include <variant>

#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/sha256.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

std::string json_shape(const LinkShape& shape, const std::string& name) {
  std::vector<JsonMember> members = {{"type", json_quoted(shape_kind(shape.shape))},
                                     {"pose", json_pose(shape.T_link_shape)}};
  std::visit(
      [&](const auto& body) {
        using Body = std::decay_t<decltype(body)>;
        if constexpr (std::is_same_v<Body, Box>) {
          members.emplace_back("size", json_numbers(body.size));
        } else if constexpr (std::is_same_v<Body, Sphere>) {
          members.emplace_back("radius", json_number(body.radius));
        } else if constexpr (std::is_same_v<Body, Cylinder> || std::is_same_v<Body, Capsule>) {
          members.emplace_back("radius", json_number(body.radius));
          members.emplace_back("length", json_number(body.length));
        } else {
          if (!std::is_same_v<Body, MeshShape> || shape.mesh_path.empty()) {
            throw InvalidInput(name + ": a " + shape_kind(shape.shape) +
                               " cannot be written to a plan: use boxes, cylinders, spheres or mesh files");
          }
          members.emplace_back("file", json_quoted(shape.mesh_path));
          members.emplace_back("scale", json_numbers(shape.mesh_scale));
          members.emplace_back("sha256", json_file_sha256(shape.mesh_path));
        }
      },
      shape.shape);
  return json_object(members);
}

}  // namespace

std::string json_object(const std::vector<JsonMember>& members) {
  std::string text = "{";
  for (const auto& [key, value] : members) text += (text.size() > 1 ? ", " : "") + json_quoted(key) + ": " + value;
  return text + "}";
}

std::string json_array(const std::vector<std::string>& values) {
  std::string text = "[";
  for (const std::string& value : values) text += (text.size() > 1 ? ", " : "") + value;
  return text + "]";
}

std::string json_numbers(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return json_numbers(std::vector<double>(values.data(), values.data() + values.size()));
}

std::string json_numbers(const std::vector<double>& values) {
  return json_array_of(values, json_number);
}

std::string json_texts(const std::vector<std::string>& texts) {
  return json_array_of(texts, json_quoted);
}

std::string json_pose(const Pose& T) {
  return json_object({{"xyz", json_numbers(Eigen::Vector3d(T.translation()))},
                      {"quat_xyzw", json_numbers(quat_xyzw_from_rotation(T.linear()))}});
}

std::string json_shapes(const std::vector<LinkShape>& shapes, const std::string& name) {
  return json_array_of(shapes, [&](const LinkShape& shape) { return json_shape(shape, name); });
}

std::string json_file_sha256(const std::string& path) {
  return json_quoted(sha256(file_content(path, "mesh")));
}

}  // namespace mmgrasp::detail
