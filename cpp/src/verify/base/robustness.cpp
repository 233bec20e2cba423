// Checks the stops with the base displaced: parts stay graspable from drawn poses, and as often as the plan says.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "verify/base/grasp_search.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr int kChunks = 20;  // Pieces of a stop's samples that are worked on independently.

constexpr double kSureDeviations =
    4.5;  // Standard deviations by which two shares may differ: of right plans one stop in 150,000 exceeds it.
constexpr double kSearchSlack = 0.02;  // Part of a share: grasps that a search with kArrivalTries does not find.
constexpr int kTries = 1500;
constexpr int kArrivalTries = 300;  // Where many arrivals fail, each that does costs all its tries.

/// What base poses are counted for.
struct Question {
  const char* stage;
  double may_lose;  ///< Samples of a stop; more end the count early.
  int tries;        ///< IK solutions tried before a part counts as lost ...
  bool thoroughly;  ///< ... and many more, since the verdict hangs on each sample.
};

/// What some of a stop's samples gave.
struct Served {
  int samples = 0, good = 0;
  std::vector<int> lost;  ///< At how many samples a wanted part was the one that failed, by part.
  int home_blocked = 0;
};

/// Base poses drawn at a stop by their offsets, along a winding path over the floor, so that neighbours in the list are
/// neighbours on it.
std::vector<Eigen::Vector3d> winding(const Eigen::Vector3d& stop, std::vector<Eigen::Vector3d> offsets) {
  double farthest = 0;
  for (const Eigen::Vector3d& offset : offsets) farthest = std::max(farthest, std::abs(offset.x()));
  const double strip = farthest > 0 ? farthest / 10 : 1.0;
  const auto key = [strip](const Eigen::Vector3d& p) {
    const int row = static_cast<int>(std::floor(p.x() / strip));
    return std::make_pair(row, row % 2 ? -p.y() : p.y());
  };
  std::sort(offsets.begin(), offsets.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  for (Eigen::Vector3d& offset : offsets) offset += stop;
  return offsets;
}

std::vector<Eigen::Vector3d> in_disc(const Context& context, std::size_t stop) {
  Rng rng(context.options.seed, stop);
  std::vector<Eigen::Vector3d> offsets;
  for (int i = 0; i < context.options.samples; ++i) {
    const Eigen::Vector2d offset = rng.in_disc(context.plan.positioning_uncertainty);
    offsets.emplace_back(offset.x(), offset.y(), 0.0);
  }
  return winding(context.plan.stops[stop].pose, std::move(offsets));
}

std::vector<Eigen::Vector3d> arrivals(const Context& context, std::size_t stop) {
  const Eigen::LDLT<Eigen::Matrix3d> factors(context.plan.arrival_covariance);
  const Eigen::Vector3d deviations = factors.vectorD().cwiseMax(0.0).cwiseSqrt();
  Rng rng(context.options.seed + 1, stop);
  std::vector<Eigen::Vector3d> offsets;
  for (int i = 0; i < context.options.samples; ++i) {
    const double x = rng.normal(), y = rng.normal(), theta = rng.normal();
    const Eigen::Vector3d scaled = deviations.cwiseProduct(Eigen::Vector3d(x, y, theta));
    offsets.emplace_back(factors.transpositionsP().transpose() * Eigen::Vector3d(factors.matrixL() * scaled));
  }
  return winding(context.plan.stops[stop].pose, std::move(offsets));
}

/// One piece of a stop. It ends early once it alone has lost more samples than the whole stop may lose.
Served run_chunk(const Context& context, const std::vector<Eigen::Vector3d>& poses, std::size_t begin, std::size_t end,
                 const Question& question, const std::vector<int>& wanted, Judge& judge, GraspSearch search) {
  Served result;
  result.lost.assign(wanted.size(), 0);
  std::vector<std::size_t> order(wanted.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = begin; i < end; ++i) {
    if (result.samples - result.good > question.may_lose || context.monitor.stopped()) break;
    judge.set_base(poses[i]);
    ++result.samples;
    if (judge.touch(context.plan.home, 0)) {
      ++result.home_blocked;
      continue;
    }
    const auto failed = std::find_if(order.begin(), order.end(), [&](std::size_t k) {
      return !(question.thoroughly ? search.find_thoroughly(wanted[k]) : search.find(wanted[k]));
    });
    if (failed == order.end()) {
      ++result.good;
    } else {
      ++result.lost[*failed];
      std::rotate(order.begin(), failed, failed + 1);  // what failed here is likely to fail next door: ask it first
    }
  }
  return result;
}

/// Counts for each stop from how many of its poses the robot can stand at home and grasp what it should there.
std::vector<Served> count_served(const Context& context, const std::vector<std::vector<Eigen::Vector3d>>& poses,
                                 const Question& question, std::size_t& configurations) {
  const std::size_t stops = poses.size();
  std::vector<std::vector<int>> wanted;
  for (const CheckedStop& stop : context.plan.stops) wanted.push_back(wanted_parts(context.plan, stop.trays));
  const Pools pools = planned_holds(context);
  std::vector<Judge> judges(resolve_threads(context.options.threads), Judge(context.stage));
  std::vector<Served> chunks(stops * kChunks);
  const auto work = [&](std::size_t item, int worker) {
    const std::size_t stop = item / kChunks, chunk = item % kChunks, count = poses[stop].size();
    GraspSearch search(context, judges[worker], pools, Rng(context.options.seed, stops + item), question.tries);
    chunks[item] = run_chunk(context, poses[stop], count * chunk / kChunks, count * (chunk + 1) / kChunks, question,
                             wanted[stop], judges[worker], std::move(search));
  };
  parallel_for(stops * kChunks, context.options.threads, work, context.monitor, question.stage);
  for (const Judge& judge : judges) configurations += judge.queries();
  std::vector<Served> served(stops);
  for (std::size_t item = 0; item < chunks.size(); ++item) {
    Served& sum = served[item / kChunks];
    sum.samples += chunks[item].samples;
    sum.good += chunks[item].good;
    sum.home_blocked += chunks[item].home_blocked;
    sum.lost.resize(wanted[item / kChunks].size());
    for (std::size_t i = 0; i < chunks[item].lost.size(); ++i) sum.lost[i] += chunks[item].lost[i];
  }
  return served;
}

StopRate summarize(const Context& context, std::size_t stop, const Served& served, Faults& faults) {
  const std::vector<int> wanted = wanted_parts(context.plan, context.plan.stops[stop].trays);
  StopRate rate;
  rate.stop = static_cast<int>(stop);
  rate.samples = served.samples;
  rate.good = served.good;
  const std::vector<int>& lost = served.lost;
  const auto worst = std::max_element(lost.begin(), lost.end());
  if (worst != lost.end() && *worst > 0) rate.worst_part = context.plan.parts[wanted[worst - lost.begin()]].body.name;
  if (rate.good >= context.options.required_rate * rate.samples) return rate;
  std::string why = rate.worst_part.empty() ? "" : "; most often '" + rate.worst_part + "' has no free grasp";
  if (served.home_blocked > 0) why += "; at " + std::to_string(served.home_blocked) + " the robot collides at home";
  faults.push_back({"not-robust", "stop " + std::to_string(stop),
                    "all parts can be grasped from " + std::to_string(rate.good) + " of " +
                        std::to_string(rate.samples) + " base poses, required is a share of " +
                        text(context.options.required_rate) + why});
  return rate;
}

}  // namespace

void check_robustness(const Context& context, Faults& faults, std::vector<StopRate>& rates,
                      std::size_t& configurations) {
  std::vector<std::vector<Eigen::Vector3d>> poses;
  for (std::size_t stop = 0; stop < context.plan.stops.size(); ++stop) poses.push_back(in_disc(context, stop));
  const Question question{"robustness", (1 - context.options.required_rate) * context.options.samples, kTries, true};
  const std::vector<Served> served = count_served(context, poses, question, configurations);
  for (std::size_t stop = 0; stop < served.size(); ++stop)
    rates.push_back(summarize(context, stop, served[stop], faults));
}

void check_arrivals(const Context& context, Faults& faults, std::size_t& configurations) {
  const std::vector<CheckedStop>& stops = context.plan.stops;
  if (context.plan.arrival_covariance.isZero(0)) return;
  std::vector<std::vector<Eigen::Vector3d>> poses;
  for (std::size_t stop = 0; stop < stops.size(); ++stop) poses.push_back(arrivals(context, stop));
  const Question question{"arrivals", static_cast<double>(context.options.samples), kArrivalTries, false};
  const std::vector<Served> served = count_served(context, poses, question, configurations);
  for (std::size_t i = 0; i < served.size() && !context.monitor.stopped(); ++i) {
    const double mine = served[i].samples, said = stops[i].arrivals;
    const double both = (served[i].good + stops[i].arrivals_served) / (mine + said);
    const double off = std::abs(served[i].good / mine - stops[i].arrivals_served / said);
    if (off <= kSearchSlack + kSureDeviations * std::sqrt(both * (1 - both) * (1 / mine + 1 / said))) continue;
    faults.push_back({"arrival-rate", "stop " + std::to_string(i),
                      "all parts can be grasped from " + std::to_string(served[i].good) + " of " +
                          std::to_string(served[i].samples) + " arrivals, the plan says " +
                          std::to_string(stops[i].arrivals_served) + " of " + std::to_string(stops[i].arrivals)});
  }
}

}  // namespace mmgrasp::verify::detail
