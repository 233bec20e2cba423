// Checks the stops with the base displaced: parts stay graspable from drawn poses.
#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "verify/context.hpp"
#include "verify/ik.hpp"

namespace mmgrasp::verify {
namespace {

constexpr int kChunks = 20;        // Pieces of a stop's samples that are worked on independently.
constexpr std::size_t kPool = 24;  // Configurations remembered for a part.
constexpr int kTries = 1500;       // IK solutions tried from other seeds before a part counts as lost.

/// A grasp with an arm configuration that once reached it.
struct Hold {
  int grasp = -1;
  Eigen::VectorXd arm;
};

/// Holds by part, the last successful in front.
using Pools = std::vector<std::deque<Hold>>;

/// What one piece of one stop's samples gave.
struct ChunkResult {
  int samples = 0, good = 0;
  std::vector<int> lost;  ///< At how many samples a wanted part was the one that failed, by part.
  int home_blocked = 0;
};

/// The samples of a stop along a winding path over the disc, so that neighbours in the list are neighbours on the
/// floor.
std::vector<Eigen::Vector3d> sorted_samples(const Context& context, std::size_t stop) {
  const double radius = context.plan.positioning_uncertainty;
  const Eigen::Vector3d& pose = context.plan.stops[stop].pose;
  Rng rng(context.options.seed, stop);
  std::vector<Eigen::Vector2d> offsets;
  for (int i = 0; i < context.options.samples; ++i) offsets.push_back(rng.in_disc(radius));
  const double strip = radius > 0 ? radius / 10 : 1.0;
  const auto key = [strip](const Eigen::Vector2d& p) {
    const int row = static_cast<int>(std::floor(p.x() / strip));
    return std::make_pair(row, row % 2 ? -p.y() : p.y());
  };
  std::sort(offsets.begin(), offsets.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<Eigen::Vector3d> poses;
  for (const Eigen::Vector2d& offset : offsets)
    poses.emplace_back(pose.x() + offset.x(), pose.y() + offset.y(), pose.z());
  return poses;
}

/// Target parts of the trays that the stop serves.
std::vector<int> wanted_parts(const PlanToCheck& plan, const CheckedStop& stop) {
  std::vector<int> wanted;
  for (std::size_t part = 0; part < plan.parts.size(); ++part) {
    const bool here = std::find(stop.trays.begin(), stop.trays.end(), plan.parts[part].tray) != stop.trays.end();
    if (here && plan.parts[part].target) wanted.push_back(static_cast<int>(part));
  }
  return wanted;
}

/// Finds grasps from one base pose after another.
class GraspSearch {
 public:
  GraspSearch(const Context& context, Judge& judge, Pools pools, Rng rng)
      : context_(context), judge_(judge), pools_(std::move(pools)), rng_(rng) {
    tolerance_.position = context.options.position_tolerance;
    tolerance_.rotation = context.options.rotation_tolerance;
  }

  bool find(int part) {
    std::deque<Hold>& pool = pools_[part];
    for (std::size_t i = 0; i < pool.size(); ++i) {
      Hold hold = pool[i];
      if (!try_hold(part, hold)) continue;
      pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(i));
      pool.push_front(std::move(hold));
      return true;
    }
    return search(part);
  }

 private:
  /// Moves the hold's configuration onto its grasp from the present base pose, and checks it.
  bool try_hold(int part, Hold& hold) {
    const CheckedPart& p = context_.plan.parts[part];
    const CheckedGrasp& grasp = p.grasps[hold.grasp];
    if (grasp.width > context_.plan.max_opening + 1e-6) return false;
    const Pose T_root_tip = judge_.T_world_root().inverse() * p.body.T_world_body * grasp.T_object_tcp;
    if (!solve_tip_pose(judge_.kinematics(), T_root_tip, tolerance_, hold.arm)) return false;
    return !judge_.touch(hold.arm, context_.pregrasp_opening(grasp.width));
  }

  /// Other grasps from what the pools know, then from anywhere.
  bool search(int part) {
    const int grasps = static_cast<int>(context_.plan.parts[part].grasps.size());
    for (int i = 0; grasps > 0 && i < std::max(kTries, 3 * grasps); ++i) {
      Hold hold{i < grasps ? i : static_cast<int>(rng_.index(grasps)), i % 2 ? random_arm() : known_arm(part)};
      if (!try_hold(part, hold)) continue;
      pools_[part].push_front(std::move(hold));
      if (pools_[part].size() > kPool) pools_[part].pop_back();
      return true;
    }
    return false;
  }

  Eigen::VectorXd known_arm(int part) {
    const std::deque<Hold>* pool = &pools_[part];
    if (pool->empty()) pool = &pools_[rng_.index(pools_.size())];
    return pool->empty() ? random_arm() : (*pool)[rng_.index(pool->size())].arm;
  }

  Eigen::VectorXd random_arm() {
    const Kinematics& kinematics = judge_.kinematics();
    Eigen::VectorXd arm(kinematics.arm_size());
    for (Eigen::Index j = 0; j < arm.size(); ++j) {
      const bool bounded = std::isfinite(kinematics.lower()[j]) && std::isfinite(kinematics.upper()[j]);
      arm[j] = bounded ? rng_.uniform(kinematics.lower()[j], kinematics.upper()[j]) : rng_.uniform(-M_PI, M_PI);
    }
    return arm;
  }

  const Context& context_;
  Judge& judge_;
  Pools pools_;
  Rng rng_;
  IkTolerance tolerance_;
};

/// The plan's own configurations are the first seeds.
Pools planned_holds(const Context& context) {
  Pools pools(context.plan.parts.size());
  const Eigen::Index joints = context.plan.home.size();
  for (std::size_t i = 0; i < context.plan.picks.size(); ++i) {
    const CheckedPick& pick = context.plan.picks[i];
    const int part = context.pick_part[i];
    if (part < 0 || pick.grasp < 0 || pick.grasp >= static_cast<int>(context.plan.parts[part].grasps.size())) continue;
    for (const CheckedMotion& motion : pick.motions) {
      if (motion.kind != "approach" || motion.positions.empty()) continue;
      const Eigen::VectorXd& arm = motion.positions.back();
      if (arm.size() == joints && arm.allFinite()) pools[part].push_front({pick.grasp, arm});
    }
  }
  return pools;
}

/// One piece of a stop. It ends early once it alone has lost more samples than the whole stop may lose.
ChunkResult run_chunk(const Context& context, const std::vector<Eigen::Vector3d>& poses, std::size_t begin,
                      std::size_t end, const std::vector<int>& wanted, Judge& judge, GraspSearch search) {
  ChunkResult result;
  result.lost.assign(wanted.size(), 0);
  const double allowed = (1 - context.options.required_rate) * context.options.samples;
  std::vector<std::size_t> order(wanted.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = begin; i < end; ++i) {
    if (result.samples - result.good > allowed || context.monitor.stopped()) break;
    judge.set_base(poses[i]);
    ++result.samples;
    if (judge.touch(context.plan.home, 0)) {
      ++result.home_blocked;
      continue;
    }
    const auto failed =
        std::find_if(order.begin(), order.end(), [&](std::size_t k) { return !search.find(wanted[k]); });
    if (failed == order.end()) {
      ++result.good;
    } else {
      ++result.lost[*failed];
      std::rotate(order.begin(), failed, failed + 1);  // what failed here is likely to fail next door: ask it first
    }
  }
  return result;
}

StopRate summarize(const Context& context, std::size_t stop, const std::vector<int>& wanted,
                   const std::vector<ChunkResult>& chunks, Faults& faults) {
  StopRate rate;
  rate.stop = static_cast<int>(stop);
  std::vector<int> lost(wanted.size(), 0);
  int home_blocked = 0;
  for (const ChunkResult& chunk : chunks) {
    rate.samples += chunk.samples;
    rate.good += chunk.good;
    home_blocked += chunk.home_blocked;
    for (std::size_t i = 0; i < chunk.lost.size(); ++i) lost[i] += chunk.lost[i];
  }
  const auto worst = std::max_element(lost.begin(), lost.end());
  if (worst != lost.end() && *worst > 0) rate.worst_part = context.plan.parts[wanted[worst - lost.begin()]].body.name;
  if (rate.good >= context.options.required_rate * rate.samples) return rate;
  std::string why = rate.worst_part.empty() ? "" : "; most often '" + rate.worst_part + "' has no free grasp";
  if (home_blocked > 0) why += "; at " + std::to_string(home_blocked) + " the robot collides at home";
  faults.push_back({"not-robust", "stop " + std::to_string(stop),
                    "all parts can be grasped from " + std::to_string(rate.good) + " of " +
                        std::to_string(rate.samples) + " base poses, required is a share of " +
                        text(context.options.required_rate) + why});
  return rate;
}

}  // namespace

void check_robustness(const Context& context, Faults& faults, std::vector<StopRate>& rates,
                      std::size_t& configurations) {
  const std::size_t stops = context.plan.stops.size();
  std::vector<std::vector<Eigen::Vector3d>> poses;
  std::vector<std::vector<int>> wanted;
  for (std::size_t stop = 0; stop < stops; ++stop) {
    poses.push_back(sorted_samples(context, stop));
    wanted.push_back(wanted_parts(context.plan, context.plan.stops[stop]));
  }
  const Pools pools = planned_holds(context);
  std::vector<Judge> judges(resolve_threads(context.options.threads), Judge(context.stage));
  std::vector<std::vector<ChunkResult>> results(stops, std::vector<ChunkResult>(kChunks));
  const auto work = [&](std::size_t item, int worker) {
    const std::size_t stop = item / kChunks, chunk = item % kChunks, count = poses[stop].size();
    GraspSearch search(context, judges[worker], pools, Rng(context.options.seed, stops + item));
    results[stop][chunk] = run_chunk(context, poses[stop], count * chunk / kChunks, count * (chunk + 1) / kChunks,
                                     wanted[stop], judges[worker], std::move(search));
  };
  parallel_for(stops * kChunks, context.options.threads, work, context.monitor, "robustness");
  for (std::size_t stop = 0; stop < stops; ++stop) {
    rates.push_back(summarize(context, stop, wanted[stop], results[stop], faults));
  }
  for (const Judge& judge : judges) configurations += judge.queries();
}

}  // namespace mmgrasp::verify
