// OccupancyMap against OctoMap called directly, and against what frames of known scenes must give.
#include "mmgrasp/mapping/occupancy_map.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "mapping/sdf_scenes.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/octree.hpp"
#include "support/temporary_folder.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Vector3d;

namespace {

const std::vector<PlacedShape>& scene() {
  static const std::vector<PlacedShape> shapes{{Box{{0.4, 0.4, 0.02}}, Pose(Eigen::Translation3d(0, 0, -0.0103))},
                                               {Box{{0.06, 0.05, 0.08}}, Pose(Eigen::Translation3d(0, 0, 0.04))}};
  return shapes;
}

const std::vector<Pose>& eyes() {
  static const std::vector<Pose> poses{look_at({0.01, 0, 0.35}, {0, 0, 0}), look_at({0.2, 0.05, 0.3}, {0, 0, 0}),
                                       look_at({-0.1, 0.2, 0.3}, {0, 0, 0})};
  return poses;
}

OccupancyOptions coarse(double resolution = 0.01) {
  OccupancyOptions options;
  options.resolution = resolution;
  return options;
}

OccupancyMap filled(const OccupancyOptions& options) {
  OccupancyMap map(options);
  for (const Pose& eye : eyes()) map.integrate(frame_of(scene(), small_camera(), eye), small_camera());
  return map;
}

using Cell = std::array<double, 4>;
std::set<Cell> cells_of(const std::vector<Voxels>& sizes) {
  std::set<Cell> out;
  for (const Voxels& voxels : sizes) {
    for (const Vector3d& c : *voxels.centres) out.insert({voxels.resolution, c.x(), c.y(), c.z()});
  }
  return out;
}

std::string message(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Occupancy state(const OccupancyMap& map, const Vector3d& point) {
  return map.states(point)[0];
}

}  // namespace

TEST(OccupancyMap, IsWhatOctoMapMakes) {
  for (const double range : {std::numeric_limits<double>::infinity(), 0.3}) {
    OccupancyOptions options = coarse();
    options.max_range = range;
    const OccupancyMap map = filled(options);
    octomap::OcTree tree(0.01);
    for (const Pose& eye : eyes()) {
      const DepthImage image = frame_of(scene(), small_camera(), eye);
      octomap::Pointcloud cloud;
      for (const Vector3d& p : image.points()) cloud.push_back(float(p.x()), float(p.y()), float(p.z()));
      const Vector3d from = eye.translation();
      tree.insertPointCloud(cloud, octomap::point3d(float(from.x()), float(from.y()), float(from.z())),
                            std::isfinite(range) ? range : -1, false, true);
    }
    tree.prune();
    std::set<Cell> theirs;
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
      if (tree.isNodeOccupied(*leaf)) theirs.insert({leaf.getSize(), leaf.getX(), leaf.getY(), leaf.getZ()});
    }
    EXPECT_GT(theirs.size(), 50u);
    EXPECT_EQ(cells_of(map.obstacle_cells()), theirs);
    EXPECT_EQ(map.cells(), tree.getNumLeafNodes());
    Rng rng(1);
    for (int k = 0; k < 20000; ++k) {
      const Vector3d p(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-0.1, 0.4));
      const auto* node = tree.search(p.x(), p.y(), p.z());
      const Occupancy expected = !node                       ? Occupancy::unknown
                                 : tree.isNodeOccupied(node) ? Occupancy::occupied
                                                             : Occupancy::free;
      EXPECT_EQ(state(map, p), expected) << p.transpose();
    }
  }
}

/// Seen points are occupied, what lies on the way to them is free, what is behind is unknown: within a cell of each.
TEST(OccupancyMap, KnowsWhatWasLookedThrough) {
  const double resolution = 0.01;
  OccupancyMap map(coarse(resolution));
  const DepthCamera camera = small_camera();
  DepthImage image{camera.intrinsics, Pose::Identity(), {}};
  image.depth.assign(160 * 120, 0.3f);
  const OccupancyReport report = map.integrate(image, camera);
  EXPECT_EQ(report.measured, 160 * 120);
  EXPECT_EQ(report.used, 160 * 120);
  Rng rng(2);
  for (int k = 0; k < 3000; ++k) {
    const double x = rng.uniform(-0.35, 0.35), y = rng.uniform(-0.25, 0.25);
    const double z = rng.uniform(0.05, 0.29);
    EXPECT_EQ(state(map, z * Vector3d(x, y, 1)), Occupancy::free) << x << " " << y << " " << z;
    EXPECT_EQ(state(map, Vector3d(0.3 * x, 0.3 * y, rng.uniform(0.312, 0.5))), Occupancy::unknown);
    EXPECT_EQ(state(map, Vector3d(0.3 * x, 0.3 * y, -0.02)), Occupancy::unknown);
  }
  for (double x = -0.1; x < 0.1; x += 0.0099) EXPECT_EQ(state(map, Vector3d(x, 0.02, 0.3001)), Occupancy::occupied);
}

/// Unknown cells with the known ones tile the bounds, without overlap.
TEST(OccupancyMap, UnknownSpaceAsAnObstacle) {
  const OccupancyMap map = filled(coarse());
  OccupancyObstacleOptions options;
  options.unknown_is_free = false;
  for (const bool own : {true, false}) {
    if (own) options.bounds = {Vector3d(-0.1, -0.1, -0.05), Vector3d(0.12, 0.1, 0.2)};
    if (!own) options.bounds = {};
    const Eigen::AlignedBox3d bounds = own ? options.bounds : map.bounds();
    const std::vector<Voxels> sizes = map.obstacle_cells(options);
    const auto held = [&](const Vector3d& p) {
      int count = 0;
      for (const Voxels& voxels : sizes) {
        for (const Vector3d& c : *voxels.centres) {
          count += (p - c).cwiseAbs().maxCoeff() < 0.5 * voxels.resolution * (1 - 1e-9);
        }
      }
      return count;
    };
    Rng rng(3);
    int unknown = 0;
    for (int k = 0; k < 3000; ++k) {
      Vector3d p;
      for (int i = 0; i < 3; ++i) p[i] = rng.uniform(bounds.min()[i], bounds.max()[i]);
      const Occupancy is = state(map, p);
      unknown += is == Occupancy::unknown;
      EXPECT_EQ(held(p), is == Occupancy::free ? 0 : 1) << p.transpose();
    }
    EXPECT_GT(unknown, 100);
  }
}

TEST(OccupancyMap, FilesGoBothWaysAndOctoMapReadsThem) {
  const TemporaryFolder folder;
  const OccupancyMap map = filled(coarse());
  for (const char* name : {"map.bt", "map.ot"}) {
    const std::string path = folder.file(name);
    map.save(path);
    const OccupancyMap again = OccupancyMap::load(path);
    EXPECT_EQ(again.options().resolution, 0.01);
    EXPECT_EQ(again.frames(), 0);
    EXPECT_EQ(cells_of(load_octree(path)), cells_of(again.obstacle_cells()));
    if (path.back() == 't' && path[path.size() - 2] == 'o') {
      EXPECT_EQ(cells_of(again.obstacle_cells()), cells_of(map.obstacle_cells()));
    }
    Rng rng(4);
    for (int k = 0; k < 5000; ++k) {
      const Vector3d p(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-0.1, 0.4));
      EXPECT_EQ(state(again, p), state(map, p));
    }
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  }
  // OctoMap reads them, and what it writes is read.
  octomap::OcTree tree(1);
  ASSERT_TRUE(tree.readBinary(folder.file("map.bt")));
  EXPECT_EQ(tree.getResolution(), 0.01);
  EXPECT_EQ(tree.getNumLeafNodes(), OccupancyMap::load(folder.file("map.bt")).cells());
  const std::unique_ptr<octomap::AbstractOcTree> full(octomap::AbstractOcTree::read(folder.file("map.ot")));
  ASSERT_NE(dynamic_cast<octomap::OcTree*>(full.get()), nullptr);
  EXPECT_EQ(dynamic_cast<octomap::OcTree&>(*full).getNumLeafNodes(), map.cells());
  ASSERT_TRUE(tree.writeBinary(folder.file("theirs.bt")));
  ASSERT_TRUE(full->write(folder.file("theirs.ot")));
  EXPECT_EQ(OccupancyMap::load(folder.file("theirs.bt")).cells(), tree.getNumLeafNodes());
  EXPECT_EQ(cells_of(OccupancyMap::load(folder.file("theirs.ot")).obstacle_cells()), cells_of(map.obstacle_cells()));
  // Probabilities are kept in the one and lost in the other.
  OccupancyMap kept = OccupancyMap::load(folder.file("map.ot")), once = map;
  const DepthImage next = frame_of(scene(), small_camera(), eyes()[1]);
  kept.integrate(next, small_camera());
  once.integrate(next, small_camera());
  EXPECT_EQ(cells_of(kept.obstacle_cells()), cells_of(once.obstacle_cells()));
  EXPECT_EQ(kept.cells(), once.cells());
  EXPECT_EQ(map.frames(), 3);  // the copy did not change it
  EXPECT_EQ(once.frames(), 4);
}

TEST(OccupancyMap, RefusesBadInput) {
  const auto expect = [](const std::string& reported, const std::string& part) {
    EXPECT_NE(reported.find(part), std::string::npos) << reported;
  };
  expect(message([] { OccupancyMap(coarse(0)); }), "resolution");
  OccupancyOptions odd;
  odd.hit = 0.4;
  expect(message([&] { OccupancyMap map(odd); }), "hit");
  odd = {};
  odd.miss = std::nan("");
  expect(message([&] { OccupancyMap map(odd); }), "miss");
  odd = {};
  odd.max_range = -1;
  expect(message([&] { OccupancyMap map(odd); }), "max_range");

  OccupancyMap map(coarse());
  const DepthCamera camera = small_camera();
  DepthImage image{camera.intrinsics, Pose::Identity(), {}};
  image.depth.assign(160 * 120, 300);
  expect(message([&] { map.integrate(image, camera); }), "divided by 1000");
  image.depth.assign(160 * 120, 0);
  expect(message([&] { map.integrate(image, camera); }), "no pixel measured");
  image.depth.assign(160 * 120, 0.3f);
  image.T_world_camera.translation().x() = 400;
  expect(message([&] { map.integrate(image, camera); }), "32767 cells");
  EXPECT_EQ(map.frames(), 0);
  image.T_world_camera = Pose::Identity();
  image.depth[7] = std::nanf("");
  image.depth[8] = -1;
  const OccupancyReport report = map.integrate(image, camera);
  EXPECT_EQ(report.invalid, 2);
  EXPECT_EQ(report.measured, 160 * 120 - 2);

  OccupancyObstacleOptions options;
  options.unknown_is_free = false;
  options.bounds = {Vector3d(-1, -1, -1), Vector3d(1, 1, 1e9)};
  expect(message([&] { map.obstacle_cells(options); }), "bounds");
  expect(message([&] { map.states(Vector3d(0, 0, std::nan(""))); }), "point 0");
  const TemporaryFolder folder;
  expect(message([&] { map.save(folder.file("map.txt")); }), ".bt or .ot");
  expect(message([&] { map.save("/nowhere/at/all/map.bt"); }), "cannot be written");
  expect(message([&] { OccupancyMap::load(folder.file("none.bt")); }), "does not exist");
  std::ofstream(folder.file("bad.bt")) << "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\na";
  expect(message([&] { OccupancyMap::load(folder.file("bad.bt")); }), "truncated");
  std::ofstream(folder.file("coarse.bt")) << "# Octomap OcTree binary file\nid OcTree\nsize 0\nres 1500\ndata\n";
  expect(message([&] { OccupancyMap::load(folder.file("coarse.bt")); }), "coarse.bt': res = 1500: must be in [1e-4");
  // A map without an occupied cell is one too.
  const OccupancyMap empty;
  EXPECT_TRUE(empty.obstacle_cells().empty());
  EXPECT_TRUE(empty.bounds().isEmpty());
  empty.save(folder.file("empty.bt"));
  EXPECT_EQ(OccupancyMap::load(folder.file("empty.bt")).cells(), 0u);
}
