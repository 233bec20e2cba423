// What optimisers get to know about collisions: values against distances, derivatives against central differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "mmgrasp/core/random.hpp"
#include "support/derivatives.hpp"
#include "support/fetchlike.hpp"
#include "trajopt/collision_terms.hpp"
#include "trajopt/whole_body_nlp.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

constexpr int kIntervals = 4;
constexpr double kStep = 0.7;  // [s]

/// A drive past a table and a post, the arm moving, a part in the hand.
class Passing {
 public:
  explicit Passing(BaseKind base) : group_(test::fetchlike_whole_body(base)), problem_(group_) {
    const bool drives = base != BaseKind::fixed;
    world_.add("table", Box{{0.6, 0.6, 0.1}}, pose_from_xyz_rpy({0.9, 0.3, 0.6}, {0, 0, 0}));
    world_.add("post", Cylinder{0.05, 1.6}, pose_from_xyz_rpy({0.7, -0.45, 0.8}, {0, 0, 0}));
    world_.add("part", Box{{0.05, 0.05, 0.2}}, Pose::Identity());
    world_.attach("part", "gripper_link", pose_from_xyz_rpy({0.1, 0, 0}, {0, 0, 0}));
    checker_ = std::make_unique<CollisionChecker>(group_, world_);
    problem_.start = VectorXd::Zero(group_.size());
    problem_.segments = {{2}, {2}};
    Rng rng(11);
    const int drive = static_cast<int>(drive_names(group_).size()), first = drives ? 3 : 0;
    guess_.steps = {kStep, kStep};
    VectorXd q = VectorXd::Zero(group_.size()), v = VectorXd::Zero(drive);
    q[first + 1] = 0.4;
    q[first + 3] = 0.8;
    for (int i = 0; i <= kIntervals; ++i) {
      guess_.positions.push_back(q);
      guess_.drive.push_back(v);
      VectorXd next = v;
      for (int d = 0; d < drive; ++d) next[d] = 0.35 * rng.uniform(-1, 1);
      // The motion of one interval, in small straight steps: by other means than the library's.
      const int steps = 20000;
      for (int k = 0; k < steps; ++k) {
        const double s = (k + 0.5) / steps, h = kStep / steps;
        const VectorXd u = (1 - s) * v + s * next;
        VectorXd half = q;
        if (base == BaseKind::diff_drive) half[2] += 0.5 * h * u[1];
        q += h * configuration_velocity(group_, half, u);
      }
      v = next;
    }
    problem_.goal_lower = problem_.goal_upper = guess_.positions.back();
    problem_.start = guess_.positions.front();
  }

  std::vector<CollisionChecker*> checkers() const { return std::vector<CollisionChecker*>(kIntervals, checker_.get()); }
  WholeBodyTrajectory trajectory() const {
    std::vector<double> times;
    for (int i = 0; i <= kIntervals; ++i) times.push_back(kStep * i);
    return {group_, times, guess_.positions, guess_.drive};
  }
  /// The numbers of the motion as the problem orders them; bounds of velocities do not matter here.
  VectorXd numbers(const detail::WholeBodyNlp& nlp) const {
    const detail::WholeBodyLayout& layout = nlp.layout();
    VectorXd x = VectorXd::Zero(layout.size());
    for (int i = 0; i <= kIntervals; ++i) {
      x.segment(layout.q(i, 0), layout.columns()) = guess_.positions[i];
      x.segment(layout.v(i, 0), layout.drives()) = guess_.drive[i];
    }
    for (int segment = 0; segment < 2; ++segment) x[layout.h(segment)] = kStep;
    return x;
  }

  JointGroup group_;
  World world_;
  std::unique_ptr<CollisionChecker> checker_;
  WholeBodyProblem problem_;
  WholeBodyGuess guess_;
};

class CollisionDerivatives : public ::testing::TestWithParam<BaseKind> {};

TEST_P(CollisionDerivatives, AreExactInIntervalsAndAlongArcs) {
  Passing passing(GetParam());
  for (const bool keeps_sides : {false, true}) {
    detail::CollisionRows rows(passing.checkers(), {0, kIntervals}, 0.01, 0.5);
    rows.keep_clear(passing.guess_.positions, keeps_sides);
    rows.look_along(passing.trajectory());
    detail::WholeBodyNlp nlp(passing.problem_, 0.5);
    const Eigen::Index others = nlp.constraint_bounds().lower.size();
    rows.add_to(nlp, GetParam() == BaseKind::diff_drive);
    const Eigen::Index count = nlp.constraint_bounds().lower.size();
    ASSERT_GT(count, others + 20) << "nothing is near";
    Rng rng(4);
    for (int round = 0; round < 3; ++round) {
      VectorXd x = passing.numbers(nlp), multipliers = VectorXd::Zero(count);
      for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += rng.uniform(-0.3, 0.3);
      for (Eigen::Index i = others; i < count; ++i) multipliers[i] = rng.uniform(-1, 1);
      test::expect_exact_derivatives(nlp, x, 0, multipliers);
      if (HasFailure()) return;
    }
  }
}

TEST_P(CollisionDerivatives, AreOfTheDistancesAlongTheMotion) {
  Passing passing(GetParam());
  detail::CollisionRows rows(passing.checkers(), {0, kIntervals}, 0.01, 0.5);
  const WholeBodyTrajectory motion = passing.trajectory();
  ASSERT_TRUE(rows.look_along(motion)) << "the motion has to collide";
  detail::WholeBodyNlp nlp(passing.problem_, 0.5);
  const std::size_t others = nlp.terms().size();
  rows.add_to(nlp, GetParam() == BaseKind::diff_drive);
  const VectorXd x = passing.numbers(nlp);
  int between = 0;
  for (std::size_t t = others; t < nlp.terms().size(); ++t) {
    const detail::Term& term = *nlp.terms()[t];
    VectorXd local(static_cast<Eigen::Index>(term.variables.size())), values(term.rows());
    for (std::size_t i = 0; i < term.variables.size(); ++i) local[static_cast<Eigen::Index>(i)] = x[term.variables[i]];
    term.value(local.data(), values.data());
    // The fraction of the interval is not reported: one of those that are looked at has all of the distances.
    double best = 1;
    for (int k = 0; k < 30; ++k) {
      const VectorXd q = motion.at(kStep * (term.waypoint + k / 30.0));
      const std::vector<DistanceResult> near = passing.checker_->distances(q, 0.5);
      double worst = 0;
      for (const double value : values) {
        double off = 1;
        for (const DistanceResult& d : near) off = std::min(off, std::abs(d.value - value));
        worst = std::max(worst, off);
      }
      best = std::min(best, worst);
    }
    EXPECT_LT(best, 1e-6) << term.what << " in interval " << term.waypoint;
    between += static_cast<Eigen::Index>(term.variables.size()) > passing.group_.size();
  }
  EXPECT_GT(between, 3);
}

TEST_P(CollisionDerivatives, AskForThePaddingBesideTheMargin) {
  Passing passing(GetParam());
  passing.world_.set_padding({0.03, 0.01, 0.02, {}});
  CollisionChecker padded(passing.group_, passing.world_);
  detail::CollisionRows rows(std::vector<CollisionChecker*>(kIntervals, &padded), {}, 0.004, 0.5);
  ASSERT_TRUE(rows.look_along(passing.trajectory()));
  detail::WholeBodyNlp nlp(passing.problem_, 0.5);
  const std::size_t others = nlp.terms().size();
  rows.add_to(nlp, GetParam() == BaseKind::diff_drive);
  int links = 0;
  for (std::size_t t = others; t < nlp.terms().size(); ++t) {
    const detail::Term& term = *nlp.terms()[t];
    std::istringstream pairs(term.what);
    std::string pair;
    for (Eigen::Index row = 0; row < term.rows(); ++row) {
      std::string a, word, b;
      pairs >> a >> word >> b;
      b = b.substr(0, b.find(','));
      const bool scene = b == "table" || b == "post";
      const double padding = !scene ? 0 : a == "part" ? 0.03 : 0.05;
      // Of a pair whose padded corners met farther out, 1.75 times as much.
      const double asked = term.lower[row] - 0.004;
      EXPECT_TRUE(std::abs(asked - padding) < 1e-12 || std::abs(asked - 1.75 * padding) < 1e-12) << a << " " << b;
      links += scene && a != "part";
    }
  }
  EXPECT_GT(links, 0);
}

INSTANTIATE_TEST_SUITE_P(Bases, CollisionDerivatives,
                         ::testing::Values(BaseKind::fixed, BaseKind::diff_drive, BaseKind::omni),
                         [](const auto& info) { return to_string(info.param); });

}  // namespace
}  // namespace mmgrasp
