#include "trajopt/whole_body_nlp.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "trajopt/tool_terms.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;
constexpr double kLeastStep = 1e-4, kLongestStep = 100;  // [s] of a time step (P1 4.3)

}  // namespace

WholeBodyLayout::WholeBodyLayout(const WholeBodyProblem& problem)
    : columns_(problem.group.size()), drives_(static_cast<int>(drive_names(problem.group).size())) {
  for (std::size_t s = 0; s < problem.segments.size(); ++s) {
    step_.push_back(size_++);
    for (int i = 0; i < problem.segments[s].intervals; ++i) {
      first_.push_back(size_);
      segment_.push_back(static_cast<int>(s));
      size_ += columns_ + 2 * drives_;
    }
  }
  first_.push_back(size_);
  size_ += columns_ + drives_;
}

std::string WholeBodyLayout::name(int index, const JointGroup& group) const {
  for (std::size_t s = 0; s < step_.size(); ++s)
    if (step_[s] == index) return "time step of segment " + std::to_string(s);
  const auto after = std::upper_bound(first_.begin(), first_.end(), index);
  const int waypoint = static_cast<int>(after - first_.begin()) - 1;
  const int at = index - first_[waypoint];
  const std::string where = " at waypoint " + std::to_string(waypoint);
  if (at < columns_) return group.names()[at] + where;
  const std::vector<std::string> drives = drive_names(group);
  const bool velocity = at < columns_ + drives_;
  return (velocity ? "velocity of " : "acceleration of ") + drives[at - columns_ - (velocity ? 0 : drives_)] + where;
}

WholeBodyNlp::WholeBodyNlp(const WholeBodyProblem& problem, double smoothing) : problem_(problem), layout_(problem) {
  const VectorXd limits = drive_acceleration_limits(problem.group);
  smoothing_ = smoothing / layout_.intervals() * limits.cwiseAbs2().cwiseInverse();
  bound_variables();
  for (int s = 0; s < static_cast<int>(problem_.segments.size()); ++s) hessian_.add(layout_.h(s), layout_.h(s));
  for (int i = 0; i < layout_.intervals(); ++i)
    for (int d = 0; d < layout_.drives(); ++d) hessian_.add(layout_.a(i, d), layout_.a(i, d));
  add_motion();
  add_limits();
  add_mecanum_wheels();
  add_tool();
}

void WholeBodyNlp::bound_variables() {
  const JointGroup& group = problem_.group;
  bounds_.lower = VectorXd::Constant(layout_.size(), -kInfinity);
  bounds_.upper = VectorXd::Constant(layout_.size(), kInfinity);
  const auto box = [&](int index, double lower, double upper) {
    bounds_.lower[index] = lower;
    bounds_.upper[index] = upper;
  };
  const VectorXd v = drive_velocity_limits(group), a = drive_acceleration_limits(group);
  const int last = layout_.intervals();
  for (int i = 0; i <= last; ++i) {
    for (int c = 0; c < layout_.columns(); ++c) {
      const bool turns = group.wraps()[c];
      box(layout_.q(i, c), turns ? -kInfinity : group.lower()[c], turns ? kInfinity : group.upper()[c]);
    }
    for (int d = 0; d < layout_.drives(); ++d) box(layout_.v(i, d), -v[d], v[d]);
    if (i == last) continue;
    for (int d = 0; d < layout_.drives(); ++d) box(layout_.a(i, d), -a[d], a[d]);
  }
  const auto velocity = [](const VectorXd& given, int d) { return given.size() > 0 ? given[d] : 0.0; };
  for (int c = 0; c < layout_.columns(); ++c) {
    box(layout_.q(0, c), problem_.start[c], problem_.start[c]);
    const int goal = layout_.q(last, c);
    // A box that reaches beyond the limits ends at them.
    box(goal, std::max(problem_.goal_lower[c], std::min(bounds_.lower[goal], problem_.goal_upper[c])),
        std::min(problem_.goal_upper[c], std::max(bounds_.upper[goal], problem_.goal_lower[c])));
  }
  for (int d = 0; d < layout_.drives(); ++d) {
    const double first = velocity(problem_.start_velocity, d), end = velocity(problem_.end_velocity, d);
    box(layout_.v(0, d), first, first);
    box(layout_.v(last, d), end, end);
  }
  for (std::size_t s = 0; s < problem_.segments.size(); ++s) {
    const WholeBodySegment& segment = problem_.segments[s];
    box(layout_.h(static_cast<int>(s)), std::max(kLeastStep, segment.min_duration / segment.intervals),
        std::min(kLongestStep, segment.max_duration / segment.intervals));
  }
}

void WholeBodyNlp::add(std::unique_ptr<Term> term) {
  row_at_.push_back(rows_);
  jacobian_at_.push_back(jacobian_.size());
  hessian_at_.push_back(hessian_.size());
  for (const auto& [row, column] : term->jacobian_pattern()) jacobian_.add(rows_ + row, term->variables[column]);
  for (const auto& [row, column] : term->hessian_pattern()) {
    const int i = term->variables[row], j = term->variables[column];
    hessian_.add(std::max(i, j), std::min(i, j));
  }
  rows_ += term->rows();
  if (local_.size() < term->variables.size()) local_.resize(term->variables.size());
  terms_.push_back(std::move(term));
}

void WholeBodyNlp::add_motion() {
  const bool diff_drive = moving_base(problem_.group) == BaseKind::diff_drive;
  const std::vector<std::string> drives = drive_names(problem_.group);
  const auto make = [&](auto term, int waypoint, std::vector<int> variables, const std::string& what) {
    term->variables = std::move(variables);
    term->kind = "dynamics";
    term->waypoint = waypoint;
    term->what = what;
    add(std::move(term));
  };
  for (int i = 0; i < layout_.intervals(); ++i) {
    const int h = layout_.h(layout_.segment(i));
    const auto zero = [](auto term, int rows) {
      term->lower = term->upper = VectorXd::Zero(rows);
      return term;
    };
    for (int d = 0; d < layout_.drives(); ++d) {
      const std::string& what = drives[d];
      make(zero(std::make_unique<VelocityStep>(), 1), i, {layout_.v(i, d), layout_.v(i + 1, d), layout_.a(i, d), h},
           what);
      if (diff_drive && d == 0) continue;
      const int c = d + (diff_drive ? 1 : 0);
      make(zero(std::make_unique<PositionStep>(), 1), i,
           {layout_.q(i, c), layout_.q(i + 1, c), layout_.v(i, d), layout_.v(i + 1, d), h}, what);
    }
    if (!diff_drive) continue;
    make(zero(std::make_unique<UnicycleStep>(), 2), i,
         {layout_.q(i, 0), layout_.q(i + 1, 0), layout_.q(i, 1), layout_.q(i + 1, 1), layout_.q(i, 2), layout_.v(i, 1),
          layout_.v(i + 1, 1), layout_.v(i, 0), layout_.v(i + 1, 0), h},
         "x, y");
  }
}

void WholeBodyNlp::add_limits() {
  const JointGroup& group = problem_.group;
  const BaseKind base = moving_base(group);
  const BaseLimits& limits = group.robot().base_limits();
  const auto make = [&](auto term, int waypoint, std::vector<int> variables, double lower, double upper,
                        const char* kind, const std::string& what) {
    term->variables = std::move(variables);
    term->lower = VectorXd::Constant(1, lower);
    term->upper = VectorXd::Constant(1, upper);
    term->kind = kind;
    term->waypoint = waypoint;
    term->what = what;
    add(std::move(term));
  };
  const bool wheels = base == BaseKind::diff_drive && std::isfinite(limits.wheel_velocity);
  const double half = 0.5 * limits.wheel_separation;
  const VectorXd a = drive_acceleration_limits(group);
  for (int i = 0; i <= layout_.intervals(); ++i) {
    if (wheels) {
      for (const double side : {-half, half}) {
        make(std::make_unique<LinearTerm>(std::vector<double>{1, side}), i, {layout_.v(i, 0), layout_.v(i, 1)},
             -limits.wheel_velocity, limits.wheel_velocity, "wheel speed", side < 0 ? "left" : "right");
      }
    }
    if (base == BaseKind::omni) {
      make(std::make_unique<SquareSum>(), i, {layout_.v(i, 0), layout_.v(i, 1)}, -kInfinity,
           limits.linear_velocity * limits.linear_velocity, "velocity", "base");
    }
    if (i == layout_.intervals()) break;
    if (base == BaseKind::omni) {
      make(std::make_unique<SquareSum>(), i, {layout_.a(i, 0), layout_.a(i, 1)}, -kInfinity,
           limits.linear_acceleration * limits.linear_acceleration, "acceleration", "base");
    }
    const int h = layout_.h(layout_.segment(i));
    for (int c = 0; c < layout_.columns(); ++c) {
      // x and y of a base have a workspace of many metres.
      const std::size_t at = c;
      if (group.wraps()[at] || (group.has_base() && c < 3)) continue;
      if (!std::isfinite(group.lower()[c]) && !std::isfinite(group.upper()[c])) continue;
      make(std::make_unique<BulgeTerm>(), i,
           {layout_.q(i, c), layout_.v(i, c - (base == BaseKind::diff_drive ? 1 : 0)), h}, group.lower()[c],
           group.upper()[c], "position", group.names()[at]);
    }
    if (problem_.jerk_time <= 0) continue;
    for (int d = 0; d < layout_.drives(); ++d) {
      const double rate = a[d] / problem_.jerk_time;
      for (const double sign : {-1.0, 1.0}) {
        if (i > 0)
          make(std::make_unique<LinearTerm>(std::vector<double>{sign, -sign, -rate}), i,
               {layout_.a(i, d), layout_.a(i - 1, d), h}, -kInfinity, 0, "jerk", drive_names(group)[d]);
        // From rest and to rest the acceleration begins and ends at 0.
        if ((i == 0 && problem_.starts_at_rest()) || (i + 1 == problem_.intervals() && problem_.ends_at_rest()))
          make(std::make_unique<LinearTerm>(std::vector<double>{sign, -rate}), i, {layout_.a(i, d), h}, -kInfinity, 0,
               "jerk", drive_names(group)[d]);
      }
    }
  }
}

void WholeBodyNlp::add_mecanum_wheels() {
  constexpr int kPlaces = 4;  // of an interval
  if (moving_base(problem_.group) != BaseKind::omni) return;
  const BaseLimits& limits = problem_.group.robot().base_limits();
  const WheelRows rows = wheel_rows(BaseKind::omni, limits);
  if (rows.rows() == 0) return;
  // The velocity in the frame of a base that turns is bent by 2 omega a + alpha v + omega^2 v at most; a bent line goes
  // beyond its chord over a time d by d^2 / 8 of that.
  const double v = std::min(limits.linear_velocity, limits.wheel_velocity), omega = limits.angular_velocity;
  const double bend = 2 * omega * limits.linear_acceleration + (limits.angular_acceleration + omega * omega) * v;
  const double bulge = rows.row(0).head<2>().norm() * bend / (8 * kPlaces * kPlaces) / limits.wheel_velocity;
  for (int i = 0; i < layout_.intervals(); ++i) {
    // Velocities at both ends are given. Another segment's time step may be shorter and make up for less.
    const bool another = i + 1 < layout_.intervals() && layout_.segment(i + 1) != layout_.segment(i);
    for (int place = i == 0 ? 1 : 0; place < kPlaces + (another ? 1 : 0); ++place) {
      auto term = std::make_unique<WheelTerm>(rows, static_cast<double>(place) / kPlaces, bulge);
      term->variables = {layout_.q(i, 2),     layout_.v(i, 0), layout_.v(i + 1, 0), layout_.v(i, 1),
                         layout_.v(i + 1, 1), layout_.v(i, 2), layout_.v(i + 1, 2), layout_.h(layout_.segment(i))};
      term->upper = VectorXd::Constant(rows.rows(), limits.wheel_velocity);
      term->lower = -term->upper;
      term->kind = "wheel speed";
      term->waypoint = i;
      term->what = "Mecanum wheels";
      add(std::move(term));
    }
  }
}

void WholeBodyNlp::add_tool() {
  const auto chain = std::make_shared<const ToolChain>(problem_.group);
  const bool diff_drive = moving_base(problem_.group) == BaseKind::diff_drive;
  for (const ToolConstraint& tool : problem_.tool) {
    std::vector<int> q, v;
    for (const ToolChain::Step& step : chain->steps()) {
      q.push_back(layout_.q(tool.waypoint, step.column));
      if (diff_drive && step.column == 0) continue;
      v.push_back(layout_.v(tool.waypoint, step.column - (diff_drive ? 1 : 0)));
    }
    auto pose = std::make_unique<ToolPoseTerm>(chain, tool);
    pose->variables = q;
    if (pose->rows() > 0) add(std::move(pose));

    std::vector<int> both = q;
    both.insert(both.end(), v.begin(), v.end());
    const auto velocity = [&](const Eigen::Matrix3Xd& directions, const VectorXd& lower, const VectorXd& upper) {
      auto term = std::make_unique<ToolVelocityTerm>(chain, diff_drive, directions);
      term->variables = both;
      term->waypoint = tool.waypoint;
      term->lower = lower;
      term->upper = upper;
      add(std::move(term));
    };
    if (std::isfinite(tool.max_speed)) {
      velocity(Eigen::Matrix3Xd(3, 0), VectorXd::Constant(1, -kInfinity),
               VectorXd::Constant(1, tool.max_speed * tool.max_speed));
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(tool.velocity_lower[axis]) && !std::isfinite(tool.velocity_upper[axis])) continue;
      velocity(tool.T_world_tip.linear().col(axis), VectorXd::Constant(1, tool.velocity_lower[axis]),
               VectorXd::Constant(1, tool.velocity_upper[axis]));
    }
  }
}

VectorXd WholeBodyNlp::pack(const WholeBodyGuess& guess) const {
  const int last = layout_.intervals(), n = layout_.columns();
  require(static_cast<int>(guess.positions.size()) == last + 1, "guess.positions",
          static_cast<double>(guess.positions.size()), "must hold " + std::to_string(last + 1) + " waypoints");
  require(guess.steps.size() == problem_.segments.size(), "guess.steps", static_cast<double>(guess.steps.size()),
          "must hold one time step per segment");
  for (double h : guess.steps) require_positive(h, "guess.steps");
  for (std::size_t i = 0; i < guess.positions.size(); ++i)
    problem_.group.check_configuration(guess.positions[i], "guess.positions[" + std::to_string(i) + "]");
  require(guess.drive.empty() || guess.drive.size() == guess.positions.size(), "guess.drive",
          static_cast<double>(guess.drive.size()), "must be empty or hold one per waypoint");

  VectorXd x = VectorXd::Zero(layout_.size());
  for (std::size_t s = 0; s < guess.steps.size(); ++s) x[layout_.h(static_cast<int>(s))] = guess.steps[s];
  const auto step = [&](int i) { return guess.steps[layout_.segment(i)]; };
  const auto at = [&](int i) -> const VectorXd& { return guess.positions[i]; };
  const bool diff_drive = moving_base(problem_.group) == BaseKind::diff_drive;
  for (int i = 0; i <= last; ++i) {
    x.segment(layout_.q(i, 0), n) = at(i);
    VectorXd drive;
    if (!guess.drive.empty()) {
      drive = guess.drive[i];
      require(drive.size() == layout_.drives() && drive.allFinite(), "guess.drive", static_cast<double>(i),
              "must be finite and of the length of drive_names");
    } else if (i > 0 && i < last) {
      const VectorXd rate = (at(i + 1) - at(i - 1)) / (step(i - 1) + step(i));
      drive = rate.tail(layout_.drives());
      if (diff_drive) drive[0] = rate[0] * std::cos(at(i)[2]) + rate[1] * std::sin(at(i)[2]);
    } else {
      drive = VectorXd::Zero(layout_.drives());
    }
    x.segment(layout_.v(i, 0), layout_.drives()) = drive;
  }
  x = x.cwiseMax(bounds_.lower).cwiseMin(bounds_.upper);
  for (int i = 0; i < last; ++i)
    for (int d = 0; d < layout_.drives(); ++d)
      x[layout_.a(i, d)] = (x[layout_.v(i + 1, d)] - x[layout_.v(i, d)]) / x[layout_.h(layout_.segment(i))];
  return x.cwiseMax(bounds_.lower).cwiseMin(bounds_.upper);
}

WholeBodyTrajectory WholeBodyNlp::trajectory(const VectorXd& x) const {
  std::vector<double> times;
  std::vector<VectorXd> positions, drive;
  for (int i = 0; i <= layout_.intervals(); ++i) {
    times.push_back(i == 0 ? 0 : times.back() + x[layout_.h(layout_.segment(i - 1))]);
    positions.push_back(x.segment(layout_.q(i, 0), layout_.columns()));
    drive.push_back(x.segment(layout_.v(i, 0), layout_.drives()));
  }
  return {problem_.group, times, positions, drive};
}

Bounds WholeBodyNlp::constraint_bounds() const {
  Bounds bounds{VectorXd(rows_), VectorXd(rows_)};
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    bounds.lower.segment(row_at_[t], terms_[t]->rows()) = terms_[t]->lower;
    bounds.upper.segment(row_at_[t], terms_[t]->rows()) = terms_[t]->upper;
  }
  return bounds;
}

double WholeBodyNlp::objective(const VectorXd& x) {
  double sum = 0;
  for (std::size_t s = 0; s < problem_.segments.size(); ++s)
    sum += x[layout_.h(static_cast<int>(s))] * problem_.segments[s].intervals;
  for (int i = 0; i < layout_.intervals(); ++i)
    sum += smoothing_.dot(x.segment(layout_.a(i, 0), layout_.drives()).cwiseAbs2());
  return sum;
}

void WholeBodyNlp::gradient(const VectorXd& x, Eigen::Ref<VectorXd> out) {
  out.setZero();
  for (std::size_t s = 0; s < problem_.segments.size(); ++s)
    out[layout_.h(static_cast<int>(s))] = problem_.segments[s].intervals;
  for (int i = 0; i < layout_.intervals(); ++i) {
    out.segment(layout_.a(i, 0), layout_.drives()) =
        2 * smoothing_.cwiseProduct(x.segment(layout_.a(i, 0), layout_.drives()));
  }
}

const double* WholeBodyNlp::gathered(const Term& term, const VectorXd& x) {
  for (std::size_t i = 0; i < term.variables.size(); ++i) local_[i] = x[term.variables[i]];
  return local_.data();
}

void WholeBodyNlp::constraints(const VectorXd& x, Eigen::Ref<VectorXd> out) {
  for (std::size_t t = 0; t < terms_.size(); ++t) terms_[t]->value(gathered(*terms_[t], x), out.data() + row_at_[t]);
}

void WholeBodyNlp::jacobian(const VectorXd& x, Eigen::Ref<VectorXd> values) {
  for (std::size_t t = 0; t < terms_.size(); ++t)
    terms_[t]->jacobian(gathered(*terms_[t], x), values.data() + jacobian_at_[t]);
}

void WholeBodyNlp::hessian(const VectorXd& x, double factor, const VectorXd& multipliers, Eigen::Ref<VectorXd> values) {
  const Eigen::Index segments = static_cast<Eigen::Index>(problem_.segments.size());
  values.head(segments).setZero();
  for (int i = 0; i < layout_.intervals(); ++i)
    values.segment(segments + i * layout_.drives(), layout_.drives()) = 2 * factor * smoothing_;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    terms_[t]->hessian(gathered(*terms_[t], x), multipliers.data() + row_at_[t], values.data() + hessian_at_[t]);
  }
}

std::string WholeBodyNlp::constraint_name(int index) const {
  const auto after = std::upper_bound(row_at_.begin(), row_at_.end(), index);
  const std::size_t t = after - row_at_.begin() - 1;
  return terms_[t]->kind + " of " + terms_[t]->what + " at waypoint " + std::to_string(terms_[t]->waypoint);
}

}  // namespace mmgrasp::detail
