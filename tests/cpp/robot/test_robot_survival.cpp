#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;
namespace fs = std::filesystem;

namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// "" when the robot loads, else the message of the error.
std::string load_message(const std::string& path, bool meshes = true) {
  RobotOptions options;
  options.load_meshes = meshes;
  try {
    Robot::load(path, "", options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool ends_with(std::string text, const std::string& ending) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// Loads or is refused by name at every hundredth of its length; anything else fails or ends the test program.
template <typename Load>
void cut_everywhere(const std::string& content, const std::string& name, const Load& load) {
  const fs::path folder = fs::temp_directory_path() / ("mmgrasp_cut_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const std::string path = (folder / name).string();
  int refused = 0;
  for (int percent = 0; percent <= 100; ++percent) {
    std::ofstream(path, std::ios::binary)
        << content.substr(0, content.size() * static_cast<std::size_t>(percent) / 100);
    try {
      load(path);
    } catch (const Error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << percent << " %: " << error.what();
    }
  }
  fs::remove_all(folder);
  EXPECT_GE(refused, 1) << name;
  EXPECT_LE(refused, 100) << name << " is refused even whole";
}

}  // namespace

TEST(RobotData, EveryUrdfOfTheDataLoadsOrIsRefusedByFileAndPlace) {
  MMGRASP_NEEDS_SHARED_DATA();
  // PR2's meshes are not in the data, and one file is a robot without links; nothing else may fail.
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(shared(""))) {
    const std::string path = entry.path().string();
    if (!ends_with(path, ".urdf")) continue;
    ++seen;
    const std::string message = load_message(path);
    const bool pr2 = entry.path().filename() == "pr2.urdf";
    if (pr2) {
      EXPECT_NE(message.find("package://"), std::string::npos) << path << ": " << message;
      EXPECT_NE(message.find("package_dirs"), std::string::npos) << path << ": " << message;
      EXPECT_EQ(load_message(path, false), "") << path;
    } else if (entry.path().filename() == "empty.urdf") {
      EXPECT_NE(message.find("empty.urdf"), std::string::npos) << message;  // a robot without links
    } else {
      EXPECT_EQ(message, "") << path;
    }
  }
  EXPECT_GE(seen, 30);
}

TEST(RobotSurvival, UrdfAndSrdfCutAtEveryPercent) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string urdf = shared("robots/panda/expanded/panda.urdf");
  cut_everywhere(read_file(urdf), "cut.urdf", [](const std::string& path) {
    RobotOptions options;
    options.load_meshes = false;
    Robot::load(path, "", options);
  });
  const std::string srdf = shared("robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf");
  cut_everywhere(read_file(srdf), "cut.srdf", [&urdf](const std::string& path) {
    RobotOptions options;
    options.load_meshes = false;
    Robot::load(urdf, path, options);
  });
}

TEST(RobotSurvival, MeshesCutAtEveryPercent) {
  MMGRASP_NEEDS_SHARED_DATA();
  for (const char* file :
       {"robots/ur/ur_description/meshes/ur5e/collision/wrist3.stl", "meshes/trimesh/octagonal_pocket.stl",
        "robots/tiago/example-robot-data/robots/tiago_description/meshes/arm/arm_6_collision.dae",
        "robots/panda_vamp/panda/meshes/collision/link5.obj", "meshes/trimesh/featuretype.ply",
        "meshes/trimesh/fuze_ascii.ply"}) {
    SCOPED_TRACE(file);
    const std::string content = read_file(shared(file));
    ASSERT_FALSE(content.empty());
    const std::string extension = fs::path(file).extension().string();
    cut_everywhere(content, "cut" + extension, [](const std::string& path) { load_mesh(path); });
  }
}

TEST(RobotSurvival, BytesTurnedIntoOthersNeverCrash) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string content = read_file(shared("robots/ur/expanded/ur5e.urdf"));
  RobotOptions options;
  options.load_meshes = false;
  for (const char bad : {'\0', '<', '>', '"', '&', '-', '9', '\xff'})
    for (std::size_t at = 0; at < content.size(); at += 97) {
      std::string damaged = content;
      damaged[at] = bad;
      try {
        Robot::from_strings(damaged, "", options, "damaged.urdf");
      } catch (const InvalidInput& error) {
        ASSERT_NE(std::string(error.what()).find("damaged.urdf"), std::string::npos) << error.what();
      }
    }
}

TEST(RobotSurvival, SrdfBombsAndCircles) {
  const std::string urdf = "<robot name='r'><link name='a'/></robot>";
  const auto message = [&urdf](const std::string& srdf) {
    try {
      Robot::from_strings(urdf, srdf, {}, "r.urdf", "r.srdf");
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::string bomb = "<!DOCTYPE r [<!ENTITY a0 \"lol\">";
  for (int i = 1; i < 30; ++i)
    bomb += "<!ENTITY a" + std::to_string(i) + " \"&a" + std::to_string(i - 1) + ";&a" + std::to_string(i - 1) + ";\">";
  EXPECT_NE(message(bomb + "]><robot name='&a29;'/>").find("r.srdf"), std::string::npos);
  EXPECT_NE(message("<robot name='r'><group name='g'><group name='h'/></group>"
                    "<group name='h'><group name='g'/></group></robot>")
                .find("circle"),
            std::string::npos);
  EXPECT_NE(message("<robot name='r'><passive_joint/></robot>").find("name"), std::string::npos);
  EXPECT_NE(message("<robot name='r'><disable_collisions link1='a'/></robot>").find("link2"), std::string::npos);
  EXPECT_EQ(message("<robot name='r'><disable_collisions link1='a' link2='a' reason=''/></robot>"), "");
}

TEST(RobotSurvival, ToleranceMustBeSound) {
  RobotOptions options;
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    options.mesh_tolerance = bad;
    EXPECT_THROW(Robot::from_strings("<robot name='r'><link name='a'/></robot>", "", options), InvalidInput);
  }
}

TEST(RobotData, StandInsOfRealRobotsAreReportedAndWrittenOut) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string urdf = shared("robots/wsg50/wsg_50_simulation/urdf/wsg_50.urdf");
  RobotOptions options;
  const Robot exact = Robot::load(urdf, "", options);
  options.mesh_tolerance = 0.01;
  const Robot simple = Robot::load(urdf, "", options);
  ASSERT_FALSE(simple.report().meshes.empty());
  int replaced = 0;
  for (const MeshReport& mesh : simple.report().meshes) {
    EXPECT_LE(mesh.deviation, 0.01);
    EXPECT_LE(mesh.triangles_saved, mesh.triangles);
    if (mesh.chosen != "mesh") ++replaced;
  }
  EXPECT_GT(replaced, 0);
  for (const MeshReport& mesh : exact.report().meshes) {
    EXPECT_EQ(mesh.deviation, 0);
    EXPECT_TRUE(mesh.convex || mesh.chosen == "mesh");
  }
  EXPECT_NE(simple.hash(), exact.hash());
  // Bounds only grow, and by no more than the tolerance.
  for (std::size_t i = 0; i < exact.links().size(); ++i) {
    ASSERT_EQ(exact.links()[i].collisions.size(), simple.links()[i].collisions.size());
    for (std::size_t k = 0; k < exact.links()[i].collisions.size(); ++k) {
      const LinkShape &a = exact.links()[i].collisions[k], &b = simple.links()[i].collisions[k];
      const Eigen::AlignedBox3d inner = shape_bounds(a.shape, a.T_link_shape),
                                outer = shape_bounds(b.shape, b.T_link_shape);
      EXPECT_LE((outer.min() - inner.min()).maxCoeff(), 1e-9);
      EXPECT_LE((inner.max() - outer.max()).maxCoeff(), 1e-9);
      EXPECT_LE((inner.min() - outer.min()).maxCoeff(), 0.01 + 1e-9);
      EXPECT_LE((outer.max() - inner.max()).maxCoeff(), 0.01 + 1e-9);
    }
  }
  EXPECT_NO_THROW(Robot::from_strings(simple.to_urdf()));
}
