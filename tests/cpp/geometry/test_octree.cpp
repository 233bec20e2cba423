#include "mmgrasp/geometry/octree.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "mmgrasp/core/error.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;

namespace {

using Cell = std::array<double, 3>;
using Cells = std::map<double, std::set<Cell>>;  // by edge length

Cells cells_of(const std::vector<Voxels>& sizes) {
  Cells cells;
  for (const Voxels& voxels : sizes)
    for (const Eigen::Vector3d& c : *voxels.centres) cells[voxels.resolution].insert({c.x(), c.y(), c.z()});
  return cells;
}

/// What OctoMap itself says is occupied.
Cells cells_of(const octomap::OcTree& tree) {
  Cells cells;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (tree.isNodeOccupied(*leaf)) cells[leaf.getSize()].insert({leaf.getX(), leaf.getY(), leaf.getZ()});
  return cells;
}

/// A block whose inside is pruned to large leaves, a few free cells, and far corners.
octomap::OcTree sample_tree() {
  octomap::OcTree tree(0.05);
  for (int x = -6; x < 10; ++x)
    for (int y = 0; y < 16; ++y)
      for (int z = -8; z < 8; ++z)
        tree.updateNode(octomap::point3d(0.05f * x + 0.025f, 0.05f * y + 0.025f, 0.05f * z + 0.025f), (x + y) % 7 != 3);
  for (const float far : {-1600.f, 1600.f}) tree.updateNode(octomap::point3d(far, far / 2, -far), true);
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("mmgrasp_" + std::to_string(::getpid()) + name)).string();
}

std::string refusal(const std::string& content) {
  const std::string path = temporary("_refused.bt");
  std::ofstream(path, std::ios::binary) << content;
  std::string message;
  try {
    load_octree(path);
  } catch (const IoError& error) {
    message = error.what();
  }
  std::filesystem::remove(path);
  EXPECT_NE(message.find(path), std::string::npos) << message;
  return message;
}

std::string bt(const std::string& header, const std::string& data) {
  return "# Octomap OcTree binary file\n" + header + "data\n" + data;
}

}  // namespace

TEST(Octree, BinaryAndFullFilesHoldWhatOctoMapSays) {
  octomap::OcTree tree = sample_tree();
  const std::string ot = temporary(".ot"), binary = temporary(".bt");
  ASSERT_TRUE(tree.write(ot));
  EXPECT_EQ(cells_of(load_octree(ot)), cells_of(tree));
  ASSERT_TRUE(tree.writeBinary(binary));  // which prunes to the likeliest occupancy
  octomap::OcTree again(0.05);
  ASSERT_TRUE(again.readBinary(binary));
  const Cells cells = cells_of(again);
  EXPECT_GT(cells.size(), 1u);
  EXPECT_EQ(cells_of(load_octree(binary)), cells);
  std::filesystem::remove(ot);
  std::filesystem::remove(binary);
}

TEST(Octree, RealMapHoldsWhatOctoMapSays) {
  const auto path = testing_support::shared("clouds/octomap/geb079.bt");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data";
  octomap::OcTree tree(0.1);
  ASSERT_TRUE(tree.readBinary(path));
  const std::vector<Voxels> sizes = load_octree(path);
  EXPECT_EQ(cells_of(sizes), cells_of(tree));
  for (std::size_t i = 1; i < sizes.size(); ++i) EXPECT_GT(sizes[i].resolution, sizes[i - 1].resolution);
}

TEST(Octree, EveryTruncationIsRefused) {
  octomap::OcTree tree = sample_tree();
  std::stringstream stream;
  ASSERT_TRUE(tree.writeBinary(stream));
  const std::string whole = stream.str();
  for (int percent = 0; percent < 100; ++percent) {
    const std::string message = refusal(whole.substr(0, whole.size() * percent / 100));
    EXPECT_NE(message, "") << percent << " %";
  }
}

TEST(Octree, RefusesNamingTheFault) {
  const auto expect = [](const std::string& content, const std::string& reported) {
    const std::string message = refusal(content);
    EXPECT_NE(message.find(reported), std::string::npos) << message;
  };
  const std::string good = "id OcTree\nsize 2\nres 0.1\n", leaf("\x02\x00", 2);
  expect("", "is empty");
  expect("hello\n", "first line");
  expect("# Octomap OcTree binary file\nid OcTree\n", "no line 'data'");
  expect(bt("size 2\nres 0.1\n", leaf), "id = \"\"");
  expect(bt("id ColorOcTree\nsize 2\nres 0.1\n", leaf), "id = \"ColorOcTree\"");
  expect(bt("id OcTree\nsize 2\n", leaf), "res = \"0.000000\"");
  expect(bt("id OcTree\nsize 2\nres -1\n", leaf), "res = \"-1");
  expect(bt("id OcTree\nsize 2\nres nan\n", leaf), "res = \"nan\"");
  expect(bt("id OcTree\nsize two\nres 0.1\n", leaf), "size = \"two\"");
  expect(bt("id OcTree\nsize 3\nres 0.1\n", leaf), "announces 3 nodes, it holds 2");
  expect(bt(good, "\x02"), "after 1 of 2 nodes (truncated)");
  expect(bt(good, std::string(100000, '\xff')), "more than 16 levels");
  expect(bt(good, std::string("\x01\x00", 2)), "no occupied leaf");
  expect(bt("id OcTree\nsize 0\nres 0.1\n", ""), "no occupied leaf");
  expect("# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n" + std::string("\x00\x00\xc0\x7f\x00", 5),
         "finite");
  expect(bt("id OcTree\nsize 2\nres 1600000\n", leaf), "res = \"1600000.000000\": must be above 1e-9 and below 1e6 m");
  expect(bt("id OcTree\nsize 2\nres 1600\n", leaf),
         "an edge of 5.24288e+07 m at res = 1600 m: must be at most 1e6 m");  // 2^15 cells
  std::string corner;
  for (int level = 1; level < 16; ++level) corner += std::string("\x03\x00", 2);
  expect(bt("id OcTree\nsize 17\nres 100\n", corner + leaf),
         "lies off by 3.27675e+06 m at res = 100 m: must be at most 1e6 m");
  EXPECT_THROW(load_octree("/nowhere/map.bt"), IoError);
  EXPECT_THROW(load_octree("/tmp"), IoError);
}

TEST(Octree, PointsBecomeTheCellsThatHoldThem) {
  const Voxels cells = voxelize({{0.005, 0.005, 0.005}, {-0.001, 0.019, 0.01}, {0.009, 0.001, 0.002}}, 0.01);
  ASSERT_EQ(cells.centres->size(), 2u);  // the first and the last share one; a point on a face belongs above it
  EXPECT_TRUE((*cells.centres)[0].isApprox(Eigen::Vector3d(-0.005, 0.015, 0.015), 1e-12));
  EXPECT_TRUE((*cells.centres)[1].isApprox(Eigen::Vector3d(0.005, 0.005, 0.005), 1e-12));
  EXPECT_EQ(cells.resolution, 0.01);
  EXPECT_THROW(voxelize({}, 0.01), InvalidInput);
  EXPECT_THROW(voxelize({{0, 0, 0}}, 0), InvalidInput);
  try {
    voxelize({{0, 0, 0}, {0, std::nan(""), 0}}, 0.01);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("points[1][1]"), std::string::npos) << error.what();
  }
}
