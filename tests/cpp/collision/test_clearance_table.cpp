#include "collision/checker/clearance_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>

#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/random.hpp"

// What a table says of two concave bodies, against the clearance measured in the very pose. The pose is composed here
// by Eigen's own rotations.

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

/// Two bars that meet in a right angle: a body whose hull says little about it.
TriangleMesh angle_iron(double length) {
  TriangleMesh mesh;
  for (const bool upright : {false, true}) {
    const auto bar = shape_mesh(Box{upright ? Vector3d(0.03, 0.04, length) : Vector3d(length, 0.04, 0.03)}, 8);
    const Vector3d shift = 0.5 * length * (upright ? Vector3d::UnitZ() : Vector3d::UnitX());
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vector3d& v : bar->vertices) mesh.vertices.push_back(v + shift);
    for (const auto& t : bar->triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  mesh.closed = true;
  return mesh;
}

struct Elbows {
  // The bodies need their meshes when their grids are made.
  std::shared_ptr<const TriangleMesh> long_mesh = std::make_shared<const TriangleMesh>(angle_iron(0.3));
  std::shared_ptr<const TriangleMesh> short_mesh = std::make_shared<const TriangleMesh>(angle_iron(0.12));
  TableBody a = made(long_mesh), b = made(short_mesh);
  Pose before = Pose(Eigen::Translation3d(0.22, 0.1, 0.05) * Eigen::AngleAxisd(0.4, Vector3d(1, 2, 0).normalized()));
  Pose between = Pose(Eigen::Translation3d(0, 0.03, 0.06) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
  Pose after = Pose(Eigen::Translation3d(0.01, 0, 0.05) * Eigen::AngleAxisd(-0.2, Vector3d::UnitY()));

  static TableBody made(const std::shared_ptr<const TriangleMesh>& mesh) {
    TableBody body;
    body.solid = make_solid(MeshShape{mesh});
    body.bounds = std::make_shared<const BoundingVolumes>(*body.solid, MeshShape{mesh});
    return body;
  }

  // Rates: the short iron never reaches farther than this from either axis.
  RevolutePair joints() const {
    RevolutePair out;
    out.before = Rigid(before);
    out.between = Rigid(between);
    out.after = Rigid(after);
    out.rates = {0.32, 0.2};
    return out;
  }

  double clearance(double first, double second) const {
    const Pose T = before * Eigen::AngleAxisd(first, Vector3d::UnitZ()) * between *
                   Eigen::AngleAxisd(second, Vector3d::UnitZ()) * after;
    return std::max(0.0, solids_distance(*a.solid, Rigid(), *b.solid, Rigid(T)).distance);
  }
};

TEST(ClearanceTable, NeverOverstatesAndFindsMostClearances) {
  const Elbows elbows;
  const ClearanceTable table(elbows.a, elbows.b, elbows.joints());
  Rng rng(1);
  int touching = 0, narrow = 0, found = 0, wide = 0, far = 0;
  for (int i = 0; i < 4000; ++i) {
    const double first = rng.uniform(-7.0, 7.0), second = rng.uniform(-7.0, 7.0);
    const double truth = elbows.clearance(first, second), wanted = rng.uniform(0.0, i % 2 == 0 ? 0.003 : 0.02);
    const double least = table.at_least(first, second, wanted);
    ASSERT_LE(least, truth) << first << " " << second << " " << wanted;
    touching += truth == 0;
    if (truth > 0.006 && truth < 0.02) ++narrow, found += least > 0;
    if (truth > 0.02 && wanted <= 0.003) ++wide, far += least > wanted;
  }
  EXPECT_GT(touching, 150);
  EXPECT_GT(narrow, 200);
  EXPECT_GT(found, 0.95 * narrow);
  EXPECT_GT(wide, 1000);
  EXPECT_EQ(far, wide);
}

// Both angles move evenly, as along an edge: at none of the places in between may the bodies touch.
TEST(ClearanceTable, StaysApartOnlyWhereTheyDo) {
  const Elbows elbows;
  const ClearanceTable table(elbows.a, elbows.b, elbows.joints());
  Rng rng(3);
  int proven = 0, apart = 0, touching = 0;
  for (int i = 0; i < 300; ++i) {
    const std::array<double, 2> from{rng.uniform(-7.0, 7.0), rng.uniform(-7.0, 7.0)};
    const double length = rng.uniform(0.0, 0.03);
    std::array<double, 2> step{rng.uniform(-length, length), rng.uniform(-length, length)};
    if (i % 10 == 0) step[i % 20 / 10] = 0;
    const long first = i % 3, last = first + static_cast<long>(rng.uniform(0, 40));
    const bool stays = table.stays_apart(from, step, first, last);
    double least = 1;
    for (long k = first; k <= last; ++k)
      least = std::min(least, elbows.clearance(from[0] + static_cast<double>(k) * step[0],
                                               from[1] + static_cast<double>(k) * step[1]));
    if (stays) {
      ASSERT_GT(least, 0) << i;
    }
    touching += least == 0;
    if (least > 0.006) ++apart, proven += stays;
  }
  EXPECT_GT(touching, 20);
  EXPECT_GT(apart, 50);
  EXPECT_GT(proven, 0.95 * apart);
}

TEST(ClearanceTable, AnswersDoNotDependOnWhatWasAskedBefore) {
  const Elbows elbows;
  std::vector<Vector3d> questions;
  Rng rng(2);
  for (int i = 0; i < 600; ++i)
    questions.push_back({rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(0.0, 0.02)});
  const ClearanceTable one(elbows.a, elbows.b, elbows.joints()), other(elbows.a, elbows.b, elbows.joints());
  std::vector<double> forwards;
  for (const Vector3d& q : questions) forwards.push_back(one.at_least(q[0], q[1], q[2]));
  std::vector<double> shared(questions.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 3; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = questions.size(); i-- > 0;) {
        const Vector3d& q = questions[i];
        const double least = other.at_least(q[0], q[1], q[2]);
        if (i % 3 == t) shared[i] = least;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(forwards, shared);
}

TEST(ClearanceTable, IsSharedWhileItsBodiesLiveAndByNoOtherPair) {
  const Elbows elbows;
  const auto table = shared_clearance_table(elbows.a, elbows.b, elbows.joints());
  EXPECT_EQ(shared_clearance_table(elbows.a, elbows.b, elbows.joints()), table);
  RevolutePair moved = elbows.joints();
  moved.between.t[0] += 1e-6;
  EXPECT_NE(shared_clearance_table(elbows.a, elbows.b, moved), table);
  EXPECT_NE(shared_clearance_table(elbows.b, elbows.a, elbows.joints()), table);
}

}  // namespace
}  // namespace mmgrasp::detail
