#include "mmgrasp/collision/disabled_pairs.hpp"

#include <algorithm>
#include <numeric>

#include "collision/checker/never_touch.hpp"
#include "collision/checker/pair_plan.hpp"
#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {

namespace {

constexpr int kMaxBoxes = 10000;    // of joint values in a proof: more prove few further pairs
constexpr double kMostPoses = 1e9;  // of links in all proofs, a minute of processor time: beyond, each has fewer boxes

struct BodyPair {
  int a, b;               // bodies
  std::vector<int> hits;  // one counter per worker, so that counting needs no lock
  bool never = false;     // proven

  int count() const { return std::accumulate(hits.begin(), hits.end(), 0); }
};

std::pair<int, int> ordered(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// Two links touch by construction when one joint at most lets them move against each other and nothing with a shape
// sits between them.
bool adjacent(const Robot& robot, int link_a, int link_b) {
  const auto climb = [&](int from, int to) {
    int movable = 0;
    for (int link = from; link != to;) {
      const int joint = robot.links()[link].parent_joint;
      if (joint < 0) return false;
      movable += robot.joints()[joint].type != JointType::fixed;
      if (movable > 1) return false;  // soon: robots of many links have very many pairs
      link = robot.joints()[joint].parent_link;
      if (link != to && !robot.links()[link].collisions.empty()) return false;
    }
    return true;
  };
  return climb(link_a, link_b) || climb(link_b, link_a);
}

Eigen::VectorXd random_values(const Robot& robot, Rng& rng) {
  Eigen::VectorXd values = robot.default_values();
  for (const Joint& joint : robot.joints()) {
    if (joint.value_index < 0) continue;
    for (int k = 0; k < joint.value_count(); ++k) {
      const bool bounded = std::isfinite(joint.lower) && std::isfinite(joint.upper) && joint.value_count() == 1;
      values[joint.value_index + k] =
          bounded ? rng.uniform(joint.lower, joint.upper) : rng.uniform(-detail::kPi, detail::kPi);
    }
  }
  return values;
}

// Poses of the shapes for one configuration, then every open pair of bodies.
class Sampler {
 public:
  Sampler(const detail::Snapshot& snapshot) : snapshot_(snapshot), shapes_of_(snapshot.bodies.size()) {
    for (std::size_t s = 0; s < snapshot.shapes.size(); ++s)
      shapes_of_[snapshot.shapes[s].body].push_back(static_cast<int>(s));
  }

  void count(const Eigen::VectorXd& values, int worker, std::vector<BodyPair>& pairs) const {
    const Poses links = snapshot_.robot.link_poses(values);
    std::vector<detail::Rigid> poses;
    std::vector<Eigen::Vector3d> spheres;
    for (const detail::BodyShape& shape : snapshot_.shapes) {
      poses.push_back(detail::Rigid(links[shape.link]) * shape.in_link);
      spheres.push_back(links[shape.link] * shape.sphere_centre);
    }
    for (BodyPair& pair : pairs) pair.hits[worker] += collide(pair, poses, spheres);
  }

 private:
  bool collide(const BodyPair& pair, const std::vector<detail::Rigid>& poses,
               const std::vector<Eigen::Vector3d>& spheres) const {
    for (const int i : shapes_of_[pair.a]) {
      for (const int j : shapes_of_[pair.b]) {
        const detail::Solid &a = *snapshot_.shapes[i].solid, &b = *snapshot_.shapes[j].solid;
        const double reach = a.sphere_radius + b.sphere_radius;
        if ((spheres[i] - spheres[j]).squaredNorm() > reach * reach) continue;
        if (detail::solids_collide(a, poses[i], b, poses[j])) return true;
      }
    }
    return false;
  }

  const detail::Snapshot& snapshot_;
  std::vector<std::vector<int>> shapes_of_;
};

}  // namespace

void DisabledPairsOptions::check() const {
  require_count(samples, "samples");
  require(always_fraction > 0 && always_fraction <= 1, "always_fraction", always_fraction, "must be in (0, 1]");
  resolve_threads(threads);  // says what is wrong
}

Robot compute_disabled_pairs(const Robot& robot, const DisabledPairsOptions& options, const Monitor& monitor) {
  options.check();
  const detail::Snapshot snapshot(robot, World(), CheckerOptions());
  const std::vector<int> assembly = detail::rigid_assemblies(robot);
  const int threads = resolve_threads(options.threads);

  std::map<std::pair<int, int>, DisabledReason> disabled = robot.disabled_pairs();
  std::vector<BodyPair> open;
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
    detail::throw_if_interrupted();
    for (std::size_t j = i + 1; j < snapshot.bodies.size(); ++j) {
      const int a = snapshot.bodies[i].link, b = snapshot.bodies[j].link;
      if (robot.pair_disabled(a, b)) continue;
      if (assembly[a] == assembly[b] || adjacent(robot, a, b)) {
        disabled.emplace(ordered(a, b), DisabledReason::adjacent);
      } else {
        open.push_back({static_cast<int>(i), static_cast<int>(j), std::vector<int>(threads, 0)});
      }
    }
  }
  const Sampler sampler(snapshot);
  const auto work = [&](std::size_t sample, int worker) {
    Rng rng(options.seed, sample);
    sampler.count(random_values(robot, rng), worker, open);
  };
  // Stopped early the counts mean nothing: only what is known for certain is returned then.
  bool complete = parallel_for(options.samples, threads, work, monitor, "self-collision pairs");
  const detail::NeverTouch never_touch(snapshot);
  const double poses = static_cast<double>(open.size()) * static_cast<double>(robot.links().size());
  const int boxes = static_cast<int>(std::min<double>(kMaxBoxes, kMostPoses / std::max(poses, 1.0)));
  const auto prove = [&](std::size_t pair, int) {
    BodyPair& one = open[pair];
    one.never = one.count() == 0 && (options.trust_samples || never_touch.proven(one.a, one.b, boxes));
  };
  complete = complete && parallel_for(open.size(), threads, prove, monitor, "pairs that never touch");
  for (const BodyPair& pair : open) {
    if (!complete) break;
    const auto key = ordered(snapshot.bodies[pair.a].link, snapshot.bodies[pair.b].link);
    if (pair.never) disabled.emplace(key, DisabledReason::never);
    if (pair.count() >= options.always_fraction * options.samples) disabled.emplace(key, DisabledReason::always);
  }
  return robot.with_disabled_pairs(std::move(disabled));
}

}  // namespace mmgrasp
