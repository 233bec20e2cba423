#include "mmgrasp/structure/pipe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "beam_frames.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

void expect_refused(const Pipe& pipe, const std::string& field, const std::string& rule) {
  try {
    pipe.check();
    ADD_FAILURE() << field << " was accepted";
  } catch (const InvalidInput& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.rfind(field, 0), 0u) << what;
    EXPECT_NE(what.find(rule), std::string::npos) << what;
  }
}

/// Whether a point is inside a shape, from the definitions of capsule, cylinder and ball.
bool inside(const LinkShape& shape, const Vector3d& point) {
  const Vector3d p = shape.T_link_shape.inverse() * point;
  if (const auto* ball = std::get_if<Sphere>(&shape.shape)) return p.norm() <= ball->radius;
  if (const auto* rod = std::get_if<Cylinder>(&shape.shape)) {
    return std::abs(p.z()) <= rod->length / 2 && p.head<2>().norm() <= rod->radius;
  }
  const auto& capsule = std::get<Capsule>(shape.shape);
  const double along = std::max(0.0, std::abs(p.z()) - capsule.length / 2);
  return std::hypot(along, p.head<2>().norm()) <= capsule.radius;
}

bool inside(const std::vector<LinkShape>& shapes, const Vector3d& point) {
  for (const LinkShape& shape : shapes) {
    if (inside(shape, point)) return true;
  }
  return false;
}

TEST(Pipe, LengthsAndFramesOfTheFigure) {
  const Pipe pipe = figure_3_4();
  const double lengths[] = {0.2, 0.2, 0.15, 0.2, 0.4, 0.1};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(pipe.length(i), lengths[i], 1e-15);
    const Pose T = pipe.T_object_section(i);
    EXPECT_NEAR((T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-14);
    EXPECT_NEAR(T.linear().determinant(), 1, 1e-14);
    EXPECT_EQ(T.translation(), pipe.nodes[pipe.sections[i][0]]);
    EXPECT_NEAR((T * Vector3d(lengths[i], 0, 0) - pipe.nodes[pipe.sections[i][1]]).norm(), 0, 1e-15);
  }
  EXPECT_NEAR((pipe.T_object_section(0).linear().col(1) - Vector3d::UnitZ()).norm(), 0, 1e-15);
  EXPECT_NEAR((pipe.T_object_section(2).linear().col(1) - Vector3d::UnitX()).norm(), 0, 1e-15) << "runs along z";
}

TEST(Pipe, CentreOfMassIsThatOfItsSections) {
  Pipe bend{{{0, 0, 0}, {0.4, 0, 0}, {0.4, 0.2, 0}}, {{0, 1}, {1, 2}}, {0.02, 0.02}};
  EXPECT_NEAR((bend.centre_of_mass() - Vector3d(0.8 / 3, 0.2 / 6, 0)).norm(), 0, 1e-15);
  bend.diameters = {0.02, 0.04};  // the short section now weighs as much as the long one
  EXPECT_NEAR((bend.centre_of_mass() - Vector3d(0.3, 0.05, 0)).norm(), 0, 1e-15);
}

TEST(Pipe, ShapesHoldWhatIsWithinARadiusOfTheCentreLines) {
  Pipe pipe = figure_3_4();
  pipe.diameters = {0.012, 0.02, 0.012, 0.03, 0.012, 0.012};
  const auto round = pipe.shapes(PipeEnds::round), flat = pipe.shapes(PipeEnds::flat);
  ASSERT_EQ(round.size(), 6u);
  ASSERT_EQ(flat.size(), 6u + 4u) << "a ball at each of the nodes 1, 2, 3 and 5";
  Rng rng(5);
  int in = 0, between = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vector3d point(rng.uniform(-0.03, 0.43), rng.uniform(-0.03, 0.63), rng.uniform(-0.03, 0.28));
    double gap = std::numeric_limits<double>::infinity();  // to the surface of the round pipe
    for (std::size_t s = 0; s < pipe.sections.size(); ++s) {
      const Vector3d a = pipe.nodes[pipe.sections[s][0]], d = pipe.nodes[pipe.sections[s][1]] - a;
      const double t = std::clamp((point - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
      gap = std::min(gap, (point - a - t * d).norm() - pipe.diameters[s] / 2);
    }
    if (std::abs(gap) > 1e-12) {
      EXPECT_EQ(inside(round, point), gap < 0);
    }
    in += gap < 0;
    const bool in_flat = inside(flat, point);
    if (in_flat) {
      EXPECT_TRUE(gap < 1e-12) << "flat ends lie within round ones";
    }
    between += gap < 0 && !in_flat;
  }
  EXPECT_GT(in, 200);
  EXPECT_GT(between, 0) << "round ends stick out";
  EXPECT_TRUE(inside(round, {-0.005, 0, 0}));
  EXPECT_FALSE(inside(flat, {-0.001, 0, 0}));
  EXPECT_TRUE(inside(flat, {0.001, 0.004, 0}));
}

TEST(Pipe, BadPipesAreRefusedByNameValueAndRule) {
  const Pipe good = figure_3_4();
  good.check();
  Pipe bad = good;
  bad.sections.clear();
  bad.diameters.clear();
  expect_refused(bad, "sections", "at least one");
  bad = good;
  bad.diameters.pop_back();
  expect_refused(bad, "diameters = 5 values", "6 sections");
  bad = good;
  bad.nodes[3].y() = std::numeric_limits<double>::quiet_NaN();
  expect_refused(bad, "nodes[3]", "finite");
  bad = good;
  bad.sections[2] = {2, 7};
  expect_refused(bad, "sections[2] = (2, 7)", "7 nodes");
  bad = good;
  bad.sections[2] = {-1, 3};
  expect_refused(bad, "sections[2] = (-1, 3)", "7 nodes");
  bad = good;
  bad.sections[4] = {3, 3};
  expect_refused(bad, "sections[4]", "apart");
  bad = good;
  bad.sections[4] = {3, 2};
  expect_refused(bad, "sections[4]", "same nodes as sections[2]");
  bad = good;
  bad.diameters[1] = 0;
  expect_refused(bad, "diameters[1] = 0", "> 0");
  bad.diameters[1] = std::numeric_limits<double>::infinity();
  expect_refused(bad, "diameters[1]", "> 0");
  bad = good;
  bad.nodes.emplace_back(1, 1, 1);
  expect_refused(bad, "nodes[7]", "belong to a section");
  bad.nodes.emplace_back(1, 1, 2);
  bad.sections.push_back({7, 8});
  bad.diameters.push_back(0.01);
  expect_refused(bad, "nodes[7]", "connected");
  EXPECT_THROW(bad.shapes(), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
