#include "mmgrasp/geometry/segment_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/segmentation/alpha_expansion.hpp"
#include "geometry/segmentation/find_threads.hpp"
#include "geometry/segmentation/gaussian_mixture.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {
namespace {

using detail::alpha_expansion;
using detail::labelling_cost;
constexpr double kPi = 3.14159265358979323846;

double least_by_brute_force(const Eigen::MatrixXd& costs, const std::vector<detail::LabelLink>& links) {
  double least = std::numeric_limits<double>::infinity();
  const int labels = static_cast<int>(costs.rows()), nodes = static_cast<int>(costs.cols());
  const auto all = static_cast<int>(std::pow(labels, nodes) + 0.5);
  for (int code = 0; code < all; ++code) {
    std::vector<int> tried;
    for (int v = 0, rest = code; v < nodes; ++v, rest /= labels) tried.push_back(rest % labels);
    least = std::min(least, labelling_cost(costs, links, tried));
  }
  return least;
}

TEST(AlphaExpansion, IsExactForTwoLabelsAndWithinTwiceTheLeastForThree) {
  for (int seed = 0; seed < 40; ++seed) {
    Rng rng(static_cast<std::uint64_t>(seed));
    const int labels = seed % 2 ? 3 : 2, nodes = labels == 2 ? 12 : 8;
    Eigen::MatrixXd costs(labels, nodes);
    for (double& c : costs.reshaped()) c = rng.uniform();
    std::vector<detail::LabelLink> links;
    for (int a = 0; a < nodes; ++a) {
      for (int b = a + 1; b < nodes; ++b) {
        if (rng.uniform() < 0.4) links.push_back({a, b, rng.uniform(0, 0.6)});
      }
    }
    const double found = labelling_cost(costs, links, alpha_expansion(costs, links));
    const double least = least_by_brute_force(costs, links);
    EXPECT_GE(found, least - 1e-9);
    EXPECT_LE(found, (labels == 2 ? 1.0 : 2.0) * least + 1e-9) << seed;
  }
}

TEST(GaussianMixture, FindsHowManyThereAre) {
  for (const std::vector<double>& means : {std::vector<double>{0}, {0, 1}, {-1, 0, 2}}) {
    Rng rng(3);
    std::vector<double> samples;
    for (int i = 0; i < 6000; ++i) samples.push_back(means[i % means.size()] + 0.1 * rng.normal());
    const auto found = detail::fit_mixture(samples, std::vector<double>(samples.size(), 2.0), 8, 0.01, 2000, 1);
    ASSERT_EQ(found.components.size(), means.size());
    for (std::size_t k = 0; k < means.size(); ++k) {
      EXPECT_NEAR(found.components[k].mean, means[k], 0.01);
      EXPECT_NEAR(found.components[k].sigma, 0.1, 0.01);
      EXPECT_NEAR(found.components[k].share, 1.0 / static_cast<double>(means.size()), 0.01);
    }
  }
}

/// A surface of revolution around z: corners (radius, height) from one end of the axis to the other.
std::shared_ptr<const TriangleMesh> turned(const std::vector<std::pair<double, double>>& profile, int sides) {
  std::vector<Eigen::Vector3d> v{{0, 0, profile.front().second}};
  std::vector<std::array<int, 3>> t;
  for (const auto& [r, z] : profile) {
    for (int s = 0; s < sides; ++s)
      v.emplace_back(r * std::cos(2 * kPi * s / sides), r * std::sin(2 * kPi * s / sides), z);
  }
  const int top = static_cast<int>(v.size()), rings = static_cast<int>(profile.size());
  v.emplace_back(0, 0, profile.back().second);
  const auto at = [&](int ring, int side) { return 1 + ring * sides + side % sides; };
  for (int s = 0; s < sides; ++s) {
    t.push_back({0, at(0, s + 1), at(0, s)});
    t.push_back({top, at(rings - 1, s), at(rings - 1, s + 1)});
    for (int r = 0; r + 1 < rings; ++r) {
      t.push_back({at(r, s), at(r, s + 1), at(r + 1, s + 1)});
      t.push_back({at(r, s), at(r + 1, s + 1), at(r + 1, s)});
    }
  }
  return make_mesh(std::move(v), std::move(t));
}

TEST(SegmentMesh, CoarseSteppedShaftIsCutAtItsShoulder) {
  // As CAD programs write it: each wall is one row of triangles.
  const auto mesh = turned({{0.005, 0}, {0.005, 0.02}, {0.009, 0.02}, {0.009, 0.035}}, 32);
  ASSERT_TRUE(mesh->closed);
  const MeshSegmentation found = segment_mesh(*mesh);
  ASSERT_EQ(found.segments.size(), 2U);
  for (std::size_t f = 0; f < mesh->triangles.size(); ++f) {
    double height = 0;
    for (const int v : mesh->triangles[f]) height += mesh->vertices[v].z() / 3;
    EXPECT_EQ(found.labels[f], height < 0.0199 ? 1 : 0) << f;
  }
  const std::vector<FittedPrimitive> fits = fit_primitives(*mesh, found.labels);
  ASSERT_EQ(fits.size(), 2U);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(fits[k].kind, PrimitiveKind::cylinder);
    ASSERT_EQ(fits[k].widths.size(), 1U);
    EXPECT_NEAR(fits[k].widths[0].width, k ? 0.01 : 0.018, 1e-6);
    EXPECT_NEAR(std::abs(fits[k].widths[0].axis.z()), 1, 1e-6);
    EXPECT_NEAR(fits[k].widths[0].covered, 1, 1e-9);
    EXPECT_NEAR(fits[k].size.z(), k ? 0.02 : 0.015, 1e-6);
  }
}

TEST(SegmentMesh, BoxAndBallAreOneSegmentEach) {
  EXPECT_EQ(segment_mesh(*shape_mesh(Box{{0.03, 0.02, 0.01}})).segments.size(), 1U);
  EXPECT_EQ(segment_mesh(*shape_mesh(Sphere{0.02}, 48)).segments.size(), 1U);
}

TEST(SegmentMesh, RingsAreNoThread) {
  // Five grooves as deep as a thread's, each closed in itself.
  std::vector<std::pair<double, double>> profile{{0.004, 0}, {0.004, 0.004}};
  for (int k = 0; k < 5; ++k) {
    const double z = 0.004 + 0.001 * k;
    profile.insert(profile.end(), {{0.0034, z + 0.0005}, {0.004, z + 0.001}});
  }
  const auto mesh = turned(profile, 48);
  EXPECT_TRUE(segment_mesh(*mesh).threads.empty());
}

/// A bolt along z: twelve turns of thread from below, a plain shank as thick as the crests, a head of twice that.
class Bolt {
 public:
  static constexpr double kPitch = 0.001, kRoot = 0.0034, kCrest = 0.004, kHead = 0.008, kPlain = 0.0145;
  std::shared_ptr<const TriangleMesh> mesh;

  Bolt() {
    const auto at = [](double r, double turn, double z) {
      return Eigen::Vector3d(r * std::cos(2 * kPi * turn), r * std::sin(2 * kPi * turn), z);
    };
    constexpr int kAll = kSides * kTurns;
    std::vector<Eigen::Vector3d> v;
    std::vector<std::array<int, 3>> t;
    for (int j = 0; j <= kAll + kSides; ++j) v.push_back(at(kRoot, 1.0 * j / kSides, kPitch * j / kSides));
    const int crests = static_cast<int>(v.size());
    for (int j = 0; j <= kAll; ++j) v.push_back(at(kCrest, 1.0 * j / kSides, kPitch * (1.0 * j / kSides + 0.5)));
    const auto crest = [&](int j) { return crests + j; };
    for (int j = 0; j < kAll; ++j) {  // the root's own indices are 0, 1, ...
      t.push_back({j, j + 1, crest(j + 1)});
      t.push_back({j, crest(j + 1), crest(j)});
      t.push_back({crest(j), crest(j + 1), j + 1 + kSides});
      t.push_back({crest(j), j + 1 + kSides, j + kSides});
    }
    const int tip = static_cast<int>(v.size());
    v.emplace_back(0, 0, -kPitch);
    for (int j = 0; j < kSides; ++j) t.push_back({tip, j + 1, j});
    t.push_back({tip, 0, crest(0)});
    t.push_back({tip, crest(0), kSides});
    const int rings = static_cast<int>(v.size());
    const std::vector<std::pair<double, double>> above{
        {kCrest, kPlain}, {kCrest, 0.022}, {kHead, 0.022}, {kHead, 0.03}};
    for (const auto& [r, z] : above)
      for (int s = 0; s < kSides; ++s) v.push_back(at(r, 1.0 * s / kSides, z));
    const auto ring = [&](int row, int s) { return rings + row * kSides + s % kSides; };
    const int top = static_cast<int>(v.size());
    v.emplace_back(0, 0, 0.03);
    for (int s = 0; s < kSides; ++s) {
      t.push_back({kAll + s, kAll + s + 1, ring(0, s + 1)});
      t.push_back({kAll + s, ring(0, s + 1), ring(0, s)});
      for (int row = 0; row < 3; ++row) {
        t.push_back({ring(row, s), ring(row, s + 1), ring(row + 1, s + 1)});
        t.push_back({ring(row, s), ring(row + 1, s + 1), ring(row + 1, s)});
      }
      t.push_back({top, ring(3, s), ring(3, s + 1)});
    }
    t.push_back({crest(kAll), kAll, ring(0, 0)});
    t.push_back({kAll + kSides, crest(kAll), ring(0, 0)});
    mesh = make_mesh(std::move(v), std::move(t));
  }

 private:
  static constexpr int kSides = 48, kTurns = 12;
};

TEST(SegmentMesh, AThreadIsSmoothedAndNothingElseIs) {
  const Bolt bolt;
  ASSERT_TRUE(bolt.mesh->closed);
  const std::vector<ScrewThread> threads = detail::find_threads(*bolt.mesh);
  ASSERT_EQ(threads.size(), 1u);
  const ScrewThread& thread = threads[0];
  EXPECT_NEAR(std::abs(thread.pitch), Bolt::kPitch, 0.01 * Bolt::kPitch);
  EXPECT_GT(thread.pitch, 0);  // it climbs as it turns to the left: right-handed
  EXPECT_NEAR(thread.root_radius, Bolt::kRoot, 3e-5);
  EXPECT_NEAR(thread.crest_radius, Bolt::kCrest, 3e-5);
  std::vector<char> of_thread(bolt.mesh->vertices.size(), 0);
  for (const int f : thread.faces) {
    for (const int v : bolt.mesh->triangles[f]) {
      of_thread[v] = 1;
      EXPECT_LT(bolt.mesh->vertices[v].z(), Bolt::kPlain + 1e-9);
    }
  }
  TriangleMesh smooth = *bolt.mesh;
  detail::smooth_thread(thread, smooth);
  int roots = 0;
  for (std::size_t v = 0; v < smooth.vertices.size(); ++v) {
    const Eigen::Vector3d &before = bolt.mesh->vertices[v], &after = smooth.vertices[v];
    if (!of_thread[v]) {
      EXPECT_EQ(before, after) << v;
      continue;
    }
    EXPECT_NEAR(after.head<2>().norm(), thread.crest_radius, 3e-5) << v;
    roots += before.head<2>().norm() < Bolt::kRoot + 1e-6;
  }
  EXPECT_GT(roots, 9 * 48);  // the run-outs may be left
}

TEST(SegmentMesh, AThreadedShankIsOneSegmentBesideTheHead) {
  const Bolt bolt;
  const MeshSegmentation found = segment_mesh(*bolt.mesh);
  ASSERT_EQ(found.segments.size(), 2u);
  const auto fits = fit_primitives(*bolt.mesh, found.labels, found.threads);
  EXPECT_EQ(segment_names(fits), (std::vector<std::string>{"cylinder_1", "cylinder_2"}));
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const bool head = fits[k].size.x() > 0.012;
    EXPECT_NEAR(fits[k].size.x(), 2 * (head ? Bolt::kHead : Bolt::kCrest), 1e-4);
    EXPECT_EQ(found.segments[k].threaded, !head);
  }
  MeshSegmentationOptions one, three;
  one.diameter.threads = 1;
  three.diameter.threads = 3;
  const MeshSegmentation a = segment_mesh(*bolt.mesh, one), b = segment_mesh(*bolt.mesh, three);
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.diameters, b.diameters);
  EXPECT_EQ(a.threads[0].faces, b.threads[0].faces);
}

TEST(SegmentMesh, MovesAndGrowsWithTheMesh) {
  const auto shaft = turned({{0.005, 0}, {0.005, 0.02}, {0.009, 0.02}, {0.009, 0.035}}, 32);
  for (const auto& mesh : {shaft, Bolt().mesh}) {
    const MeshSegmentation before = segment_mesh(*mesh);
    const auto fits = fit_primitives(*mesh, before.labels, before.threads);
    for (const double scale : {0.1, 1.0, 20.0}) {
      const Eigen::Isometry3d T = Eigen::Translation3d(0.3 * scale, -0.11 * scale, 0.07 * scale) *
                                  Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized());
      TriangleMesh moved = *mesh;
      for (Eigen::Vector3d& v : moved.vertices) v = T * (scale * v);
      const MeshSegmentation after = segment_mesh(moved);
      EXPECT_EQ(after.labels, before.labels) << scale;
      const auto again = fit_primitives(moved, after.labels, after.threads);
      ASSERT_EQ(segment_names(again), segment_names(fits));
      for (std::size_t k = 0; k < fits.size(); ++k)
        EXPECT_LT((again[k].size / scale - fits[k].size).norm(), 1e-3 * fits[k].size.norm()) << scale;
    }
  }
}

/// The middle of a segment's corners.
Eigen::Vector3d middle(const TriangleMesh& mesh, const MeshSegment& segment) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int f : segment.faces)
    for (const int v : mesh.triangles[f]) sum += mesh.vertices[v];
  return sum / (3.0 * static_cast<double>(segment.faces.size()));
}

TEST(SegmentNames, AreThePlacesAmongTheirKindWhateverTheFilesOrder) {
  // Three equal balls beside each other and a large box, as one mesh of four bodies.
  std::vector<Eigen::Vector3d> v;
  std::vector<std::array<int, 3>> t;
  const auto add = [&](const TriangleMesh& body, const Eigen::Vector3d& at) {
    const int n = static_cast<int>(v.size());
    for (const Eigen::Vector3d& p : body.vertices) v.emplace_back(p + at);
    for (const auto& f : body.triangles) t.push_back({f[0] + n, f[1] + n, f[2] + n});
  };
  add(*shape_mesh(Sphere{0.01}, 32), {0.03, 0, 0.04});
  add(*shape_mesh(Sphere{0.01}, 32), {-0.03, 0, 0.04});
  add(*shape_mesh(Box{{0.1, 0.05, 0.02}}), {0, 0, 0});
  add(*shape_mesh(Sphere{0.01}, 32), {0, 0, 0.04});
  for (int seed = 0; seed < 3; ++seed) {
    const auto mesh = make_mesh(v, t);
    const MeshSegmentation found = segment_mesh(*mesh);
    const auto names = segment_names(fit_primitives(*mesh, found.labels));
    ASSERT_EQ(names, (std::vector<std::string>{"box_1", "sphere_1", "sphere_2", "sphere_3"})) << seed;
    for (int k = 1; k <= 3; ++k) {
      const Eigen::Vector3d c = middle(*mesh, found.segments[k]);
      EXPECT_LT((c - Eigen::Vector3d(0.03 * (k - 2), 0, 0.04)).norm(), 0.001) << seed;
    }
    Rng rng(static_cast<std::uint64_t>(seed));
    for (std::size_t i = t.size(); i > 1; --i) std::swap(t[i - 1], t[static_cast<std::size_t>(rng.uniform() * i)]);
  }
  EXPECT_TRUE(segment_names({}).empty());
}

TEST(SegmentMesh, OpenMeshInsideOutIsTurned) {
  TriangleMesh mesh = *turned({{0.005, 0}, {0.005, 0.02}, {0.009, 0.02}, {0.009, 0.035}}, 32);
  mesh.triangles.pop_back();
  mesh.closed = false;
  const MeshSegmentation before = segment_mesh(mesh);
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  const MeshSegmentation after = segment_mesh(mesh);
  EXPECT_FALSE(before.turned);
  EXPECT_TRUE(after.turned);
  EXPECT_EQ(before.labels, after.labels);
}

TEST(SegmentMesh, StopsWhenTold) {
  Monitor monitor;
  monitor.stop.stop();
  const MeshSegmentation found = segment_mesh(*shape_mesh(Sphere{0.02}, 48), {}, monitor);
  EXPECT_EQ(found.outcome, Outcome::stopped);
  EXPECT_TRUE(found.labels.empty());
}

TEST(SegmentMesh, SameAtAnyNumberOfThreads) {
  const auto mesh = turned({{0.005, 0}, {0.005, 0.02}, {0.009, 0.02}, {0.009, 0.035}}, 32);
  MeshSegmentationOptions one, three;
  one.diameter.threads = 1;
  three.diameter.threads = 3;
  EXPECT_EQ(segment_mesh(*mesh, one).labels, segment_mesh(*mesh, three).labels);
}

TEST(FitPrimitives, BoxWithItsThreeWidths) {
  const auto mesh = shape_mesh(Box{{0.03, 0.02, 0.01}});
  const auto fits = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0));
  ASSERT_EQ(fits.size(), 1U);
  EXPECT_EQ(fits[0].kind, PrimitiveKind::box);
  std::vector<double> widths;
  for (const GraspWidth& w : fits[0].widths) widths.push_back(w.width);
  std::sort(widths.begin(), widths.end());
  ASSERT_EQ(widths.size(), 3U);
  EXPECT_NEAR(widths[0], 0.01, 1e-9);
  EXPECT_NEAR(widths[1], 0.02, 1e-9);
  EXPECT_NEAR(widths[2], 0.03, 1e-9);
}

TEST(FitPrimitives, SidesWithNothingOnThemAreNotOffered) {
  // Only two opposite sides of a box.
  const auto whole = shape_mesh(Box{{0.03, 0.02, 0.01}});
  TriangleMesh sides = *whole;
  sides.closed = sides.convex = false;
  sides.triangles.clear();
  for (const auto& t : whole->triangles) {
    const bool flat = std::abs(whole->vertices[t[0]].y() - whole->vertices[t[1]].y()) < 1e-12 &&
                      std::abs(whole->vertices[t[0]].y() - whole->vertices[t[2]].y()) < 1e-12;
    if (flat) sides.triangles.push_back(t);
  }
  const auto fits = fit_primitives(sides, std::vector<int>(sides.triangles.size(), 0));
  ASSERT_EQ(fits[0].widths.size(), 1U);
  EXPECT_NEAR(fits[0].widths[0].width, 0.02, 1e-9);
  EXPECT_NEAR(std::abs(fits[0].widths[0].axis.y()), 1, 1e-9);
}

TEST(FitPrimitives, ConeAndBall) {
  const auto cone = turned({{0.02, 0}, {0.005, 0.03}}, 48);
  const auto fits = fit_primitives(*cone, std::vector<int>(cone->triangles.size(), 0));
  EXPECT_EQ(fits[0].kind, PrimitiveKind::cone);
  EXPECT_NEAR(fits[0].size.x(), 0.04, 1e-4);
  EXPECT_NEAR(fits[0].size.y(), 0.01, 1e-4);
  EXPECT_NEAR(fits[0].size.z(), 0.03, 1e-4);
  EXPECT_TRUE(fits[0].widths.empty());
  const auto ball = shape_mesh(Sphere{0.02}, 48);
  const auto balls = fit_primitives(*ball, std::vector<int>(ball->triangles.size(), 0));
  EXPECT_EQ(balls[0].kind, PrimitiveKind::sphere);
  EXPECT_NEAR(balls[0].size.x(), 0.04, 1e-6);
}

TEST(FitPrimitives, RefusesLabelsThatDoNotFit) {
  const auto mesh = shape_mesh(Box{{0.03, 0.02, 0.01}});
  EXPECT_THROW(fit_primitives(*mesh, {0, 0}), InvalidInput);
  EXPECT_THROW(fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), -1)), InvalidInput);
  ScrewThread other;
  other.faces = {12};
  EXPECT_THROW(fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0), {other}), InvalidInput);
}

TEST(FitPrimitives, NumbersThatNoFaceHasAreEmptySegments) {
  const auto mesh = turned({{0.005, 0}, {0.005, 0.02}, {0.009, 0.02}, {0.009, 0.035}}, 32);
  const std::vector<FittedPrimitive> fits = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 3));
  ASSERT_EQ(fits.size(), 4U);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(fits[k].kind, PrimitiveKind::box);
    EXPECT_EQ(fits[k].size, Eigen::Vector3d::Zero());
    EXPECT_EQ(fits[k].hull_volume, 0);
    EXPECT_TRUE(fits[k].widths.empty());
  }
  EXPECT_GT(fits[3].size.minCoeff(), 0.01);
}

TEST(SegmentMesh, TooManyTrianglesAreRefusedBeforeTheyAreLookedAt) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(10'000'001, {0, 1, 2});
  try {
    segment_mesh(mesh);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("at most 10 million triangles"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace mmgrasp
