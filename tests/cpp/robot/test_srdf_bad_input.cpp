// What is wrong in an SRDF is refused with its place, or said as a warning; nothing in it is passed over silently.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bad_case.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/robot.hpp"

using namespace mmgrasp;

namespace {

const char* kUrdf = R"(<robot name="r"><link name="base"/><link name="upper"/><link name="fore"/><link name="tool"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="upper"/><child link="fore"/><limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="fore"/><child link="tool"/></joint></robot>)";

std::string srdf(const std::string& inside) {
  return test::robot_element(inside);
}

const std::string kArm = "<group name=\"arm\"><chain base_link=\"base\" tip_link=\"tool\"/></group>\n";

std::vector<test::BadCase> refused() {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  std::string nested = "<group name=\"g0\"><joint name=\"j1\"/></group>";
  for (int i = 1; i <= 200; ++i)  // the outermost first, so that each is reached through the one before
    nested =
        "<group name=\"g" + std::to_string(i) + "\"><group name=\"g" + std::to_string(i - 1) + "\"/></group>" + nested;
  return {
      {"no XML", "hello", {"bad.srdf"}},
      {"blanks alone", "  \n", {"bad.srdf"}},
      {"truncated", "<robot name=\"r\"><group name=\"arm\">", {"bad.srdf"}},
      {"NUL byte", std::string("<robot name=\"r\">\0</robot>", 25), {"NUL"}},
      {"wrong root", "<srdf/>", {"bad.srdf:1", "<srdf>", "<robot>"}},
      {"entity bomb", "<!DOCTYPE robot [<!ENTITY a \"b\">]>" + srdf("<group name=\"&a;\"/>"), {"DOCTYPE", "refused"}},
      {"deep nesting", srdf(deep), {"nesting"}},
      {"wrong end tag", srdf("<group name=\"a\"></grup>"), {":2", "</grup> where </group> is due"}},
      {"second root", srdf("") + "\n<robot/>", {":4", "after the end of the root"}},
      {"a URDF", kUrdf, {"bad.srdf:1", "<link name=\"base\">", "URDF"}},
      {"group without name", srdf("<group><joint name=\"j1\"/></group>"), {":2", "<group>", "name", "missing"}},
      {"group with an empty name", srdf("<group name=\"\"><joint name=\"j1\"/></group>"), {":2", "name"}},
      {"member without name", srdf("<group name=\"g\">\n<joint/></group>"), {":3", "<joint>", "name", "missing"}},
      {"link without name", srdf("<group name=\"g\">\n<link/></group>"), {":3", "<link>", "name", "missing"}},
      {"chain without base",
       srdf("<group name=\"g\"><chain tip_link=\"tool\"/></group>"),
       {":2", "base_link", "missing"}},
      {"chain without tip",
       srdf("<group name=\"g\"><chain base_link=\"base\"/></group>"),
       {":2", "tip_link", "missing"}},
      {"group in itself", srdf("<group name=\"g\"><group name=\"g\"/></group>"), {":2", "circle"}},
      {"groups in a circle",
       srdf("<group name=\"g\"><group name=\"h\"/></group>\n<group name=\"h\"><group name=\"g\"/></group>"),
       {"circle"}},
      {"groups too deep", srdf(nested), {"nested too deeply"}},
      {"state without name", srdf(kArm + "<group_state group=\"arm\"/>"), {":3", "<group_state", "name", "missing"}},
      {"state without group", srdf(kArm + "<group_state name=\"s\"/>"), {":3", "group", "missing"}},
      {"value missing",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><joint name=\"j1\"/></group_state>"),
       {":3", "<joint name=\"j1\">", "value", "missing"}},
      {"value no number",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><joint name=\"j1\" value=\"up\"/></group_state>"),
       {":3", "value = \"up\"", "number"}},
      {"value with a decimal comma",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><joint name=\"j1\" value=\"0,5\"/></group_state>"),
       {":3", "value = \"0,5\"", "number"}},
      {"value not finite",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><joint name=\"j1\" value=\"nan\"/></group_state>"),
       {":3", "value = \"nan\"", "finite"}},
      {"several values",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><joint name=\"j1\" value=\"0.1 0.2\"/></group_state>"),
       {":3", "value = \"0.1 0.2\"", "number"}},
      {"effector without group", srdf("<end_effector name=\"e\" parent_link=\"tool\"/>"), {":2", "group", "missing"}},
      {"effector without parent", srdf("<end_effector name=\"e\" group=\"g\"/>"), {":2", "parent_link", "missing"}},
      {"pair of one link", srdf("<disable_collisions link1=\"base\"/>"), {":2", "link2", "missing"}},
      {"pair misspelt", srdf("<disable_collisions link1=\"base\" lnk2=\"fore\"/>"), {":2", "link2", "missing"}},
      {"enabled pair of one link", srdf("<enable_collisions link2=\"base\"/>"), {":2", "link1", "missing"}},
      {"default without link", srdf("<disable_default_collisions/>"), {":2", "link", "missing"}},
      {"virtual joint without name",
       srdf("<virtual_joint type=\"fixed\" child_link=\"base\"/>"),
       {":2", "name", "missing"}},
      {"passive joint without name", srdf("<passive_joint/>"), {":2", "name", "missing"}},
  };
}

/// Files of other versions of a robot are in use: what they name and the robot lacks is left out, and said.
std::vector<test::BadCase> warned() {
  return {
      {"of another robot", "<robot name=\"panda\"></robot>", {"bad.srdf:1", "\"panda\"", "\"r\""}},
      {"misspelt element",
       srdf("<disable_colisions link1=\"base\" link2=\"fore\"/>"),
       {":2", "<disable_colisions", "unknown in <robot>", "did you mean \"disable_collisions\"?"}},
      {"misspelt member",
       srdf("<group name=\"g\"><joint name=\"j1\"/><jiont name=\"j2\"/></group>"),
       {":2", "<jiont", "unknown in <group>", "did you mean \"joint\"?"}},
      {"misspelt value",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><jont name=\"j1\" value=\"1\"/></group_state>"),
       {":3", "<jont", "unknown in <group_state>"}},
      {"group twice", srdf(kArm + kArm), {":3", "<group name=\"arm\">", "twice"}},
      {"state twice",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"/>\n<group_state name=\"s\" group=\"arm\"/>"),
       {":4", "<group_state name=\"s\">", "twice"}},
      {"unknown joint",
       srdf("<group name=\"g\"><joint name=\"j1\"/><joint name=\"j9\"/></group>"),
       {":2", "<joint name=\"j9\">", "lacks"}},
      {"unknown link",
       srdf("<group name=\"g\"><joint name=\"j1\"/><link name=\"hand\"/></group>"),
       {"\"hand\"", "ignored"}},
      {"unknown subgroup", srdf("<group name=\"g\"><joint name=\"j1\"/><group name=\"h\"/></group>"), {":2", "lacks"}},
      {"nothing known", srdf("<group name=\"g\"><joint name=\"j9\"/></group>"), {"<group name=\"g\">", "dropped"}},
      {"chain upwards",
       srdf("<group name=\"g\"><joint name=\"j1\"/><chain base_link=\"tool\" tip_link=\"base\"/></group>"),
       {":2", "tip_link = \"base\"", "does not hang from"}},
      {"state of no group", srdf("<group_state name=\"s\" group=\"arm\"/>"), {":2", "\"arm\"", "lacks"}},
      {"state of an unknown joint",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><joint name=\"j9\" value=\"1\"/></group_state>"),
       {":3", "<joint name=\"j9\">", "lacks"}},
      {"state outside the limits",
       srdf(kArm + "<group_state name=\"s\" group=\"arm\"><joint name=\"j1\" value=\"57\"/></group_state>"),
       {":3", "value = \"57\"", "[-1, 1]"}},
      {"effector of no group",
       srdf("<end_effector name=\"e\" group=\"h\" parent_link=\"tool\"/>"),
       {":2", "\"h\"", "lacks"}},
      {"effector on an unknown link",
       srdf(kArm + "<end_effector name=\"e\" group=\"arm\" parent_link=\"hand\"/>"),
       {"\"hand\"", "ignored"}},
      {"pair of an unknown link", srdf("<disable_collisions link1=\"base\" link2=\"hand\"/>"), {"\"hand\"", "ignored"}},
      {"unknown passive joint", srdf("<passive_joint name=\"j9\"/>"), {":2", "<passive_joint name=\"j9\">", "lacks"}},
  };
}

}  // namespace

TEST(SrdfBadInput, EachIsRefusedWithFilePlaceValueAndRule) {
  test::expect_refused(refused(), "bad.srdf",
                       [](const std::string& text) { Robot::from_strings(kUrdf, text, {}, "robot.urdf", "bad.srdf"); });
}

TEST(SrdfBadInput, EachIsSaidOnce) {
  for (const test::BadCase& bad : warned()) {
    const Robot robot = Robot::from_strings(kUrdf, bad.text, {}, "robot.urdf", "bad.srdf");
    int said = 0;
    for (const std::string& warning : robot.report().warnings)
      if (warning.find("bad.srdf") != std::string::npos && test::holds_all(warning, bad.reported)) ++said;
    EXPECT_EQ(said, 1) << bad.what;
    if (said != 1)
      for (const std::string& warning : robot.report().warnings) ADD_FAILURE() << warning;
  }
}

TEST(SrdfBadInput, GoodFilesAreReadWithoutAWord) {
  const Robot robot = Robot::from_strings(
      kUrdf,
      srdf("<virtual_joint name=\"world\" type=\"fixed\" parent_frame=\"world\" child_link=\"base\"/>" + kArm +
           "<group_state name=\"s\" group=\"arm\"><joint name=\"j1\" value=\"0.5\"/></group_state>"
           "<end_effector name=\"e\" group=\"arm\" parent_link=\"tool\"/><joint_property joint_name=\"j1\" "
           "property_name=\"p\" value=\"1\"/><disable_collisions link1=\"base\" link2=\"fore\" reason=\"Never\"/>"));
  EXPECT_TRUE(robot.report().warnings.empty());
  EXPECT_EQ(robot.group_states().at("arm").at("s").at("j1"), 0.5);
  EXPECT_TRUE(robot.pair_disabled(robot.link_index("base"), robot.link_index("fore")));
}
