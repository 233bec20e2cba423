// What branch and bound over grasps rests on: enclosures of arm configurations, bounds of sag, bounds of whole paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carried_pipe.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "mmgrasp/structure/optimize_grasp.hpp"
#include "structure/object_path/collision_proof.hpp"
#include "structure/object_path/path_bound.hpp"

namespace mmgrasp {
namespace {

using detail::GraspBox;
using detail::LinearForm;
using Eigen::Vector3d;

double value(const LinearForm& f, double x, double y) {
  return f.centre + f.slope[0] * x + f.slope[1] * y;
}

TEST(LinearForm, EnclosesEveryOperation) {
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const auto draw = [&](double middle) {
      return LinearForm(middle, rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(0, 0.1));
    };
    const double at = rng.uniform(-3, 3), other = rng.uniform(-3, 3);
    const LinearForm a = draw(at), b = draw(other), positive = draw(rng.uniform(0.01, 3)),
                     cosine = draw(rng.uniform(-0.99, 0.99));
    const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1), sa = rng.uniform(-1, 1), sb = rng.uniform(-1, 1);
    const auto exact = [&](const LinearForm& f, double s) { return value(f, x, y) + s * f.error; };
    const double va = exact(a, sa), vb = exact(b, sb), vp = exact(positive, sa), vc = exact(cosine, sa);
    const auto holds = [&](const LinearForm& f, double v, const char* what) {
      EXPECT_LE(std::abs(v - value(f, x, y)), f.error + 1e-12) << what;
    };
    holds(a * b, va * vb, "product");
    holds(squared(a), va * va, "square");
    holds(detail::sine(a), std::sin(va), "sine");
    holds(detail::cosine(a), std::cos(va), "cosine");
    if (vp > 0) holds(detail::square_root(positive), std::sqrt(vp), "root");
    if (positive.low() > 0) {
      EXPECT_GT(detail::square_root(positive).low(), 0);
    }
    if (positive.low() > 0) holds(detail::reciprocal(positive), 1 / vp, "reciprocal");
    if (std::abs(vc) <= 1) holds(detail::arc_cosine(cosine), std::acos(vc), "arc cosine");
    const LinearForm angle = detail::angle_of(a, b);
    const double turn = std::remainder(std::atan2(va, vb) - value(angle, x, y), 2 * M_PI);
    EXPECT_LE(std::abs(turn), angle.error + 1e-12);
  }
}

/// An arm like UR's: axes 2, 3 and 4 parallel.
Robot parallel_arm() {
  const char* axes[6] = {"0 0 1", "0 1 0", "0 1 0", "0 1 0", "0 0 -1", "0 1 0"};
  const char* places[6] = {"0 0 0.16", "0 0.12 0", "0 -0.1 0.4", "0 0 0.38", "0 0.1 0", "0 0 0.09"};
  std::string urdf = "<robot name=\"parallel\"><link name=\"l0\"/>";
  for (int i = 1; i <= 6; ++i) {
    const std::string k = std::to_string(i), before = std::to_string(i - 1);
    urdf += "<link name=\"l" + k + "\"/><joint name=\"j" + k + "\" type=\"revolute\"><parent link=\"l" + before +
            "\"/><child link=\"l" + k + "\"/><origin xyz=\"" + places[i - 1] + "\"/><axis xyz=\"" + axes[i - 1] +
            "\"/><limit effort=\"1\" velocity=\"2\" lower=\"-6.2\" upper=\"6.2\"/></joint>";
  }
  return Robot::from_strings(urdf + "</robot>", "");
}

detail::FormPose form_pose(const Pose& middle, const Vector3d& along, double half_length, double half_angle) {
  // moves along and turns about one axis of the world through the pose's origin
  const LinearForm angle(0, 0, half_angle, 0), c = detail::cosine(angle), s = detail::sine(angle);
  detail::FormPose T;
  for (int k = 0; k < 3; ++k) T.axes[k] = detail::turned(along, c, s, detail::form(middle.linear().col(k)));
  for (int i = 0; i < 3; ++i) T.origin[i] = LinearForm(middle.translation()[i], half_length * along[i], 0, 0);
  return T;
}

void encloses_all(const JointGroup& group, bool sum) {
  const detail::IkEnclosure arm(group);
  Rng rng(7);
  int compared = 0;
  double tightest = 10;
  for (int trial = 0; trial < 300; ++trial) {
    Eigen::VectorXd q(6);
    for (int j = 0; j < 6; ++j) q[j] = rng.uniform(-2, 2);
    if (trial % 5 == 0) q[4] = rng.uniform(-0.01, 0.01);  // near the wrist's singularity
    if (trial % 7 == 0) q[2] = rng.uniform(-0.01, 0.01);  // and the elbow's
    const Pose middle = group.fk(q);
    const Vector3d along = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const double size = std::pow(10.0, rng.uniform(-5, -1));
    const auto boxes = arm.within_limits(form_pose(middle, along, size, size));
    for (int k = 0; k < 8; ++k) {
      const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
      Pose T = middle;
      T.linear() = Eigen::AngleAxisd(y * size, along).toRotationMatrix() * middle.linear();
      T.translation() += x * size * along;
      for (const Eigen::VectorXd& found : solve_ik_branches(group, T, {}, {}, 0, {}, true).solutions) {
        ++compared;
        bool inside = false;
        for (const auto& box : boxes) {
          bool all = true;
          for (int j = 0; j < 6; ++j) all = all && std::abs(found[j] - value(box[j], x, y)) <= box[j].error + 1e-7;
          if (!all) continue;
          inside = true;
          if (size < 1e-4) tightest = std::min(tightest, box[3].error);
          if (!sum) break;
          const double both = found[3] + arm.wrist_sign() * found[5];
          EXPECT_LE(std::abs(std::remainder(both - value(box[6], x, y), 2 * M_PI)), box[6].error + 1e-7);
          break;
        }
        EXPECT_TRUE(inside) << "trial " << trial << ", size " << size << ": " << found.transpose();
      }
    }
  }
  EXPECT_GT(compared, 3000);
  EXPECT_LT(tightest, 1e-6);
}

TEST(IkEnclosure, HoldsEveryBranchOfASphericalWrist) {
  const test::PumaArm arm;
  encloses_all(arm.group(), true);
}

TEST(IkEnclosure, HoldsEveryBranchOfThreeParallelAxes) {
  const Robot robot = parallel_arm();
  encloses_all(robot.chain("l0", "l6"), false);
}

TEST(IkEnclosure, EffectsAreThoseOfTheJacobian) {
  const test::PumaArm arm;
  const detail::IkEnclosure enclosure(arm.group());
  Rng rng(3);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::VectorXd q(6);
    for (int j = 0; j < 6; ++j) q[j] = rng.uniform(-2, 2);
    const Vector3d v(rng.normal(), rng.normal(), rng.normal()), w(rng.normal(), rng.normal(), rng.normal());
    Vector6d twist;
    twist << v, w;
    const Vector6d exact = arm.group().jacobian(q).transpose() * twist;
    detail::FormConfiguration at{};
    for (int j = 0; j < 6; ++j) at[j] = LinearForm(q[j]);
    const auto effects =
        enclosure.joint_effects(at, form_pose(arm.group().fk(q), Vector3d::UnitX(), 0, 0), detail::form(v), w);
    for (int j = 0; j < 6; ++j) EXPECT_NEAR(effects[j].centre, exact[j], 1e-7) << j;
  }
}

TEST(IkEnclosure, RefusesArmsWithoutItsGeometry) {
  const test::PumaArm arm;
  EXPECT_THROW(detail::IkEnclosure(arm.group().robot().chain("l0", "l5")), InvalidInput);
}

TEST(SagBound, StaysBelowAndComesNear) {
  for (const BeamFrame& frame : {figure_3_4_frame(), closed_frame()}) {
    const std::vector<Vector3d> gravity{{0, 0, -9.81}, {3, -5, 7}, {9, 1, -2}};
    const detail::SagBound bound(frame, gravity);
    Rng rng(5);
    for (int trial = 0; trial < 60; ++trial) {
      const int member = static_cast<int>(rng.index(frame.members.size()));
      const double length = frame.length(member), half = std::pow(10.0, rng.uniform(-5, -1)) * length,
                   middle = rng.uniform(half, length - half);
      const LinearForm below = bound.below(member, middle, half);
      for (const double x : {-1.0, -0.4, 0.0, 0.7, 1.0}) {
        const SupportedFrame held(frame,
                                  {BeamSupport{member, middle + x * half, {true, true, true, true, true, true}}});
        double sum = 0;
        for (const Vector3d& g : gravity) sum += held.largest_displacement(g).value;
        EXPECT_LE(below.centre + below.slope[0] * x - below.error, sum);
        if (half < 1e-4 * length) {
          EXPECT_GE(below.centre + below.slope[0] * x - below.error, 0.97 * sum);
        }
      }
    }
  }
}

TEST(PathBound, NoGraspOfABoxCostsLess) {
  const ObjectPathProblem problem = arc_past_post(6);
  const Pipe pipe = figure_3_4();
  const ObjectPathOptions options;
  const detail::PathBound bound(problem, pipe, options, puma_tool());
  ObjectPathEvaluator evaluator(problem, options);
  Rng rng(11);
  int feasible = 0, tight = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    GraspBox box;
    box.section = static_cast<int>(rng.index(6));
    box.flipped = rng.index(2) == 1;
    box.half_length = std::pow(10.0, rng.uniform(-4.5, -1.5));
    box.half_angle = std::pow(10.0, rng.uniform(-4, -0.3));
    const double room = pipe.length(box.section);
    if (2 * box.half_length > room) continue;
    box.length = rng.uniform(box.half_length, room - box.half_length);
    box.angle = rng.uniform(-M_PI, M_PI);
    const auto found = bound.graph(box).bound();
    for (int k = 0; k < 4; ++k) {
      const Grasp grasp = place_pipe_grasp(pipe, box.section, box.length + rng.uniform(-1, 1) * box.half_length,
                                           box.angle + rng.uniform(-1, 1) * box.half_angle, box.flipped, puma_tool());
      const ObjectPathResult result = evaluator.evaluate(grasp);
      if (result.outcome != Outcome::solved) continue;
      ++feasible;
      EXPECT_LE(found.cost, result.cost) << box.section << " " << box.length << " " << box.angle;
      tight += box.half_angle < 1e-3 && box.half_length < 1e-3 && found.cost > 0.99 * result.cost;
    }
  }
  EXPECT_GT(feasible, 300);
  EXPECT_GT(tight, 20);
}

/// What is excluded collides with every grasp of the box, and something is.
TEST(CollisionProof, ExcludesWhatCollidesEverywhereInTheBox) {
  ObjectPathProblem problem = arc_past_post(3);
  problem.world.add("wall", Box{{0.3, 1.5, 1.5}}, pose_from_xyz_rpy({-0.25, 0, 0.7}, {0, 0, 0}));
  problem.world.add("roof", Box{{1.5, 1.5, 0.4}}, pose_from_xyz_rpy({0, 0, 0.95}, {0, 0, 0}));
  const Pipe pipe = figure_3_4();
  const detail::PathBound bound(problem, pipe, {}, puma_tool());
  detail::CollisionProof proof(problem);
  detail::AttachedObject object(problem);
  Rng rng(2);
  int excluded = 0, checked = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    GraspBox box;
    box.section = static_cast<int>(rng.index(6));
    box.flipped = rng.index(2) == 1;
    box.half_length = 3e-4;
    box.half_angle = 1e-3;
    box.length = rng.uniform(0.03, pipe.length(box.section) - 0.03);
    box.angle = rng.uniform(-M_PI, M_PI);
    const auto place = [&](double x, double y) {
      return place_pipe_grasp(pipe, box.section, box.length + x * box.half_length, box.angle + y * box.half_angle,
                              box.flipped, puma_tool());
    };
    detail::BoxGraph graph = bound.graph(box);
    const std::vector<int> branches = graph.bound().branches;
    if (branches.empty() || !proof.exclude(graph, branches, place(0, 0))) continue;
    for (std::size_t i = 0; i < branches.size(); ++i) {
      if (graph.alive(i, branches[i])) continue;
      ++excluded;
      const detail::FormConfiguration& q = graph.configuration(i, branches[i]);
      for (int k = 0; k < 20; ++k) {
        const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
        const Grasp grasp = place(x, y);
        for (const Eigen::VectorXd& found :
             solve_ik_branches(problem.group, problem.T_world_object[i] * grasp.T_object_hand, {}, {}, 0, {}, true)
                 .solutions) {
          bool inside = true;
          for (int j = 0; j < 6; ++j) inside = inside && std::abs(found[j] - value(q[j], x, y)) <= q[j].error + 1e-7;
          if (!inside) continue;
          ++checked;
          EXPECT_FALSE(object.hold(grasp).is_free(found));
        }
      }
    }
  }
  EXPECT_GT(excluded, 20);
  EXPECT_GT(checked, 200);
}

TEST(BranchAndBound, ProvesTheOptimumOfAGrid) {
  const ObjectPathProblem problem = arc_past_post(6);
  const Pipe pipe = figure_3_4();
  GraspSearchOptions options;
  options.algorithm = "branch_and_bound";
  options.grasp = puma_tool();
  options.population.max_evaluations = 300;
  const GraspOptimum best = optimize_grasp(problem, pipe, {}, options);
  ASSERT_EQ(best.outcome, Outcome::solved);
  EXPECT_LE(best.gap, 1e-3);
  EXPECT_NEAR(best.lower_bound, best.path.cost * (1 - best.gap), 1e-9);
  ObjectPathEvaluator evaluator(problem);
  double grid = detail::kInfinity;
  for (int section = 0; section < 6; ++section) {
    for (double at = 0.02; at <= pipe.length(section) - 0.02 + 1e-9; at += 0.005) {
      for (int degree = -180; degree < 180; degree += 2) {
        for (const bool flip : {false, true}) {
          const auto found =
              evaluator.evaluate(place_pipe_grasp(pipe, section, at, degree * M_PI / 180, flip, puma_tool()));
          if (found.outcome == Outcome::solved) grid = std::min(grid, found.cost);
        }
      }
    }
  }
  EXPECT_LE(best.lower_bound, grid);
  EXPECT_LE(best.path.cost, 1.001 * grid);
  EXPECT_GT(best.lower_bound, 0.98 * grid);  // and the grid's best is not far above
  options.threads = 1;
  const GraspOptimum again = optimize_grasp(problem, pipe, {}, options);
  EXPECT_EQ(again.path.cost, best.path.cost);
  EXPECT_EQ(again.lower_bound, best.lower_bound);
  EXPECT_EQ(again.boxes, best.boxes);
  EXPECT_EQ(again.evaluations, best.evaluations);
}

TEST(BranchAndBound, ProvesThatNoGraspWillDo) {
  ObjectPathProblem problem = arc_past_post(6);
  problem.T_world_object[4].translation() = Vector3d(4, 0, 0);
  GraspSearchOptions options;
  options.algorithm = "branch_and_bound";
  options.grasp = puma_tool();
  options.population.max_evaluations = 50;
  const GraspOptimum none = optimize_grasp(problem, figure_3_4(), {}, options);
  EXPECT_EQ(none.outcome, Outcome::infeasible);
  EXPECT_EQ(none.lower_bound, detail::kInfinity);
  EXPECT_TRUE(none.feasible.empty());
}

}  // namespace
}  // namespace mmgrasp
