#include "mmgrasp/grasp/synthesize_grasps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grasp/synthesis/evaluate_grasp.hpp"
#include "grasp/synthesis/map_surface.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using detail::EvaluatedGrasp;
using detail::Verdict;
using Eigen::Vector3d;

constexpr int kDraws = 10;          // surface points tried for one sample
constexpr double kDepths = 0.25;    // of a pad's depth: how far a sample's contacts lie from its middle
constexpr double kSameAxis = 0.35;  // grasps that close along axes nearer to each other are of one kind [rad]
constexpr std::uint64_t kFineStream = 1u << 30;

/// What became of the surface points drawn for one sample.
struct Sample {
  EvaluatedGrasp grasp;
  bool evaluated = false;
  bool confirmed = false;  ///< `grasp.verdict` is final.
  SynthesisCounts draws;
  std::vector<double> too_wide;  ///< Distances of opposite walls that are farther apart than the hand opens [m].
};

/// Draws grasps over the object, evaluates them, refines the best, and checks once more what is returned.
class Search {
 public:
  Search(const ProbabilisticSdf& map, const HandModel& hand, const SynthesisOptions& options, const Monitor& monitor,
         const ArmReach& arm)
      : map_(map),
        hand_(hand),
        options_(options),
        monitor_(monitor),
        arm_(arm),
        surface_(map, options),
        evaluator_(map, hand, surface_, options) {}

  GraspSynthesis run() {
    GraspSynthesis out;
    out.object = surface_.extent;
    const std::size_t all = options_.samples, first = all - all / 3;
    bool finished = spread(first);
    std::vector<std::size_t> seeds = best_distinct();
    if (finished && seeds.empty()) {
      finished = spread(all);
    } else if (finished) {
      finished = refine(seeds, all - first);
    }
    if (finished) gather(out);
    count(out);
    out.outcome = !finished ? Outcome::stopped : out.grasps.empty() ? Outcome::not_found : Outcome::solved;
    return out;
  }

 private:
  /// Samples over the whole object until there are `until`.
  bool spread(std::size_t until) {
    const std::size_t from = samples_.size();
    samples_.resize(until);
    return parallel_for(
        until - from, options_.threads, [&](std::size_t i, int) { samples_[from + i] = draw(from + i); }, monitor_,
        "sampling grasps");
  }

  Sample draw(std::size_t index) const {
    Sample sample;
    Rng rng(options_.seed, index);
    for (int k = 0; k < kDraws && !sample.evaluated; ++k) {
      ++sample.draws.drawn;
      const std::size_t i = rng.index(surface_.object.size());
      Vector3d axis = -surface_.mean_normal(i);
      // Any line within the friction cone may join the contacts.
      const Eigen::Vector2d tilt = rng.in_disc(options_.success.friction / 2);
      const Vector3d u = axis.unitOrthogonal();
      axis = (axis + tilt.x() * u + tilt.y() * axis.cross(u)).normalized();
      const double turn = rng.uniform(-1, 1), depth = rng.uniform(-kDepths, kDepths);
      double width = 0;
      Vector3d approach;
      if (!find_width(surface_.object[i], axis, width, sample)) continue;
      if (!choose_approach(axis, turn, approach)) {
        ++sample.draws.tilted;
        continue;
      }
      const Vector3d middle = surface_.object[i] + width / 2 * axis + depth * hand_.hand().finger_depth * approach;
      sample.grasp = evaluator_.place(middle, axis, approach, width);
      evaluator_.evaluate(sample.grasp);
      sample.evaluated = true;
    }
    return sample;
  }

  /// From a surface point through the object: a ray from beyond meets the opposite wall from its front.
  bool find_width(const Vector3d& point, const Vector3d& axis, double& width, Sample& sample) const {
    SynthesisCounts& counts = sample.draws;
    const double most = evaluator_.largest_opening(), beyond = surface_.diagonal + most;
    Eigen::Matrix3Xd origins(3, 2), directions(3, 2);
    origins << point + most * axis, point + beyond * axis;
    directions << -axis, -axis;
    const SdfHits hits = map_.cast_rays(origins, directions, 1);
    // The surface point itself is no opposite wall.
    const double thinnest = std::max(evaluator_.smallest_opening(), 2 * map_.options().voxel);
    for (int k = 0; k < 2; ++k) {
      if (!hits.hit[k]) continue;
      width = (k == 0 ? most : beyond) - hits.distance[k];
      if (width > most) {
        ++counts.too_wide;
        sample.too_wide.push_back(width);
        return false;
      }
      if (width >= thinnest) return true;
      if (width > 0) {
        ++counts.too_thin;
        return false;
      }
    }
    ++counts.no_opposite;
    return false;
  }

  /// Across the axis, at most max_tilt from straight down: `turn` in [-1, 1] chooses among those. False: there is none.
  bool choose_approach(const Vector3d& axis, double turn, Vector3d& approach) const {
    const Vector3d down = -Vector3d::UnitZ();
    Vector3d steepest = down - down.dot(axis) * axis;
    const double cosine = steepest.norm();  // of the steepest approach's angle to straight down
    double most = detail::kPi;
    if (options_.max_tilt < detail::kPi) {
      const double ratio = std::cos(options_.max_tilt) / std::max(cosine, 1e-9);
      if (ratio > 1) return false;
      if (ratio > -1) most = std::acos(ratio);
    }
    steepest = cosine > 1e-6 ? Vector3d(steepest / cosine) : axis.unitOrthogonal();
    approach = Eigen::AngleAxisd(turn * most, axis) * steepest;
    return true;
  }

  std::vector<std::size_t> ranked() const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      if (samples_[i].evaluated && samples_[i].grasp.verdict == Verdict::good) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return samples_[a].grasp.success.probability > samples_[b].grasp.success.probability;
    });
    return order;
  }

  /// Two parallel fingers may be exchanged; of other hands half a turn is another grasp.
  bool near(const EvaluatedGrasp& a, const EvaluatedGrasp& b) const {
    const double along = evaluator_.closing_axis(a).dot(evaluator_.closing_axis(b));
    return (a.T_world_hand.translation() - b.T_world_hand.translation()).norm() < options_.min_distance &&
           (hand_.parallel() ? std::abs(along) : along) > std::cos(kSameAxis) &&
           evaluator_.approach(a).dot(evaluator_.approach(b)) > std::cos(kSameAxis);
  }

  bool near_any(const EvaluatedGrasp& grasp, const std::vector<std::size_t>& others) const {
    return std::any_of(others.begin(), others.end(), [&](std::size_t k) { return near(grasp, samples_[k].grasp); });
  }

  /// True when the grasp holds at its final pose, its way in is free and the arm gets there; its verdict is final then.
  bool confirm(Sample& sample) {
    EvaluatedGrasp& grasp = sample.grasp;
    if (!sample.confirmed) evaluator_.confirm(grasp);
    if (!sample.confirmed && grasp.verdict == Verdict::good && arm_) {
      Rejection cause = arm_(grasp.T_world_hand, grasp.q);
      if (cause != Rejection::none && hand_.parallel()) {
        // The same contacts with the fingers exchanged.
        EvaluatedGrasp turned = grasp;
        turned.T_world_hand.linear() =
            grasp.T_world_hand.linear() * Eigen::AngleAxisd(detail::kPi, hand_.hand().approach).toRotationMatrix();
        std::swap(turned.patches[0], turned.patches[1]);
        if (arm_(turned.T_world_hand, turned.q) == Rejection::none) {
          grasp = std::move(turned);
          cause = Rejection::none;
        }
      }
      if (cause != Rejection::none) {
        grasp.verdict = Verdict::arm;
        rejections_.add(cause);
      }
    }
    sample.confirmed = true;
    return grasp.verdict == Verdict::good;
  }

  /// The best that are not beside each other.
  std::vector<std::size_t> best_distinct() {
    std::vector<std::size_t> seeds;
    for (const std::size_t i : ranked()) {
      if (static_cast<int>(seeds.size()) == options_.refined) break;
      if (!near_any(samples_[i].grasp, seeds) && confirm(samples_[i])) seeds.push_back(i);
    }
    return seeds;
  }

  /// Two rounds around the seeds, the second half as far around the best so far.
  bool refine(std::vector<std::size_t> seeds, std::size_t more) {
    double radius = options_.shift;
    for (int round = 0; round < 2; ++round, radius /= 2) {
      const std::size_t from = samples_.size(), count = round == 0 ? more - more / 2 : more / 2;
      samples_.resize(from + count);
      const bool finished = parallel_for(
          count, options_.threads,
          [&](std::size_t j, int) {
            Rng rng(options_.seed, kFineStream + from + j);
            const EvaluatedGrasp& seed = samples_[seeds[j % seeds.size()]].grasp;
            Sample& sample = samples_[from + j];
            sample.grasp = evaluator_.shifted(seed, radius, j / seeds.size() % 2 == 0, rng);
            evaluator_.evaluate(sample.grasp);
            sample.evaluated = true;
          },
          monitor_, "refining grasps");
      if (!finished) return false;
      for (std::size_t j = 0; j < count; ++j) {
        const Sample& sample = samples_[from + j];
        std::size_t& seed = seeds[j % seeds.size()];
        if (sample.grasp.verdict == Verdict::good &&
            sample.grasp.success.probability > samples_[seed].grasp.success.probability)
          seed = from + j;
      }
    }
    return true;
  }

  void gather(GraspSynthesis& out) {
    std::vector<std::size_t> kept;
    for (const std::size_t i : ranked()) {
      const bool full = static_cast<int>(kept.size()) == options_.max_grasps;
      if (full || near_any(samples_[i].grasp, kept)) {
        ++out.counts.near_better;
      } else if (confirm(samples_[i])) {
        kept.push_back(i);
      }
    }
    // Rays cast again may rate a little differently.
    std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
      return samples_[a].grasp.success.probability > samples_[b].grasp.success.probability;
    });
    for (const std::size_t i : kept) describe(samples_[i].grasp, out);
  }

  void describe(const EvaluatedGrasp& from, GraspSynthesis& out) const {
    Grasp grasp;
    GraspRating rating;
    grasp.T_object_hand = from.T_world_hand;
    grasp.quality = from.success.probability;
    rating.pretouch_opening = evaluator_.opening_at(from.shares);
    rating.pretouch_posture = hand_.posture(from.shares);
    if (hand_.parallel()) {
      grasp.opening = rating.pretouch_opening - from.patches[0].nearest - from.patches[1].nearest;
    } else {
      const std::vector<double> holding = evaluator_.holding_shares(from);
      grasp.opening = std::max(0.0, evaluator_.opening_at(holding));
      grasp.posture = hand_.posture(holding);
    }
    rating.success = from.success;
    rating.patches = from.patches;
    rating.q = from.q;
    out.grasps.push_back(std::move(grasp));
    out.ratings.push_back(std::move(rating));
  }

  void count(GraspSynthesis& out) const {
    SynthesisCounts& counts = out.counts;
    std::vector<double> too_wide;
    for (const Sample& sample : samples_) {
      too_wide.insert(too_wide.end(), sample.too_wide.begin(), sample.too_wide.end());
      counts.drawn += sample.draws.drawn;
      counts.no_opposite += sample.draws.no_opposite;
      counts.too_wide += sample.draws.too_wide;
      counts.too_thin += sample.draws.too_thin;
      counts.tilted += sample.draws.tilted;
      if (!sample.evaluated) continue;
      ++counts.evaluated;
      detail::add_verdict(sample.grasp.verdict, counts);
    }
    out.arm = rejections_;
    out.opens = evaluator_.largest_opening();
    if (!too_wide.empty()) {
      const auto middle = too_wide.begin() + static_cast<std::ptrdiff_t>(too_wide.size() / 2);
      std::nth_element(too_wide.begin(), middle, too_wide.end());
      out.median_too_wide = *middle;
    }
  }

  const ProbabilisticSdf& map_;
  const HandModel& hand_;
  const SynthesisOptions& options_;
  const Monitor& monitor_;
  const ArmReach& arm_;
  detail::MapSurface surface_;
  detail::GraspEvaluator evaluator_;
  std::vector<Sample> samples_;
  Rejections rejections_;
};

}  // namespace

GraspSynthesis synthesize_grasps(const ProbabilisticSdf& map, const HandModel& hand, const SynthesisOptions& options,
                                 const Monitor& monitor, const ArmReach& arm) {
  options.check();
  return Search(map, hand, options, monitor, arm).run();
}

GraspSynthesis synthesize_grasps(const ProbabilisticSdf& map, const Hand& hand, const SynthesisOptions& options,
                                 const Monitor& monitor, const ArmReach& arm) {
  return synthesize_grasps(map, *make_hand_model(hand), options, monitor, arm);
}

}  // namespace mmgrasp
