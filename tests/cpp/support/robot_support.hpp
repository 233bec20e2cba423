#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <kdl/chain.hpp>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

/// Shared test data; tests that need it skip when it is absent.
#define MMGRASP_NEEDS_SHARED_DATA()                               \
  if (!std::filesystem::exists(std::string(MMGRASP_SHARED_DATA))) \
  GTEST_SKIP() << "no shared test data at " << MMGRASP_SHARED_DATA

namespace mmgrasp::testing_support {

inline std::string shared(const std::string& path) {
  return std::string(MMGRASP_SHARED_DATA) + "/" + path;
}

inline Robot load_kinematics(const std::string& urdf, const std::string& srdf = "", BaseKind base = BaseKind::fixed) {
  RobotOptions options;
  options.load_meshes = false;
  options.base = base;
  return Robot::load(shared(urdf), srdf.empty() ? "" : shared(srdf), options);
}

inline Robot panda() {
  return load_kinematics("robots/panda/expanded/panda.urdf",
                         "robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf");
}

inline Robot tiago(BaseKind base = BaseKind::diff_drive) {
  return load_kinematics("robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf",
                         "robots/tiago/tiago_moveit_config/config/srdf/tiago_no-ee.srdf", base);
}

inline KDL::Frame to_kdl(const Pose& T) {
  const Eigen::Matrix3d& R = T.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          KDL::Vector(T(0, 3), T(1, 3), T(2, 3))};
}

/// The way from the root to a link as a KDL chain. Joints that do not move stand at zero.
inline KDL::Chain kdl_chain(const Robot& robot, int tip) {
  std::vector<const Joint*> path;
  for (int link = tip; link > 0; link = path.back()->parent_link)
    path.push_back(&robot.joints()[robot.links()[link].parent_joint]);
  KDL::Chain chain;
  for (auto it = path.rbegin(); it != path.rend(); ++it) {
    const Joint& joint = **it;
    const KDL::Frame T = to_kdl(joint.T_parent_joint);
    const KDL::Vector axis(joint.axis[0], joint.axis[1], joint.axis[2]);
    KDL::Joint moving{KDL::Joint::Fixed};
    if (joint.type == JointType::revolute || joint.type == JointType::continuous)
      moving = KDL::Joint(joint.name, T.p, T.M * axis, KDL::Joint::RotAxis);
    if (joint.type == JointType::prismatic) moving = KDL::Joint(joint.name, T.p, T.M * axis, KDL::Joint::TransAxis);
    chain.addSegment(KDL::Segment(joint.name, moving, T));
  }
  return chain;
}

/// Just enough JSON to read the reference files: objects, arrays, numbers and plain strings.
struct Json {
  std::map<std::string, Json> object;
  std::vector<Json> array;
  std::string string;
  double number = 0;

  const Json& operator[](const std::string& key) const { return object.at(key); }
  Eigen::VectorXd vector() const {
    Eigen::VectorXd v(static_cast<Eigen::Index>(array.size()));
    for (std::size_t i = 0; i < array.size(); ++i) v[static_cast<Eigen::Index>(i)] = array[i].number;
    return v;
  }

  static Json read(const std::string& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    const std::string content = text.str();
    std::size_t at = 0;
    return parse(content, at);
  }

 private:
  static void skip(const std::string& text, std::size_t& at) {
    while (at < text.size() &&
           (std::isspace(static_cast<unsigned char>(text[at])) || text[at] == ',' || text[at] == ':'))
      ++at;
  }
  static std::string parse_string(const std::string& text, std::size_t& at) {
    const std::size_t end = text.find('"', at + 1);
    std::string result = text.substr(at + 1, end - at - 1);
    at = end + 1;
    return result;
  }
  static Json parse(const std::string& text, std::size_t& at) {
    Json value;
    skip(text, at);
    if (text.at(at) == '{') {
      for (skip(text, ++at); text.at(at) != '}'; skip(text, at)) {
        const std::string key = parse_string(text, at);
        value.object[key] = parse(text, at);
      }
      ++at;
    } else if (text.at(at) == '[') {
      for (skip(text, ++at); text.at(at) != ']'; skip(text, at)) value.array.push_back(parse(text, at));
      ++at;
    } else if (text.at(at) == '"') {
      value.string = parse_string(text, at);
    } else {
      std::size_t used = 0;
      value.number = std::stod(text.substr(at, 40), &used);
      at += used;
    }
    return value;
  }
};

}  // namespace mmgrasp::testing_support
