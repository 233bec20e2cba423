// An operation gone through again with the gripper that was chosen for it, by the collision checker.
#include "mmgrasp/gripper_design/rehearse_operation.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/grasp/detail/motion_looks.hpp"

namespace mmgrasp {
namespace {

constexpr double kStep = 0.0005, kTurn = 0.01;  // [m], [rad] between two looks
constexpr double kRetreat = 0.1;                // [m]
constexpr double kOff = 2e-5;                   // Between pad and part while it is held [m].

/// A folder that is there for the while.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string text = (std::filesystem::temp_directory_path() / "mmgrasp-gripper-XXXXXX").string();
    if (mkdtemp(text.data()) == nullptr) throw IoError("'" + text + "': cannot make a folder for the gripper's files");
    path_ = text;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string with_end(const std::string& text, const std::string& more) {
  std::string out = text;
  return out.replace(out.rfind("</robot>"), std::string::npos, more + "</robot>\n");
}

/// Six joints from "assembly" to "base".
std::string carrying_joints() {
  const std::vector<std::pair<std::string, std::string>> axes{{"x", "1 0 0"}, {"y", "0 1 0"}, {"z", "0 0 1"}};
  std::string out = "<link name=\"assembly\"/>", parent = "assembly";
  for (int i = 0; i < 6; ++i) {
    const bool slides = i < 3;
    const auto& [letter, axis] = axes[slides ? i : 5 - i];
    const std::string joint = (slides ? "to_" : "about_") + letter, child = i == 5 ? "base" : "after_" + joint;
    const std::string reach = slides ? "1e6" : "6.3";
    if (i < 5) out += "<link name=\"" + child + "\"/>";
    out += "<joint name=\"" + joint + "\" type=\"" + (slides ? "prismatic" : "revolute") + "\"><parent link=\"" +
           parent + "\"/><child link=\"" + child + "\"/><axis xyz=\"" + axis + "\"/><limit lower=\"-" + reach +
           "\" upper=\"" + reach + "\" effort=\"1\" velocity=\"1\"/></joint>";
    parent = child;
  }
  return out;
}

World world_of(const std::vector<PlacedMesh>& parts) {
  World world;
  for (const PlacedMesh& part : parts) world.add(part.name, MeshShape{part.mesh}, part.pose);
  return world;
}

Eigen::VectorXd configuration(const Pose& T) {
  Eigen::VectorXd q(6);
  q << T.translation(), rpy_from_rotation(T.linear()).reverse();
  return q;
}

}  // namespace

JointGroup free_gripper(const Gripper& gripper) {
  const ScratchFolder folder;
  gripper.to_urdf(folder.path());
  const auto files = gripper.files();
  const std::string chain = "<group name=\"carried\"><chain base_link=\"assembly\" tip_link=\"base\"/></group>";
  const Robot robot =
      Robot::from_strings(with_end(files.at("gripper.urdf"), carrying_joints()),
                          with_end(files.at("gripper.srdf"), chain), {}, folder.path() + "/gripper.urdf");
  return robot.group("carried");
}

std::string rehearse_operation(const Gripper& gripper, const AssemblyGrasp& grasp, const AssemblyOperation& operation) {
  grasp.check();
  operation.check();
  const JointGroup group = free_gripper(gripper);
  Pose T_tips_base = Pose::Identity();
  T_tips_base.translation().z() = -(gripper.palm_height + gripper.finger_length);
  const Pose T_active_base = grasp.T_active_tool * T_tips_base;
  const double stroke = (gripper.max_opening - gripper.min_opening) / 2;
  const double held = std::min((grasp.opening - gripper.min_opening) / 2 + kOff, stroke);
  // Bodies that just touch are free, as where finger lengths are found.
  const double opened = std::clamp((grasp.opening - gripper.min_opening) / 2 + grasp.clearance - kOff, held, stroke);
  Poses approach, arrival, way, retreat;
  const Poses moves = detail::motion_looks(operation.motion, detail::middle_of(operation.active), kStep, kTurn);
  for (const Pose& move : moves) way.push_back(move * T_active_base);
  for (double back = 0; back < kRetreat; back += kStep) {
    Pose away = Pose::Identity();
    away.translation().z() = -back;
    approach.push_back(T_active_base * away);
    arrival.push_back(moves.front() * T_active_base * away);
    retreat.push_back(moves.back() * T_active_base * away);
  }
  struct Stage {
    const char* name;
    const std::vector<PlacedMesh>& parts;
    double joint;
    const Poses& poses;
  };
  const Poses at_grasp{T_active_base};
  for (const Stage& stage :
       {Stage{"the approach", operation.active, opened, approach},
        Stage{"the approach", operation.passive, opened, arrival}, Stage{"the grasp", operation.active, held, at_grasp},
        Stage{"the motion", operation.passive, held, way}, Stage{"letting go", operation.passive, opened, retreat}}) {
    if (stage.parts.empty()) continue;
    const Eigen::VectorXd fingers = group.robot().values({{"finger_1_joint", std::max(stage.joint, 0.0)}});
    CollisionChecker checker(group.with_reference(fingers), world_of(stage.parts));
    for (const Pose& pose : stage.poses) {
      detail::throw_if_interrupted();
      const Eigen::VectorXd q = configuration(pose);
      if (checker.is_free(q)) continue;
      const Contact contact = checker.first_contact(q).value();
      return contact.a + " meets " + contact.b + " during " + stage.name;
    }
  }
  return "";
}

}  // namespace mmgrasp
