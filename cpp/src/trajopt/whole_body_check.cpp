// check_whole_body(): judges a trajectory by other means than the optimiser's.
#include "trajopt/whole_body_check.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "mmgrasp/trajopt/optimize_whole_body.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

constexpr int kSteps = 128;  // Runge-Kutta steps per interval: good to 1e-9 m at intervals of 2 s

/// The largest violation of each kind, in the order in which kinds are first named.
class Ledger {
 public:
  explicit Ledger(const WholeBodyTrajectory& trajectory) : trajectory_(trajectory) {}

  void open(const std::string& kind, const std::string& unit, double tolerance) {
    Violation v;
    v.kind = kind;
    v.unit = unit;
    v.tolerance = tolerance;
    list_.push_back(v);
  }
  /// Notes a value of the kind that was opened last.
  void note(double value, double time, const std::string& what) {
    Violation& v = list_.back();
    if (!(value > v.value) && !std::isnan(value)) return;
    v.value = std::isnan(value) ? detail::kInfinity : value;
    v.time = time;
    v.what = what;
    const std::vector<double>& times = trajectory_.times();
    const auto after = std::upper_bound(times.begin(), times.end(), time + 1e-12);
    v.waypoint = std::max(0, static_cast<int>(after - times.begin()) - 1);
  }
  std::vector<Violation> list() { return std::move(list_); }

 private:
  const WholeBodyTrajectory& trajectory_;
  std::vector<Violation> list_;
};

double outside(double value, double lower, double upper) {
  return std::max({0.0, lower - value, value - upper});
}

struct Sample {
  double time;
  int interval;
  VectorXd q, drive;
};

std::vector<Sample> samples_of(const WholeBodyTrajectory& trajectory, int resolution_factor) {
  std::vector<Sample> samples;
  const auto& times = trajectory.times();
  for (int i = 0; i + 1 < static_cast<int>(times.size()); ++i) {
    const double h = times[i + 1] - times[i];
    for (int k = 0; k < resolution_factor; ++k) {
      const double time = times[i] + h * k / resolution_factor;
      samples.push_back({time, i, trajectory.at(time), trajectory.drive_at(time)});
    }
  }
  const int last = static_cast<int>(times.size()) - 2;
  samples.push_back({trajectory.duration(), last, trajectory.positions().back(), trajectory.drive().back()});
  return samples;
}

void check_motion(Ledger& ledger, const WholeBodyTrajectory& t) {
  const JointGroup& group = t.group();
  const bool diff_drive = moving_base(group) == BaseKind::diff_drive;
  // Each interval by itself, integrated from its first waypoint.
  std::vector<VectorXd> ends;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const WholeBodyTrajectory one(group, {t.times()[i], t.times()[i + 1]}, {t.positions()[i], t.positions()[i + 1]},
                                  {t.drive()[i], t.drive()[i + 1]});
    ends.push_back(one.rolled_out(kSteps).back() - t.positions()[i + 1]);
  }
  ledger.open("dynamics", "rad or m", 1e-8);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (int c = 0; c < group.size(); ++c) ledger.note(std::abs(ends[i][c]), t.times()[i], group.names()[c]);
  }
  if (!group.has_base()) return;
  if (diff_drive) {
    ledger.open("nonholonomic", "m/s", 1e-6);
    // What the roll-out misses the next waypoint by, along the wheels' axle, had to be slipped.
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const double theta = t.positions()[i + 1][2], h = t.times()[i + 1] - t.times()[i];
      const double across = -std::sin(theta) * ends[i][0] + std::cos(theta) * ends[i][1];
      ledger.note(std::abs(across) / h, t.times()[i], "sideways");
    }
  }
  const std::vector<VectorXd> whole = t.rolled_out(kSteps);
  ledger.open("drift", "m", 1e-6 * static_cast<double>(t.size()));
  for (std::size_t i = 0; i < t.size(); ++i)
    ledger.note((whole[i] - t.positions()[i]).head<2>().norm(), t.times()[i], "x, y from the start on");
}

void check_limits(Ledger& ledger, const WholeBodyProblem& problem, const WholeBodyTrajectory& t,
                  const std::vector<Sample>& samples) {
  const JointGroup& group = problem.group;
  const BaseKind base = moving_base(group);
  const BaseLimits& limits = group.robot().base_limits();
  const std::vector<std::string> drives = drive_names(group);
  ledger.open("position", "rad or m", 1e-5);  // what limits printed to five digits lose, as in collision checks
  for (const Sample& s : samples) {
    for (int c = 0; c < group.size(); ++c) {
      if (group.wraps()[c]) continue;
      ledger.note(outside(s.q[c], group.lower()[c], group.upper()[c]), s.time, group.names()[c]);
    }
  }
  const VectorXd v = drive_velocity_limits(group), a = drive_acceleration_limits(group);
  ledger.open("velocity", "rad/s or m/s", 1e-6);
  for (const Sample& s : samples) {
    for (Eigen::Index d = 0; d < v.size(); ++d) ledger.note(outside(s.drive[d], -v[d], v[d]), s.time, drives[d]);
    if (base == BaseKind::omni) ledger.note(s.drive.head<2>().norm() - limits.linear_velocity, s.time, "base");
  }
  if (base == BaseKind::diff_drive) {
    ledger.open("wheel speed", "m/s", 1e-6);
    for (const Sample& s : samples) {
      const WheelSpeeds wheels = wheel_speeds(s.drive[0], s.drive[1], limits.wheel_separation);
      ledger.note(std::abs(wheels.left) - limits.wheel_velocity, s.time, "left");
      ledger.note(std::abs(wheels.right) - limits.wheel_velocity, s.time, "right");
    }
  }
  if (const WheelRows rows = wheel_rows(base, limits); base == BaseKind::omni && rows.rows() > 0) {
    const char* wheels[] = {"front left", "front right", "rear left", "rear right"};
    ledger.open("wheel speed", "m/s", 1e-6);
    for (const Sample& s : samples) {
      const VectorXd rims = rows * platform_velocity(s.q[2], s.drive.head<3>());
      for (Eigen::Index i = 0; i < rims.size(); ++i)
        ledger.note(std::abs(rims[i]) - limits.wheel_velocity, s.time, wheels[i]);
    }
  }
  ledger.open("acceleration", "rad/s^2 or m/s^2", 1e-5);
  VectorXd before;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const VectorXd slope = (t.drive()[i + 1] - t.drive()[i]) / (t.times()[i + 1] - t.times()[i]);
    for (Eigen::Index d = 0; d < a.size(); ++d) ledger.note(outside(slope[d], -a[d], a[d]), t.times()[i], drives[d]);
    if (base == BaseKind::omni) ledger.note(slope.head<2>().norm() - limits.linear_acceleration, t.times()[i], "base");
  }
  if (problem.jerk_time <= 0) return;
  ledger.open("jerk", "rad/s^3 or m/s^3", 1e-4);
  const auto acceleration = [&](std::size_t i) {  // between waypoints i and i + 1
    return VectorXd((t.drive()[i + 1] - t.drive()[i]) / (t.times()[i + 1] - t.times()[i]));
  };
  const auto note_jump = [&](const VectorXd& jump, std::size_t interval, double time) {
    const double h = t.times()[interval + 1] - t.times()[interval];
    for (Eigen::Index d = 0; d < a.size(); ++d)
      ledger.note(std::abs(jump[d]) / h - a[d] / problem.jerk_time, time, drives[d]);
  };
  if (problem.starts_at_rest()) note_jump(acceleration(0), 0, 0);
  for (std::size_t i = 1; i + 1 < t.size(); ++i) note_jump(acceleration(i) - acceleration(i - 1), i, t.times()[i]);
  if (problem.ends_at_rest()) note_jump(acceleration(t.size() - 2), t.size() - 2, t.duration());
}

void check_ends(Ledger& ledger, const WholeBodyProblem& problem, const WholeBodyTrajectory& t) {
  const JointGroup& group = problem.group;
  const auto name = [&](int c) { return group.names()[c]; };
  const auto velocity = [&](const VectorXd& given, const VectorXd& is) {
    return (given.size() > 0 ? VectorXd(is - given) : is).cwiseAbs().maxCoeff();
  };
  ledger.open("start", "rad or m", 1e-8);
  for (int c = 0; c < group.size(); ++c) ledger.note(std::abs(t.positions().front()[c] - problem.start[c]), 0, name(c));
  ledger.note(velocity(problem.start_velocity, t.drive().front()), 0, "velocity");
  ledger.open("goal", "rad or m", 1e-8);
  for (int c = 0; c < group.size(); ++c) {
    ledger.note(outside(t.positions().back()[c], problem.goal_lower[c], problem.goal_upper[c]), t.duration(), name(c));
  }
  ledger.note(velocity(problem.end_velocity, t.drive().back()), t.duration(), "velocity");
  ledger.open("segment duration", "s", 1e-6);
  for (int s = 0; s < static_cast<int>(problem.segments.size()); ++s) {
    const double from = s == 0 ? 0 : t.times()[problem.segment_end(s - 1)];
    const WholeBodySegment& segment = problem.segments[s];
    ledger.note(outside(t.times()[problem.segment_end(s)] - from, segment.min_duration, segment.max_duration), from,
                "segment " + std::to_string(s));
  }
}

/// Where the tip is, in the frame of its target: translation, then twice the quaternion's vector part.
Vector6d tool_error(const JointGroup& group, const Pose& T_world_target, const VectorXd& q) {
  const Pose T_target_tip = T_world_target.inverse() * group.fk(q);
  const Eigen::Vector3d turn = rotation_vector(T_target_tip.linear());
  Vector6d error;
  error << T_target_tip.translation(), turn * (turn.norm() > 1e-12 ? 2 * std::sin(turn.norm() / 2) / turn.norm() : 1);
  return error;
}

void check_tool(Ledger& ledger, const WholeBodyProblem& problem, const WholeBodyTrajectory& t) {
  if (problem.tool.empty()) return;
  std::vector<Vector6d> errors;
  std::vector<Eigen::Vector3d> speeds;
  for (const ToolConstraint& tool : problem.tool) {
    const std::size_t at = tool.waypoint;
    const VectorXd& q = t.positions()[at];
    errors.push_back(tool_error(problem.group, tool.T_world_tip, q));
    const VectorXd rate = configuration_velocity(problem.group, q, t.drive()[at]);
    speeds.push_back(tool.T_world_tip.linear().transpose() * (problem.group.jacobian(q) * rate).head<3>());
  }
  const char* axes[] = {"x", "y", "z"};
  const auto over = [&](const char* kind, const char* unit, double tolerance, auto&& each) {
    ledger.open(kind, unit, tolerance);
    for (std::size_t i = 0; i < problem.tool.size(); ++i) {
      const double time = t.times()[problem.tool[i].waypoint];
      each(i, time, "tool constraint " + std::to_string(i) + ", ");
    }
  };
  over("task position", "m", 1e-6, [&](std::size_t i, double time, const std::string& what) {
    for (int k = 0; k < 3; ++k)
      ledger.note(outside(errors[i][k], problem.tool[i].lower[k], problem.tool[i].upper[k]), time, what + axes[k]);
  });
  over("task rotation", "rad", 1e-6, [&](std::size_t i, double time, const std::string& what) {
    for (int k = 3; k < 6; ++k) {
      // Either sign of the quaternion means the same rotation.
      const double lower = problem.tool[i].lower[k], upper = problem.tool[i].upper[k];
      ledger.note(std::min(outside(errors[i][k], lower, upper), outside(-errors[i][k], lower, upper)), time,
                  what + "about " + axes[k - 3]);
    }
  });
  over("tool speed", "m/s", 1e-6, [&](std::size_t i, double time, const std::string& what) {
    ledger.note(speeds[i].norm() - problem.tool[i].max_speed, time, what + "speed");
    for (int k = 0; k < 3; ++k) {
      ledger.note(outside(speeds[i][k], problem.tool[i].velocity_lower[k], problem.tool[i].velocity_upper[k]), time,
                  what + "along " + axes[k]);
    }
  });
}

/// The tool strays from a pose that two waypoints hold by less than what a gripper's grasp allows.
void check_held_tool(Ledger& ledger, const WholeBodyProblem& problem, const std::vector<Sample>& samples) {
  // [m], [rad]; a twentieth is left to who looks at other times: verify allows 2 mm and 0.02 rad.
  constexpr double kShift = 1.9e-3, kTurn = 0.019;
  struct Worst {
    double value = 0, time = 0;
    std::string what;
  } shift, turn;
  const auto note = [](Worst& worst, double value, double time, std::size_t constraint) {
    if (value > worst.value) worst = {value, time, "tool constraint " + std::to_string(constraint)};
  };
  for (std::size_t i = 0; i + 1 < problem.tool.size(); ++i) {
    const ToolConstraint &from = problem.tool[i], &to = problem.tool[i + 1];
    if (to.waypoint != from.waypoint + 1 || !from.T_world_tip.isApprox(to.T_world_tip, 1e-12)) continue;
    for (const Sample& sample : samples) {
      if (sample.interval != from.waypoint) continue;
      const Vector6d error = tool_error(problem.group, from.T_world_tip, sample.q);
      Vector6d off, turned;  // `turned`: by the quaternion's other sign
      for (int k = 0; k < 6; ++k) {
        const double lower = std::min(from.lower[k], to.lower[k]), upper = std::max(from.upper[k], to.upper[k]);
        off[k] = outside(error[k], lower, upper);
        turned[k] = outside(-error[k], lower, upper);
      }
      note(shift, off.head<3>().norm(), sample.time, i);
      note(turn, std::min(off.tail<3>().norm(), turned.tail<3>().norm()), sample.time, i);
    }
  }
  ledger.open("held tool position", "m", kShift);
  ledger.note(shift.value, shift.time, shift.what);
  ledger.open("held tool rotation", "rad", kTurn);
  ledger.note(turn.value, turn.time, turn.what);
}

struct Moment {
  double time;
  VectorXd q;
};

/// How far each joint leaves the straight line between two moments of one interval: curves of the third degree, which
/// are known at three places, go less than a third beyond the farthest of them.
VectorXd bend_between(const WholeBodyTrajectory& t, const Moment& from, const Moment& to, const Moment& middle) {
  const VectorXd step = to.q - from.q;
  VectorXd bend = (middle.q - from.q - 0.5 * step).cwiseAbs();
  for (const double s : {0.25, 0.75})
    bend = bend.cwiseMax((t.at((1 - s) * from.time + s * to.time) - from.q - s * step).cwiseAbs());
  return 4.0 / 3 * bend;
}

/// Where an edge is not free.
struct Meeting {
  double time;
  VectorXd q;
  std::string what;
};

/// Conservative advancement along the straight edge with what the motion strays from it added to what has to be clear;
/// halves where that is not enough to tell.
void find_meetings(std::vector<Meeting>& meetings, CollisionChecker& checker, const WholeBodyTrajectory& t,
                   const Moment& from, const Moment& to, int splits) {
  constexpr double kStraight = 5e-6, kDepth = 1e-3;  // [rad] or [m]; the latter where it is only to tell how deep
  const JointGroup& group = t.group();
  const auto inside = [&](const VectorXd& q) {  // limits are checked elsewhere, with their own slack
    return VectorXd(q.cwiseMax(group.lower()).cwiseMin(group.upper()));
  };
  const Moment middle{0.5 * (from.time + to.time), t.at(0.5 * (from.time + to.time))};
  EdgeOptions edge;
  edge.continuous = true;
  edge.bend = bend_between(t, from, to, middle);
  const VectorXd begin = inside(from.q), end = inside(to.q);
  const EdgeResult r = check_edge(checker, begin, end, edge);
  if (r.free) return;
  const bool collides = r.fraction == 0 && checker.first_contact(begin);
  if (splits > 0 && edge.bend.maxCoeff() > (collides ? kDepth : kStraight)) {
    find_meetings(meetings, checker, t, from, middle, splits - 1);
    find_meetings(meetings, checker, t, middle, to, splits - 1);
    return;
  }
  meetings.push_back({from.time + r.fraction * (to.time - from.time), begin + r.fraction * (end - begin),
                      r.contact ? r.contact->a + " and " + r.contact->b : "limits"});
}

std::vector<Meeting> meetings_in(const WholeBodyTrajectory& t, std::size_t interval, CollisionChecker& checker) {
  constexpr int kMostSplits = 12;
  std::vector<Meeting> meetings;
  find_meetings(meetings, checker, t, {t.times()[interval], t.positions()[interval]},
                {t.times()[interval + 1], t.positions()[interval + 1]}, kMostSplits);
  return meetings;
}

void check_collisions(Ledger& ledger, const std::vector<CollisionChecker*>& checkers, const WholeBodyTrajectory& t) {
  if (checkers.empty()) return;
  ledger.open("collision", "m", 0);
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    if (!checkers[i]) continue;
    for (const Meeting& meeting : meetings_in(t, i, *checkers[i]))
      ledger.note(std::max(-checkers[i]->distance(meeting.q).value, 1e-9), meeting.time, meeting.what);
  }
}

}  // namespace

std::vector<std::pair<int, double>> detail::collision_places(const WholeBodyTrajectory& t,
                                                             const std::vector<CollisionChecker*>& checkers) {
  std::vector<std::pair<int, double>> places;
  for (std::size_t i = 0; i < checkers.size(); ++i) {
    if (!checkers[i]) continue;
    for (const Meeting& meeting : meetings_in(t, i, *checkers[i]))
      places.push_back({static_cast<int>(i), (meeting.time - t.times()[i]) / (t.times()[i + 1] - t.times()[i])});
  }
  return places;
}

std::vector<Violation> check_whole_body(const WholeBodyProblem& problem, const WholeBodyTrajectory& trajectory,
                                        const std::vector<CollisionChecker*>& checkers, int resolution_factor) {
  Ledger ledger(trajectory);
  const std::vector<Sample> samples = samples_of(trajectory, resolution_factor);
  check_motion(ledger, trajectory);
  check_limits(ledger, problem, trajectory, samples);
  check_ends(ledger, problem, trajectory);
  check_tool(ledger, problem, trajectory);
  check_held_tool(ledger, problem, samples);
  check_collisions(ledger, checkers, trajectory);
  return ledger.list();
}

}  // namespace mmgrasp
