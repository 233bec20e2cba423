#include "mmgrasp/reach/base_placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "reach/database/reach_data.hpp"
#include "reach/database/seeded_ik.hpp"

namespace mmgrasp {
namespace {

/// How many configurations the database holds for a tool at the height and in the rotation of a pose, turned by a
/// heading, over the position cells of that height: what base positions are looked up in.
class Layer {
 public:
  explicit Layer(const ReachDatabase::Data& data) : data_(data) {
    const auto index_of = [&](double length) {
      return static_cast<std::int64_t>(std::floor(length / data.options.position_cell));
    };
    if (data.size() == 0) return;
    for (int axis = 0; axis < 2; ++axis) {
      low_[axis] = index_of(data.bounds.min()[axis]);
      count_[axis] = index_of(data.bounds.max()[axis]) - low_[axis] + 1;
    }
    counts_.resize(count_[0] * count_[1]);
  }

  void set(const Pose& T_world_tip, double heading) {
    std::fill(counts_.begin(), counts_.end(), 0);
    if (counts_.empty()) return;
    Pose T = pose_from_planar({0, 0, -heading}) * T_world_tip;
    const std::uint32_t id = data_.rotations.id(T.linear());
    const double at = std::floor(T.translation().z() / data_.options.position_cell);
    if (!(std::abs(at) < static_cast<double>(detail::kPositionLimit))) return;
    for (std::int64_t x = 0; x < count_[0]; ++x) {
      for (std::int64_t y = 0; y < count_[1]; ++y) {
        const detail::CellIndex index(low_[0] + x, low_[1] + y, static_cast<std::int64_t>(at));
        const std::int64_t position = detail::in_range(index) ? data_.find_position(detail::position_key(index)) : -1;
        if (position < 0) continue;
        const std::size_t p = position;
        const auto* end = data_.rotation_ids.begin() + data_.position_first[p + 1];
        const auto* found = std::lower_bound(data_.rotation_ids.begin() + data_.position_first[p], end, id);
        if (found == end || *found != id) continue;
        const std::size_t cell = found - data_.rotation_ids.begin();
        counts_[x * count_[1] + y] = data_.cell_first[cell + 1] - data_.cell_first[cell];
      }
    }
  }

  /// Stored configurations whose tool is at (x, y), seen from the base.
  std::uint32_t at(double x, double y) const {
    const auto i = static_cast<std::int64_t>(std::floor(x / data_.options.position_cell)) - low_[0];
    const auto j = static_cast<std::int64_t>(std::floor(y / data_.options.position_cell)) - low_[1];
    if (i < 0 || j < 0 || i >= count_[0] || j >= count_[1]) return 0;
    return counts_[i * count_[1] + j];
  }

 private:
  const ReachDatabase::Data& data_;
  std::array<std::int64_t, 2> low_{}, count_{};
  std::vector<std::uint32_t> counts_;
};

/// Base poses of a grid that covers everything from which a target may be reached.
struct BaseCells {
  BaseCells(const ReachDatabase& database, const Poses& targets, const BasePlacementOptions& options)
      : step(options.step), headings(options.headings) {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(detail::kInfinity), high = -low;
    for (const Pose& T : targets) {
      low = low.cwiseMin(T.translation().head<2>());
      high = high.cwiseMax(T.translation().head<2>());
    }
    for (int axis = 0; axis < 2; ++axis) {
      first[axis] = static_cast<std::int64_t>(std::floor((low[axis] - database.reach()) / step));
      count[axis] = static_cast<std::int64_t>(std::ceil((high[axis] + database.reach()) / step)) - first[axis] + 1;
    }
    constexpr double kMaxBasePoses = 2e8;
    const double cells = static_cast<double>(count[0]) * static_cast<double>(count[1]) * headings;
    require(cells < kMaxBasePoses, "step", step, "too small: more than 2e8 base poses over all targets");
  }

  std::size_t size() const { return count[0] * count[1] * headings; }
  Eigen::Vector3d pose(std::size_t cell) const {
    const auto i = static_cast<std::int64_t>(cell);
    const std::int64_t place = i % (count[0] * count[1]);
    return {static_cast<double>(first[0] + place / count[1]) * step,
            static_cast<double>(first[1] + place % count[1]) * step, heading(i / (count[0] * count[1]))};
  }
  double heading(std::int64_t h) const {
    const double angle = detail::kTwoPi * static_cast<double>(h) / headings;
    return angle > detail::kPi ? angle - detail::kTwoPi : angle;
  }

  /// visit(cell, configurations in the voxel) for every base pose whose voxel is not empty.
  template <class Visit>
  void each_reaching(Layer& layer, const Pose& target, double reach, const Visit& visit) const {
    const double tx = target.translation().x(), ty = target.translation().y();
    const auto range = [&](int axis, double centre) {
      const auto low = static_cast<std::int64_t>(std::floor((centre - reach) / step)) - first[axis];
      const auto high = static_cast<std::int64_t>(std::ceil((centre + reach) / step)) - first[axis];
      return std::pair(std::max<std::int64_t>(low, 0), std::min(high, count[axis] - 1));
    };
    const auto [x_low, x_high] = range(0, tx);
    const auto [y_low, y_high] = range(1, ty);
    for (int h = 0; h < headings; ++h) {
      layer.set(target, heading(h));
      const double c = std::cos(heading(h)), s = std::sin(heading(h));
      for (std::int64_t i = x_low; i <= x_high; ++i) {
        const double dx = tx - static_cast<double>(first[0] + i) * step;
        for (std::int64_t j = y_low; j <= y_high; ++j) {
          const double dy = ty - static_cast<double>(first[1] + j) * step;
          const std::uint32_t found = layer.at(c * dx + s * dy, c * dy - s * dx);
          if (found > 0) visit((h * count[0] + i) * count[1] + j, found);
        }
      }
    }
  }

  double step;
  int headings;
  std::array<std::int64_t, 2> first{}, count{};
};

/// Looks at base poses exactly; scratch of one thread.
class Examiner {
 public:
  Examiner(const ReachDatabase& database, const JointGroup& arm, const BasePlacementOptions& options,
           const CollisionChecker* checker)
      : ik_(database, arm, options.ik), seeds_(options.seeds) {
    if (checker != nullptr) checker_.push_back(checker->clone());
  }

  bool reaches(const Eigen::Vector3d& base_pose, const Pose& T_world_tip, Eigen::VectorXd& q) {
    stand(base_pose);
    const Pose T_base_tip = pose_from_planar(base_pose).inverse() * T_world_tip;
    const int count = ik_.seed(T_base_tip, seeds_);
    for (int i = 0; i < count; ++i) {
      if (!ik_.refine(T_base_tip, i)) continue;
      if (!checker_.empty() && !checker_[0].is_free(ik_.q())) continue;
      q = ik_.q();
      return true;
    }
    return false;
  }

  /// Gives up (reached = -1) when more than `most_missed` targets are missed.
  BasePlacement place(const Eigen::Vector3d& base_pose, const Poses& targets, const std::vector<std::size_t>& order,
                      int most_missed, std::vector<std::size_t>& missed) {
    BasePlacement out;
    out.base_pose = base_pose;
    out.configurations.resize(targets.size());
    for (const std::size_t i : order) {
      if (reaches(base_pose, targets[i], out.configurations[i])) {
        ++out.reached;
        continue;
      }
      missed.push_back(i);
      if (static_cast<int>(missed.size()) > most_missed) {
        out.reached = -1;
        return out;
      }
    }
    return out;
  }

 private:
  void stand(const Eigen::Vector3d& base_pose) {
    if (checker_.empty() || base_pose == stands_) return;
    checker_[0].set_root(pose_from_planar(base_pose));
    stands_ = base_pose;
  }

  detail::SeededIk ik_;
  int seeds_;
  std::vector<CollisionChecker> checker_;  // none or one
  Eigen::Vector3d stands_ = Eigen::Vector3d::Constant(std::nan(""));
};

/// Lets the database vote for base poses, checks the best exactly and improves the best of these by smaller steps.
class PlacementSearch {
 public:
  PlacementSearch(const ReachDatabase& database, const JointGroup& arm, const Poses& targets,
                  const BasePlacementOptions& options, const CollisionChecker* checker, const Monitor& monitor)
      : database_(database), targets_(targets), options_(options), monitor_(monitor) {
    options.check();
    detail::check_checker(checker, arm);
    for (const Pose& T : targets) require(T.matrix().allFinite(), "T_world_tip", "not finite", "must be a pose");
    misses_.assign(targets.size(), 0);
    order_.resize(targets.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    for (int i = 0; i < resolve_threads(options.threads); ++i) examiners_.emplace_back(database, arm, options, checker);
  }

  /// The best voted base poses of the grid, not two neighbours.
  std::vector<Eigen::Vector3d> voted() const {
    const BaseCells cells(database_, targets_, options_);
    std::vector<std::uint32_t> votes(cells.size(), 0), spare(cells.size(), 0);
    Layer layer(database_.data());
    for (const Pose& target : targets_) {
      if (monitor_.stopped()) return {};
      cells.each_reaching(layer, target, database_.reach(), [&](std::size_t cell, std::uint32_t found) {
        ++votes[cell];
        spare[cell] += std::min(found, 16u);  // breaks ties: many configurations, many ways around obstacles
      });
    }
    std::vector<std::size_t> order;
    for (std::size_t cell = 0; cell < votes.size(); ++cell)
      if (votes[cell] > 0) order.push_back(cell);
    // Suppression takes some: more are ranked than are taken.
    const std::size_t ranked = std::min(order.size(), static_cast<std::size_t>(options_.candidates) * 200);
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(ranked), order.end(),
                      [&](std::size_t a, std::size_t b) {
                        return std::tuple(votes[b], spare[b], a) < std::tuple(votes[a], spare[a], b);
                      });
    std::vector<Eigen::Vector3d> out;
    const double apart = 2.5 * options_.step, turn = 1.5 * 2 * detail::kPi / options_.headings;
    for (std::size_t i = 0; i < ranked && static_cast<int>(out.size()) < options_.candidates; ++i) {
      const Eigen::Vector3d pose = cells.pose(order[i]);
      const bool close = std::any_of(out.begin(), out.end(), [&](const Eigen::Vector3d& other) {
        return (pose - other).head<2>().norm() < apart && std::abs(detail::shortest_turn(pose[2] - other[2])) < turn;
      });
      if (!close) out.push_back(pose);
    }
    return out;
  }

  /// Keeps the best, of equals the first.
  bool look_at(const std::vector<Eigen::Vector3d>& bases) {
    const int before = best_.reached, most_missed = static_cast<int>(targets_.size()) - before - 1;
    if (most_missed < 0) return false;
    std::vector<BasePlacement> placed(bases.size());
    std::vector<std::vector<std::size_t>> missed(bases.size());
    const auto work = [&](std::size_t i, int worker) {
      placed[i] = examiners_[worker].place(bases[i], targets_, order_, most_missed, missed[i]);
    };
    if (!parallel_for(bases.size(), options_.threads, work, Monitor{monitor_.stop, {}})) return false;
    // Those missed most come first: a base pose that cannot be better shows it sooner.
    for (const auto& some : missed)
      for (const std::size_t target : some) ++misses_[target];
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return misses_[a] > misses_[b]; });
    for (BasePlacement& placement : placed)
      if (placement.reached > best_.reached) best_ = std::move(placement);
    return best_.reached > before;
  }

  BasePlacement run() {
    const std::vector<Eigen::Vector3d> bases = voted();
    // Bases are examined in groups, so that what the first ones reach ends the look at the others early.
    constexpr std::size_t kPiece = 4;
    for (std::size_t i = 0; i < bases.size() && !monitor_.stopped(); i += kPiece) {
      look_at({bases.begin() + static_cast<std::ptrdiff_t>(i),
               bases.begin() + static_cast<std::ptrdiff_t>(std::min(i + kPiece, bases.size()))});
      monitor_.report("base placement", static_cast<double>(i) / static_cast<double>(bases.size()));
    }
    double shift = options_.step, turn = detail::kPi / options_.headings;
    for (int round = 0; round < options_.refinements && best_.reached > 0 && !monitor_.stopped(); ++round) {
      if (look_at(around(best_.base_pose, shift, turn))) continue;
      shift /= 2;
      turn /= 2;
    }
    monitor_.report("base placement", 1.0);
    return std::move(best_);
  }

  static std::vector<Eigen::Vector3d> around(const Eigen::Vector3d& pose, double shift, double turn) {
    std::vector<Eigen::Vector3d> out;
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3d offset((n / 9 - 1) * shift, (n / 3 % 3 - 1) * shift, (n % 3 - 1) * turn);
      if (n != 13) out.push_back(pose + offset);
    }
    return out;
  }

  std::vector<BaseReach> all_for(const Pose& target, int count) {
    const BaseCells cells(database_, targets_, options_);
    Layer layer(database_.data());
    std::vector<std::pair<std::uint32_t, std::size_t>> reaching;
    cells.each_reaching(layer, target, database_.reach(),
                        [&](std::size_t cell, std::uint32_t found) { reaching.emplace_back(found, cell); });
    std::sort(reaching.begin(), reaching.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::vector<BaseReach> out;
    const std::size_t batch = 64 * examiners_.size();
    for (std::size_t first = 0; first < reaching.size() && static_cast<int>(out.size()) < count; first += batch) {
      std::vector<BaseReach> some(std::min(batch, reaching.size() - first));
      const auto work = [&](std::size_t i, int worker) {
        some[i].base_pose = cells.pose(reaching[first + i].second);
        examiners_[worker].reaches(some[i].base_pose, target, some[i].q);
      };
      if (!parallel_for(some.size(), options_.threads, work, Monitor{monitor_.stop, {}})) return {};
      for (BaseReach& reach : some)
        if (reach.q.size() > 0 && static_cast<int>(out.size()) < count) out.push_back(std::move(reach));
    }
    return out;
  }

 private:
  const ReachDatabase& database_;
  const Poses& targets_;
  const BasePlacementOptions& options_;
  const Monitor& monitor_;
  std::vector<Examiner> examiners_;
  std::vector<int> misses_;         // of each target so far
  std::vector<std::size_t> order_;  // in which targets are checked
  BasePlacement best_;
};

}  // namespace

void BasePlacementOptions::check() const {
  require_length(step, "step");
  require(headings > 0 && headings <= 3600, "headings", headings, "must lie in [1, 3600]");
  require_within(candidates, 1, 1e6, "candidates", "base poses");
  require_within(seeds, 1, 1e6, "seeds", "stored configurations");
  require_count(refinements, "refinements", 0, 1000);
  resolve_threads(threads);  // says what is wrong
  ik.check();
}

std::vector<BaseReach> base_poses_for(const ReachDatabase& database, const JointGroup& arm, const Pose& T_world_tip,
                                      int count, const BasePlacementOptions& options, const CollisionChecker* checker,
                                      const Monitor& monitor) {
  require_count(count, "count", 1, 1'000'000);
  const Poses targets{T_world_tip};
  return PlacementSearch(database, arm, targets, options, checker, monitor).all_for(T_world_tip, count);
}

BasePlacement find_base_placement(const ReachDatabase& database, const JointGroup& arm, const Poses& T_world_tips,
                                  const BasePlacementOptions& options, const CollisionChecker* checker,
                                  const Monitor& monitor) {
  require(!T_world_tips.empty(), "T_world_tips", "empty", "must hold at least one pose");
  PlacementSearch search(database, arm, T_world_tips, options, checker, monitor);
  BasePlacement out = search.run();
  out.configurations.resize(T_world_tips.size());
  return out;
}

}  // namespace mmgrasp
