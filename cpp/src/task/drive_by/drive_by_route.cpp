#include "task/drive_by/drive_by_route.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/no_time_limit.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "task/drive_by/drive_by_goals.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr int kWays = 3;      // sampled, of which the quickest is taken
constexpr int kDraws = 2000;  // the planner's samples
constexpr int kShortenings = 100;
constexpr double kSpacing = 0.25;  // distance between places on the reference path [m]
constexpr int kExits = 3;          // tried of it
constexpr std::size_t kApart = 3;  // places between exits tried

double duration(const JointGroup& group, const std::vector<VectorXd>& points) {
  double time = 0;
  for (std::size_t k = 1; k < points.size(); ++k) time += travel_time(group, points[k - 1], points[k]);
  return time;
}

/// `points`, whose first is where `way` ends up to full turns, moved by these turns and put behind it.
void append(std::vector<VectorXd>& way, const std::vector<VectorXd>& points) {
  const VectorXd turns = way.back() - points.front();
  for (std::size_t i = 1; i < points.size(); ++i) way.push_back(points[i] + turns);
}

/// The sequence from the root to the tip, everything as in the configuration.
JointGroup standing_arm(const JointGroup& group, const VectorXd& q, VectorXd& home) {
  const Robot& robot = group.robot();
  const VectorXd values = group.full_values(q);
  const auto link = [&](int index) { return robot.links()[index].name; };
  const JointGroup arm = robot.chain(link(robot.root_link()), link(group.tip_link())).with_reference(values);
  home.resize(arm.size());
  for (int i = 0; i < arm.size(); ++i) {
    const Joint& joint = robot.joints()[arm.joints()[i]];
    home[i] = values[joint.value_index];
  }
  return arm;
}

}  // namespace

std::optional<PathGuide::Points> PathGuide::sampled(CollisionChecker& checker, const VectorXd& from, const VectorXd& to,
                                                    int tries) {
  MotionOptions options;
  options.time_limit = detail::kNoTimeLimit;
  options.max_iterations = kDraws;
  options.shorten_iterations = kShortenings;
  std::optional<Points> best;
  for (int i = 0; i < tries; ++i) {
    options.seed = seed_ + static_cast<unsigned>(i);
    MotionResult found = plan_motion(checker, from, {to}, options, {monitor_.stop, {}});
    if (found.outcome != Outcome::solved) break;
    Points& points = found.path->waypoints;
    if (!best || duration(group_, points) < duration(group_, *best)) best = std::move(points);
  }
  return best;
}

const PathGuide::Points& PathGuide::reference_path() {
  if (reference_path_) return *reference_path_;
  reference_path_.emplace();
  if (!group_.has_base()) return *reference_path_;
  BaseRouteOptions options;
  options.base = group_.robot().base();
  VectorXd home;
  const JointGroup arm = standing_arm(group_, start_, home);
  CollisionChecker standing = checker_.with_group(arm);
  const BasePath path =
      plan_base_route(standing, home, start_.head<3>(), goal_.head<3>(), options, {monitor_.stop, {}});
  if (path.outcome != Outcome::solved) return *reference_path_;
  VectorXd q = start_;
  reference_path_->push_back(q);
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const Eigen::Vector3d from = path.poses[i - 1], step = path.poses[i] - from;
    const int pieces = std::max(1, static_cast<int>(std::ceil(step.head<2>().norm() / kSpacing)));
    for (int k = 1; k <= pieces; ++k) {
      q.head<3>() = from + step * (static_cast<double>(k) / pieces);
      reference_path_->push_back(q);
    }
  }
  return *reference_path_;
}

std::vector<std::size_t> PathGuide::exits(const VectorXd& q) const {
  if (q == start_) return {0};
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < reference_path_->size(); ++i)
    order.push_back({((*reference_path_)[i] - q).head<2>().norm(), i});
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> result;
  for (const auto& [distance, i] : order) {
    const bool new_place = std::all_of(result.begin(), result.end(), [place = i](std::size_t other) {
      return std::max(place, other) - std::min(place, other) > kApart;
    });
    if (new_place) result.push_back(i);
    if (static_cast<int>(result.size()) == kExits) break;
  }
  return result;
}

std::optional<PathGuide::Points> PathGuide::along_reference_path(CollisionChecker& checker, const VectorXd& from,
                                                                 const VectorXd& to) {
  if (reference_path().empty()) return {};
  const auto reach = [&](const VectorXd& q, bool leaves) -> std::pair<std::optional<Points>, std::size_t> {
    for (std::size_t i : exits(q)) {
      auto part =
          leaves ? sampled(checker, q, (*reference_path_)[i], 1) : sampled(checker, (*reference_path_)[i], q, 1);
      if (part) return {std::move(part), i};
    }
    return {};
  };
  const auto [first, enter] = reach(from, true);
  if (!first) return {};
  const auto [last, leave] = reach(to, false);
  if (!last) return {};
  Points way = *first;
  const auto at = [&](std::size_t i) { return reference_path_->begin() + static_cast<std::ptrdiff_t>(i); };
  Points middle = enter <= leave ? Points(at(enter), at(leave) + 1) : Points(at(leave), at(enter) + 1);
  if (enter > leave) std::reverse(middle.begin(), middle.end());
  append(way, middle);
  append(way, *last);
  return way;
}

std::optional<GuidedWay> PathGuide::way(CollisionChecker& checker, const VectorXd& from, const VectorXd& to,
                                        bool by_reference_path) {
  std::optional<Points> points;
  if (by_reference_path) points = along_reference_path(checker, from, to);
  if (!points) points = sampled(checker, from, to, kWays);
  if (!points && !by_reference_path) points = along_reference_path(checker, from, to);
  if (!points) return {};
  GuidedWay way{std::move(*points), {0}};
  for (std::size_t k = 1; k < way.points.size(); ++k)
    way.times.push_back(way.times.back() + travel_time(group_, way.points[k - 1], way.points[k]));
  return way;
}

}  // namespace mmgrasp::detail
