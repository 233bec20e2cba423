#include <gtest/gtest.h>

#include <string>

#include "bad_case.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

using namespace mmgrasp;

namespace {

std::string robot(const std::string& inside) {
  return test::robot_element(inside);
}

std::string joint(const std::string& inside, const std::string& type = "revolute") {
  return robot("<link name=\"a\"/><link name=\"b\"/>\n<joint name=\"j\" type=\"" + type +
               "\"><parent link=\"a\"/><child link=\"b\"/>" + inside + "</joint>");
}

std::string shape(const std::string& inside) {
  return robot("<link name=\"a\"><collision><geometry>" + inside + "</geometry></collision></link>");
}

std::string fixed(const std::string& name, const std::string& parent, const std::string& child) {
  return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/></joint>";
}

const std::string kLimit = "<limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"1\"/>";

std::vector<test::BadCase> bad_cases() {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  std::string close;
  for (int i = 0; i < 100000; ++i) close += "</a>";
  return {
      {"empty text", "", {"bad.urdf"}},
      {"no XML", "hello", {"bad.urdf"}},
      {"truncated", "<robot name=\"r\"><link name=\"a\">", {"bad.urdf"}},
      {"NUL byte", std::string("<robot name=\"r\">\0</robot>", 25), {"NUL"}},
      {"wrong root", "<sdf/>", {"<sdf>", "<robot>"}},
      {"no robot name", "<robot><link name=\"a\"/></robot>", {"name", "missing"}},
      {"no links", robot(""), {"\"r\"", "<link>"}},
      {"entity bomb", "<!DOCTYPE robot [<!ENTITY a \"b\">]>" + robot("<link name=\"&a;\"/>"), {"DOCTYPE", "refused"}},
      {"lower-case doctype", "<!doctype robot>" + robot("<link name=\"a\"/>"), {"refused"}},
      {"deep nesting", robot(deep), {"nesting"}},
      // Text that the parser reads otherwise than a quick look at tags does must not hide depth from the limit.
      {"depth behind a quote", robot("<! '>" + deep + "'"), {":2", "not followed by a name"}},
      {"depth behind closing tags", close + robot(deep), {":1", "closes what was not opened"}},
      {"depth behind an instruction", robot("<?x >" + deep + "?>"), {":2", "processing instruction"}},
      {"depth behind closing tags in an instruction", robot("<?xml v=\"</a>\"?>" + deep), {"instruction"}},
      {"depth behind an unfinished instruction", robot("<?x >" + deep), {":2", "instruction"}},
      {"wrong end tag", robot("<link name=\"a\"></lnk>"), {":2", "</lnk> where </link> is due"}},
      {"second root", robot("<link name=\"a\"/>") + "\n<robot/>", {":4", "<robot> after the end of the root"}},
      {"xacro left in", robot("<xacro:include filename=\"x\"/>"), {"xacro"}},
      {"link without name", robot("<link/>"), {":2", "<link>", "name"}},
      {"duplicate link", robot("<link name=\"a\"/>\n<link name=\"a\"/>"), {":3", "\"a\"", "unique"}},
      {"duplicate joint",
       robot("<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" + fixed("j", "a", "b") + fixed("j", "a", "c")),
       {"\"j\"", "unique"}},
      {"two roots", robot("<link name=\"a\"/><link name=\"b\"/>"), {"\"a\", \"b\"", "root"}},
      {"cycle without root",
       robot("<link name=\"a\"/><link name=\"b\"/>" + fixed("j", "a", "b") + fixed("k", "b", "a")),
       {"cycle"}},
      {"cycle beside the root",
       robot("<link name=\"o\"/><link name=\"a\"/><link name=\"b\"/>" + fixed("j", "a", "b") + fixed("k", "b", "a")),
       {"\"a\"", "cycle"}},
      {"own parent", robot("<link name=\"o\"/><link name=\"a\"/>" + fixed("j", "a", "a")), {"\"j\"", "differ"}},
      {"two parents",
       robot("<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" + fixed("j", "a", "c") + fixed("k", "b", "c")),
       {"\"k\"", "\"c\"", "\"j\"", "one parent"}},
      {"unknown parent",
       robot("<link name=\"arm\"/><link name=\"b\"/>" + fixed("j", "amr", "b")),
       {"\"j\"", "parent link = \"amr\"", "did you mean \"arm\""}},
      {"unknown child", robot("<link name=\"a\"/>" + fixed("j", "a", "zzz")), {"child link = \"zzz\""}},
      {"no parent element",
       robot("<link name=\"a\"/><joint name=\"j\" type=\"fixed\"><child link=\"a\"/></joint>"),
       {"<parent", "missing"}},
      {"unknown type", joint(kLimit, "hinge"), {"type = \"hinge\"", "revolute"}},
      {"no limit", joint(""), {"\"j\"", "<limit>", "missing"}},
      {"no prismatic limit", joint("", "prismatic"), {"<limit>", "prismatic"}},
      {"lower above upper",
       joint("<limit lower=\"2\" upper=\"1\" velocity=\"1\"/>"),
       {":3", "joint \"j\"", "lower = \"2\"", "must not exceed"}},
      {"NaN limit", joint("<limit lower=\"nan\" upper=\"1\" velocity=\"1\"/>"), {"lower = \"nan\"", "finite"}},
      {"infinite limit", joint("<limit lower=\"-inf\" upper=\"1\" velocity=\"1\"/>"), {"lower = \"-inf\"", "finite"}},
      {"overflow", joint("<limit lower=\"-1e999\" upper=\"1\" velocity=\"1\"/>"), {"lower = \"-1e999\"", "number"}},
      {"words for numbers",
       joint("<limit lower=\"-1,5\" upper=\"1\" velocity=\"1\"/>"),
       {"lower = \"-1,5\"", "number"}},
      {"negative velocity",
       joint("<limit lower=\"0\" upper=\"1\" velocity=\"-1\"/>"),
       {"velocity = \"-1\"", "negative"}},
      {"zero axis", joint(kLimit + "<axis xyz=\"0 0 0\"/>"), {"<axis>", "\"0 0 0\"", "zero"}},
      {"short axis", joint(kLimit + "<axis xyz=\"0 1\"/>"), {"\"0 1\"", "three numbers"}},
      {"NaN origin", joint(kLimit + "<origin xyz=\"0 nan 0\"/>"), {"<origin>", "joint \"j\"", "finite"}},
      {"origin with a quaternion",
       joint(kLimit + "<origin quat_xyzw=\"1 0 0 0\"/>"),
       {"<origin>", "joint \"j\"", "\"quat_xyzw\"", "xyz, rpy"}},
      {"misspelt rotation", joint(kLimit + "<origin rpz=\"1 0 0\"/>"), {"\"rpz\"", "did you mean \"rpy\""}},
      {"misspelt multiplier",
       robot("<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/><joint name=\"k\" type=\"revolute\"><parent "
             "link=\"a\"/><child link=\"c\"/>" +
             kLimit + "</joint><joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>" + kLimit +
             "<mimic joint=\"k\" multiplyer=\"-1\"/></joint>"),
       {"joint \"j\"", "multiplyer", "did you mean \"multiplier\""}},
      {"misspelt scale", shape("<mesh filename=\"m.stl\" scales=\"1 1 1\"/>"), {"\"scales\"", "filename, scale"}},
      {"far origin", joint(kLimit + "<origin xyz=\"0 1e300 0\"/>"), {"<origin>", "joint \"j\"", "xyz", "1e6"}},
      {"huge axis", joint(kLimit + "<axis xyz=\"1e-200 1e200 0\"/>"), {"<axis>", "1e6"}},
      {"huge sphere", shape("<sphere radius=\"1e308\"/>"), {"radius", "1e+308", "1e6"}},
      {"far limits", joint("<limit lower=\"1e300\" upper=\"1e301\"/>"), {"lower", "1e6"}},
      {"huge mimic", joint(kLimit + "<mimic joint=\"j\" offset=\"-1e99\"/>"), {"offset", "1e6"}},
      {"unknown mimic", joint(kLimit + "<mimic joint=\"q\"/>"), {"mimic joint = \"q\""}},
      {"mimic of itself", joint(kLimit + "<mimic joint=\"j\"/>"), {"circle"}},
      {"mimic of a fixed joint",
       robot("<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>" + fixed("k", "a", "c") +
             "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>" + kLimit +
             "<mimic joint=\"k\"/></joint>"),
       {"\"k\"", "fixed"}},
      {"no geometry", robot("<link name=\"a\"><collision/></link>"), {"<geometry>", "link \"a\""}},
      {"empty geometry", shape(""), {"geometry", "empty"}},
      // A misspelt element was passed over, and the robot was another one than its file says.
      {"misspelt link", robot("<link name=\"a\"/>\n<Link name=\"b\"/>"), {":3", "<Link", "did you mean", "link"}},
      {"misspelt collision", robot("<link name=\"a\"><colision/></link>"), {"<colision>", "link", "collision"}},
      {"misspelt geometry",
       robot("<link name=\"a\"><collision><geometry><box size=\"1 1 1\"/></geometry><orgin xyz=\"1 0 0\"/>"
             "</collision></link>"),
       {"<orgin>", "<collision>", "origin"}},
      {"misspelt limit", joint(kLimit + "<limits lower=\"0\" upper=\"1\"/>"), {"<limits>", "<joint>", "limit"}},
      {"misspelt axis", joint(kLimit + "<axes xyz=\"0 0 1\"/>"), {"<axes>", "<joint>", "axis"}},
      {"unknown shape", shape("<cone radius=\"1\"/>"), {"<cone>", "unknown"}},
      {"zero box", shape("<box size=\"0.1 0 0.1\"/>"), {"<box>", "link \"a\"", "0.1 0 0.1", "positive"}},
      {"negative sphere", shape("<sphere radius=\"-1\"/>"), {"radius = \"-1\"", "positive"}},
      {"NaN cylinder", shape("<cylinder radius=\"0.1\" length=\"nan\"/>"), {"length = \"nan\"", "finite"}},
      {"cylinder without length", shape("<cylinder radius=\"0.1\"/>"), {"length", "missing"}},
      {"flat mesh", shape("<mesh filename=\"m.stl\" scale=\"1 0 1\"/>"), {"scale = \"1 0 1\"", "zero"}},
      {"mesh without file", shape("<mesh/>"), {"filename", "missing"}},
  };
}

}  // namespace

TEST(RobotBadInput, EachIsRefusedWithFilePlaceValueAndRule) {
  test::expect_refused(bad_cases(), "bad.urdf",
                       [](const std::string& urdf) { Robot::from_strings(urdf, "", {}, "bad.urdf"); });
}

TEST(RobotBadInput, NothingIsPrinted) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for (const test::BadCase& bad : bad_cases()) EXPECT_THROW(Robot::from_strings(bad.text), InvalidInput);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(RobotBadInput, MissingFilesAreIoErrors) {
  EXPECT_THROW(Robot::load("/nowhere/r.urdf"), IoError);
  EXPECT_THROW(Robot::load("/tmp"), IoError);
  EXPECT_THROW(Robot::from_strings(shape("<mesh filename=\"nowhere.stl\"/>")), IoError);
}

TEST(RobotBadInput, HarmlessOddities) {
  // Comments may talk about declarations; numbers may carry a plus or an exponent; a joint may have no velocity.
  const Robot robot =
      Robot::from_strings("<?xml version=\"1.0\"?><!-- <!DOCTYPE no> <a> -->" +
                          joint("<!-- <!ENTITY> --><limit lower=\" -1e-1\" upper=\"+2.5\"/><axis xyz=\"0 0\n 2\"/>"));
  EXPECT_EQ(robot.joints()[0].lower, -0.1);
  EXPECT_EQ(robot.joints()[0].upper, 2.5);
  EXPECT_EQ(robot.joints()[0].velocity, 1.0);
  EXPECT_EQ(robot.joints()[0].axis, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(robot.report().warnings.size(), 1u);
}

TEST(RobotBadInput, UnknownLimitsAreWarnings) {
  const Robot robot = Robot::from_strings(
      joint("<limit lower=\"0\" upper=\"1\" velocity=\"1\" acceleration=\"2\"/><origin tool:id=\"3\" xyz=\"1 0 0\"/>"));
  ASSERT_EQ(robot.report().warnings.size(), 1u);
  EXPECT_NE(robot.report().warnings[0].find("\"acceleration\" is not read"), std::string::npos);
}

TEST(RobotBadInput, ElementsThatNobodyKnowsAreToldOnce) {
  std::string urdf = joint(kLimit + "<spring/><dynamics friction=\"1\"/><tool:origin/>");
  urdf.insert(urdf.find("<link"),
              "<property name=\"left_over\"/><property name=\"twice\"/><gazebo><colision/></gazebo>");
  const std::vector<std::string> warnings = Robot::from_strings(urdf).report().warnings;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("<spring>"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("<property"), std::string::npos) << warnings[1];
}

TEST(RobotBadInput, JointsNamedAsTheBase) {
  std::string urdf = joint(kLimit);
  for (std::size_t at; (at = urdf.find("\"j\"")) != std::string::npos;) urdf.replace(at, 3, "\"theta\"");
  RobotOptions options;
  options.base = BaseKind::diff_drive;
  const Robot robot = Robot::from_strings(urdf, "", options);
  EXPECT_EQ(robot.chain("a", "b").names(), (std::vector<std::string>{"theta"}));
  try {
    robot.chain("a", "b", true);
    FAIL() << "a joint named as the base was taken";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("joint \"theta\""), std::string::npos) << error.what();
  }
}

TEST(RobotBadInput, SubgroupsThatDoubleEachOtherStayCheap) {
  std::string srdf = "<robot name=\"r\"><group name=\"g0\"><joint name=\"j\"/></group>";
  for (int i = 1; i < 60; ++i) {
    const std::string below = "<group name=\"g" + std::to_string(i - 1) + "\"/>";
    srdf += "<group name=\"g" + std::to_string(i) + "\">" + below + below + "</group>";
  }
  const Robot robot = Robot::from_strings(joint(kLimit), srdf + "</robot>");  // 2^59 visits if each were expanded
  ASSERT_EQ(robot.groups().size(), 60u);
  EXPECT_EQ(robot.groups().back().joints, (std::vector<std::string>{"j"}));
}

TEST(RobotBadInput, SizesThatGrowWithTheSquareAreBounded) {
  std::string links = "<link name=\"l0\"/>";
  for (int i = 1; i <= 2000; ++i) {
    const std::string name = "l" + std::to_string(i);
    links += "<link name=\"" + name + "\"/>" + fixed("j" + std::to_string(i), "l0", name);
  }
  EXPECT_THROW(Robot::from_strings(robot(links)), InvalidInput);
  std::string srdf = "<robot name=\"r\">";
  for (int i = 0; i <= 1000; ++i) srdf += "<group name=\"g" + std::to_string(i) + "\"><joint name=\"j\"/></group>";
  EXPECT_THROW(Robot::from_strings(joint(kLimit), srdf + "</robot>"), InvalidInput);
  const std::string long_name(2'000'000, 'x');  // comparing two of them letter by letter would take an hour
  EXPECT_THROW(Robot::from_strings(robot("<link name=\"" + long_name + "y\"/>" + fixed("j", long_name, "b"))),
               InvalidInput);
}

TEST(RobotBadInput, BaseLimitsAndKinds) {
  RobotOptions options;
  options.base_limits.linear_velocity = 0;
  EXPECT_THROW(Robot::from_strings(robot("<link name=\"a\"/>"), "", options), InvalidInput);
  EXPECT_EQ(base_kind_from_string("omni"), BaseKind::omni);
  EXPECT_THROW(base_kind_from_string("wheels"), InvalidInput);
}
