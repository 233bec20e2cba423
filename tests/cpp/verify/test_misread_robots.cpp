#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <vector>

#include "verify/spoiled_plan.hpp"

// Plans made with a robot that was read wrongly. The planners knew the gantry of tiny_world.hpp, and the plan is good
// for it; the URDF that was given says what a fault of our reader would have turned into that gantry.
namespace tiny {
namespace {

using mmgrasp::Robot;

/// One fault of a reader: `text` of the gantry's URDF stood really as `truth`.
struct Misreading {
  const char* name;
  std::string text, truth;
  std::string where, quantity;  ///< What "robot-differs" must name.
  std::string code;             ///< What else is wrong with the plan, found without knowing the misread robot.
};

std::ostream& operator<<(std::ostream& out, const Misreading& m) {
  return out << m.name;
}

/// The hand's box as a mesh file, twelve triangles; it goes with the process.
struct HandMesh {
  const std::string path = ::testing::TempDir() + "mmgrasp_hand_" + std::to_string(::getpid()) + ".obj";
  HandMesh() {
    std::ofstream out(path);
    for (double x : {-0.04, 0.04})
      for (double y : {-0.06, 0.06})
        for (double z : {-0.03, 0.03}) out << "v " << x << " " << y << " " << z << "\n";
    out << "f 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\nf 3 4 8\nf 3 8 7\nf 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 "
           "4\n";
  }
  ~HandMesh() { std::remove(path.c_str()); }
};

std::string hand_mesh() {
  static const HandMesh mesh;
  return mesh.path;
}

/// The gantry with what some misreadings need: a mesh, and a second shape of the base.
std::string gantry() {
  std::string text = replaced(urdf(), "<box size=\"0.08 0.12 0.06\"/>", "<mesh filename=\"hand.obj\"/>");
  return replaced(text, "</collision></link>",
                  "</collision><collision><geometry><box size=\"0.02 0.02 0.02\"/></geometry></collision></link>");
}

mmgrasp::RobotSource source(const std::string& text) {
  mmgrasp::RobotSource robot;
  robot.base = mmgrasp::BaseKind::diff_drive;
  robot.srdf = srdf();
  robot.urdfs.emplace_back();
  robot.urdfs[0].urdf = text;
  robot.urdfs[0].origin = "gantry.urdf";
  robot.urdfs[0].mesh_files = {{"hand.obj", hand_mesh()}};
  return robot;
}

Robot read_by_us(const std::string& text) {
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::diff_drive;
  return Robot::from_strings(replaced(text, "hand.obj", hand_mesh()), srdf(), options);
}

/// A good plan for the gantry; the hand drives turned, so that the wrist moves.
PlanToCheck plan_for_gantry() {
  PlanToCheck plan = good_plan();
  plan.robot = source(gantry());
  plan.planned_robot = mmgrasp::written_source(read_by_us(gantry()));
  plan.home[4] = 0.5;
  plan.picks = {make_pick(plan, 0, 0, {}), make_pick(plan, 0, 1, {}), make_pick(plan, 1, 3, {})};
  return plan;
}

const std::vector<Misreading>& misreadings() {
  static const std::vector<Misreading> all = {
      // Rx(r) Ry(p) Rz(y) of the true angles is the rotation that was planned for.
      {"rpy in the wrong order", "rpy=\"0 1.5707963267948966 0\"", "rpy=\"0.2 1.5707963267948966 -0.2\"", "joint 'z'",
       "rpy", "grasp-missed"},
      {"axis with the wrong sign", "<axis xyz=\"0 1 0\"/>\n    <limit lower=\"-0.5\"",
       "<axis xyz=\"0 -1 0\"/>\n    <limit lower=\"-0.5\"", "joint 'y'", "axis", "grasp-missed"},
      {"axis ignored", "<child link=\"boom\"/><origin rpy=\"0 -1.5707963267948966 0\"/>\n    <axis xyz=\"1 0 0\"/>",
       "<child link=\"boom\"/><origin rpy=\"0 -1.5707963267948966 0\"/>\n    <axis xyz=\"0 1 0\"/>", "joint 'x'",
       "axis", "grasp-missed"},
      {"mimic multiplier ignored", "<mimic joint=\"finger\"/>", "<mimic joint=\"finger\" multiplier=\"0.2\"/>",
       "joint 'finger_mirror'", "mimic multiplier", "scene-collision"},
      {"mimic offset ignored", "<mimic joint=\"finger\"/>", "<mimic joint=\"finger\" offset=\"0.03\"/>",
       "joint 'finger_mirror'", "mimic offset", "grasp-empty"},
      {"rotation of a fixed joint dropped", "<origin xyz=\"0 0 -0.02\"/></joint>",
       "<origin xyz=\"0 0 -0.02\" rpy=\"0 0 0.3\"/></joint>", "joint 'to_tcp'", "rpy", "grasp-missed"},
      {"fixed joint's frames swapped", "<origin xyz=\"0 0 -0.02\"/></joint>", "<origin xyz=\"0 0 0.02\"/></joint>",
       "joint 'to_tcp'", "origin", "grasp-missed"},
      // 0.0541 rad are 3.1 degrees.
      {"limits taken for radians in degrees", "lower=\"-3.1\" upper=\"3.1\"", "lower=\"-0.0541\" upper=\"0.0541\"",
       "joint 'yaw'", "upper limit", "position-limit"},
      {"velocity limit ignored", "lower=\"-3.1\" upper=\"3.1\" velocity=\"1\"",
       "lower=\"-3.1\" upper=\"3.1\" velocity=\"0.5\"", "joint 'yaw'", "velocity limit", "limit-exceeds-robot"},
      {"mesh scale ignored", "<mesh filename=\"hand.obj\"/>", "<mesh filename=\"hand.obj\" scale=\"1 1 4\"/>",
       "link 'hand'", "mesh", "attached-collision"},
      {"collision origin dropped", "<collision><geometry><box size=\"0.02 0.02 0.02\"/>",
       "<collision><origin xyz=\"0.5 0 0.5\"/><geometry><box size=\"0.02 0.02 0.02\"/>", "link 'base', collision 1",
       "origin", "route-collision"},
      {"tip on the wrong link", "<parent link=\"hand\"/><child link=\"tcp\"/>",
       "<parent link=\"boom\"/><child link=\"tcp\"/>", "joint 'to_tcp'", "parent link", "grasp-missed"},
      {"revolute taken for prismatic", "<joint name=\"y\" type=\"prismatic\">", "<joint name=\"y\" type=\"revolute\">",
       "joint 'y'", "type", "grasp-missed"},
      {"offset of the arm on its base dropped", "<origin xyz=\"0.1 0 0.9\"", "<origin xyz=\"0.1 0.05 0.9\"",
       "joint 'z'", "origin", "grasp-missed"},
  };
  return all;
}

bool names(const PlanCheckResult& result, const Misreading& m) {
  return std::any_of(result.faults.begin(), result.faults.end(), [&](const Fault& fault) {
    return fault.code == "robot-differs" && fault.where == m.where + (m.quantity == "mesh" ? ", collision 0" : "") &&
           fault.message.find(m.quantity) != std::string::npos;
  });
}

TEST(MisreadRobots, ThePlanHoldsForTheRobotThatWasRead) {
  const PlanCheckResult result = check_plan(plan_for_gantry(), quick());
  EXPECT_TRUE(result.faults.empty()) << listed(result);
}

class MisreadRobot : public ::testing::TestWithParam<Misreading> {};

TEST_P(MisreadRobot, IsNamedAndThePlanIsRefused) {
  const Misreading& m = GetParam();
  PlanToCheck plan = plan_for_gantry();
  ASSERT_NE(gantry().find(m.text), std::string::npos);
  const std::string truth = replaced(gantry(), m.text, m.truth);
  plan.robot = source(truth);
  const PlanCheckResult both = check_plan(plan, quick());
  EXPECT_TRUE(names(both, m)) << listed(both);
  EXPECT_TRUE(codes(both).count(m.code)) << listed(both);

  // The motions alone give it away, too.
  plan.planned_robot = {};
  const PlanCheckResult motions = check_plan(plan, quick());
  EXPECT_TRUE(codes(motions).count(m.code)) << listed(motions);
  EXPECT_FALSE(codes(motions).count("robot-differs"));

  // Our reader makes no such mistake: what it reads differs in nothing from what urdfdom reads.
  plan.planned_robot = mmgrasp::written_source(read_by_us(truth));
  const PlanCheckResult ours = check_plan(plan, quick());
  EXPECT_FALSE(codes(ours).count("robot-differs")) << listed(ours);
}

INSTANTIATE_TEST_SUITE_P(All, MisreadRobot, ::testing::ValuesIn(misreadings()), [](const auto& info) {
  std::string name = info.param.name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
});

/// An axis of length 2 is no URDF that could be written out again: the plan moves half as far as it should.
TEST(MisreadRobots, AnAxisThatWasNotNormalisedMissesTheParts) {
  PlanToCheck plan = plan_for_gantry();
  const std::string longer = "<axis xyz=\"0 2 0\"/>\n    <limit lower=\"-0.5\"";
  plan.robot = source(replaced(gantry(), "<axis xyz=\"0 1 0\"/>\n    <limit lower=\"-0.5\"", longer));
  EXPECT_EQ(codes_of(plan), Codes{});
  for (CheckedPick& pick : plan.picks) {
    for (CheckedMotion& motion : pick.motions) {
      for (Eigen::VectorXd& q : motion.positions) q[2] *= 0.5;
      for (Eigen::VectorXd& v : motion.velocities) v[2] *= 0.5;
    }
  }
  EXPECT_TRUE(codes_of(plan).count("grasp-missed"));
}

TEST(MisreadRobots, WhatUrdfdomRefusesIsNamed) {
  PlanToCheck plan = plan_for_gantry();
  const auto message = [&](const std::string& text) {
    plan.robot = source(text);
    const PlanCheckResult result = check_plan(plan, quick());
    return result.faults.size() == 1 && result.faults[0].code == "robot-unreadable" ? result.faults[0].message
                                                                                    : listed(result);
  };
  const auto holds = [](const std::string& text, const std::vector<std::string>& parts) {
    return std::all_of(parts.begin(), parts.end(),
                       [&](const std::string& part) { return text.find(part) != std::string::npos; });
  };
  std::string said = message(replaced(gantry(), "rpy=\"0 1.5707963267948966 0\"", "rpy=\"0 1.57\""));
  EXPECT_TRUE(holds(said, {"gantry.urdf", "urdfdom refuses it", "[z]"})) << said;
  said = message(replaced(gantry(), "<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>"));
  EXPECT_TRUE(holds(said, {"gantry.urdf", "joint \"yaw\"", "axis"})) << said;
  said = message(replaced(gantry(), "<mimic joint=\"finger\"/>", "<mimic joint=\"finger_mirror\"/>"));
  EXPECT_TRUE(holds(said, {"joint \"finger_mirror\"", "circle"})) << said;
  said = message(replaced(gantry(), "hand.obj", "other.obj"));
  EXPECT_TRUE(holds(said, {"gantry.urdf", "link \"hand\"", "other.obj"})) << said;
  said = message("<robot name=\"gantry\"><link name=\"base\">");
  EXPECT_TRUE(holds(said, {"gantry.urdf:1", "not well-formed XML"})) << said;
  plan.robot = source(gantry());
  plan.robot.urdfs[0].mesh_files["hand.obj"] = ::testing::TempDir() + "nothing.obj";
  const std::string missing = listed(check_plan(plan, quick()));
  EXPECT_TRUE(holds(missing, {"robot-unreadable", "nothing.obj", "assimp"})) << missing;
}

/// Every way of writing the same robot reads the same: what the check does not look at is no reason to refuse it.
TEST(MisreadRobots, ReadsWhatUrdfdomAloneWouldStumbleOver) {
  PlanToCheck plan = plan_for_gantry();
  std::string text = replaced(gantry(), "<link name=\"mast\"/>",
                              "<link name=\"mast\"><visual><geometry><capsule radius=\"1\" length=\"1\"/></geometry>"
                              "<material name=\"unknown\"/></visual><inertial><mass/></inertial></link>");
  text = replaced(text, "xyz=\"0.1 0 0.9\"", "xyz=\" 0.1\t0\n0.9 \"");
  text = replaced(text, "upper=\"0.5\" velocity=\"1\" effort=\"1\"", "upper=\"0.5\" velocity=\"1\"");
  plan.robot = source(text);
  const PlanCheckResult result = check_plan(plan, quick());
  EXPECT_TRUE(result.faults.empty()) << listed(result);
}

/// A capsule is none for urdfdom 3; taken for a cylinder, its cap would not reach the part.
TEST(MisreadRobots, CapsulesKeepTheirCaps) {
  PlanToCheck plan = plan_for_gantry();
  plan.planned_robot = {};
  const auto with_shape = [&](const std::string& kind) {
    const std::string shape = "<origin xyz=\"0 0 0.06\"/><geometry><" + kind + " radius=\"0.03\" length=\"0.08\"/>";
    plan.robot = source(replaced(gantry(), "<origin xyz=\"0 0 0.08\"/><geometry><mesh filename=\"hand.obj\"/>", shape));
    return codes_of(plan);
  };
  EXPECT_EQ(with_shape("cylinder"), Codes{});
  EXPECT_TRUE(with_shape("capsule").count("attached-collision"));
}

/// A robot put together of two URDFs and an added link is the same for the check.
TEST(MisreadRobots, MountedRobotsAndAddedLinksAreReadAgain) {
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::diff_drive;
  const std::string tool_text =
      "<robot name=\"tool\"><link name=\"foot\"/><link name=\"blade\"><collision><geometry><sphere radius=\"0.01\"/>"
      "</geometry></collision></link><joint name=\"swing\" type=\"revolute\"><parent link=\"foot\"/>"
      "<child link=\"blade\"/><origin xyz=\"0 0 0.1\" rpy=\"0.1 0.2 0.3\"/><limit lower=\"0\" "
      "upper=\"1\"/></joint></robot>";
  const Robot tool = Robot::from_strings(tool_text).with_link("mark", "blade", at(0.1, 0, 0));
  const Robot robot = Robot::from_strings(urdf(), srdf(), options)
                          .with_link("shelf", "base", at(-0.15, 0, 0.45), {box_shape(0.05, 0.05, 0.05)})
                          .mount(tool, "shelf", at(0, 0, 0.05), "t_");
  PlanToCheck plan = good_plan();
  plan.robot = mmgrasp::source_of(robot);
  plan.planned_robot = mmgrasp::written_source(robot);
  ASSERT_EQ(plan.robot.urdfs.size(), 2u);
  ASSERT_EQ(plan.robot.added_links.size(), 2u);
  const PlanCheckResult result = check_plan(plan, quick());
  EXPECT_TRUE(result.faults.empty()) << listed(result);
  plan.robot.urdfs[1].T_parent_root = at(0, 0, 0.06);
  EXPECT_EQ(listed(check_plan(plan, quick())).substr(0, 38), "robot-differs | joint 't_mount_joint' ");
}

}  // namespace
}  // namespace tiny
