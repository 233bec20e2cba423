// Three passes: voxel by voxel in closed form over few values of the free joints; then along the border of what is
// reached, from neighbours' solutions and over many values; poses deep inside what nothing reaches get no more.
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "reach/capability/capability_data.hpp"
#include "reach/database/pose_search.hpp"

namespace mmgrasp {
namespace {

using Data = CapabilityMap::Data;

constexpr const char* kStage = "capability map";
constexpr int kDirectionNeighbours = 6;
constexpr int kBorderBlock = 64;  // poses a work item
constexpr int kFewIterations = 25;
constexpr int kFewShare = 4;          // of the sampled values of free joints, every fourth is tried everywhere
constexpr double kFirstShare = 0.75;  // of the time, roughly: for the progress report

/// The three passes over all voxels and poses, and the configurations that they found.
class Builder {
 public:
  Builder(const JointGroup& arm, const World& world, const Monitor& monitor, Data& data, const CapabilityMap* within)
      : arm_(arm),
        monitor_(monitor),
        data_(data),
        within_(within),
        threads_(resolve_threads(data.options.threads)),
        table_(arm, data.options.samples),
        few_(std::max(1, table_.size() / kFewShare)),
        state_(data.classes.size(), State{}),
        found_(data.classes.size() * arm.size()) {
    CheckerOptions checking;
    checking.padding = data.options.padding;
    const CollisionChecker checker(arm, world, checking);
    const detail::HandProbe hand(arm, world);
    for (int i = 0; i < threads_; ++i) searches_.emplace_back(checker, hand, table_, data.options.seed);
    find_neighbours();
  }

  /// False when stopped.
  bool run() {
    if (!table_.known() && !build_seeds()) return false;
    const Monitor first{monitor_.stop,
                        [&](const std::string&, double share) { monitor_.report(kStage, kFirstShare * share); }};
    const std::size_t columns = static_cast<std::size_t>(data_.shape[0]) * data_.shape[1];
    if (!parallel_for(
            columns, threads_, [&](std::size_t column, int worker) { fill_column(column, searches_[worker]); }, first,
            kStage))
      return false;
    for (int sweep = 1; sweep <= data_.options.sweeps; ++sweep) {
      const std::vector<std::size_t> border = border_of(sweep);
      if (border.empty()) break;
      if (!sweep_border(border, sweep)) return false;
      monitor_.report(kStage, kFirstShare + (1 - kFirstShare) * sweep / data_.options.sweeps);
    }
    store();
    monitor_.report(kStage, 1.0);
    return true;
  }

 private:
  struct State {
    std::uint8_t cause = static_cast<std::uint8_t>(Rejection::unreachable);
    std::uint8_t sweep = 0;  ///< The sweep in which it was reached.
    bool settled = false;    ///< No search will help.
    bool searched = false;   ///< All that the border gets.
    bool reached() const { return cause == static_cast<std::uint8_t>(Rejection::none); }
  };

  void find_neighbours() {
    const Eigen::Vector3d approach = data_.options.approach.normalized();
    const std::size_t count = data_.poses();
    directions_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      const auto angle = [&](std::size_t other) {
        return -(data_.tool_poses[k].linear() * approach).dot(data_.tool_poses[other].linear() * approach);
      };
      std::vector<std::size_t> others;
      for (std::size_t other = 0; other < count; ++other)
        if (other != k) others.push_back(other);
      const std::size_t kept = std::min<std::size_t>(others.size(), kDirectionNeighbours);
      std::partial_sort(others.begin(), others.begin() + static_cast<long>(kept), others.end(),
                        [&](std::size_t a, std::size_t b) {
                          const double x = angle(a), y = angle(b);
                          return x != y ? x < y : a < b;
                        });
      others.resize(kept);
      directions_[k] = std::move(others);
    }
  }

  bool build_seeds() {
    ReachOptions options;
    options.samples = 200'000;
    options.max_per_cell = 4;
    options.min_manipulability = 0;
    options.seed = data_.options.seed;
    options.threads = data_.options.threads;
    seeds_ = ReachDatabase::build(arm_, options, Monitor{monitor_.stop, {}});
    return !monitor_.stopped();
  }

  Pose target(std::size_t at) const { return arm_.T_world_root() * data_.pose(at); }

  Eigen::VectorXd configuration(std::size_t at) const {
    return Eigen::Map<const Eigen::VectorXf>(found_.data() + at * arm_.size(), arm_.size()).cast<double>();
  }

  void keep(std::size_t at, const Eigen::VectorXf& q, int sweep) {
    state_[at].cause = static_cast<std::uint8_t>(Rejection::none);
    state_[at].sweep = static_cast<std::uint8_t>(sweep);
    std::copy(q.data(), q.data() + q.size(), found_.begin() + static_cast<long>(at) * q.size());
  }

  void fill_column(std::size_t column, detail::PoseSearch& search) {
    const std::size_t height = data_.shape[2], poses = data_.poses();
    std::vector<int> last(poses, 0);  // the sample that solved the pose below
    for (std::size_t z = 0; z < height && !monitor_.stopped(); ++z) {
      for (std::size_t k = 0; k < poses; ++k) {
        const std::size_t at = (column * height + z) * poses + k;
        if (!search.start(target(at), at)) {
          state_[at].settled = true;
          continue;
        }
        if (first_search(at, z > 0 && state_[at - poses].reached() ? at - poses : at, last[k], search)) {
          if (search.sample() >= 0) last[k] = search.sample();
          keep(at, search.found(), 0);
        } else {
          state_[at].cause = static_cast<std::uint8_t>(search.cause());
          state_[at].settled = search.out_of_reach() || (table_.known() && table_.free_joints() == 0);
        }
      }
    }
  }

  /// `below`: the pose below when it is reached, else `at`.
  bool first_search(std::size_t at, std::size_t below, int sample, detail::PoseSearch& search) {
    if (within_) {
      const auto voxel = static_cast<std::int64_t>(at / data_.poses());
      const int pose = static_cast<int>(at % data_.poses());
      const Eigen::VectorXd q = within_->configuration(voxel, pose);
      if (q.size() == 0) {
        search.settle(within_->classified(voxel, pose));
        return false;
      }
      if (search.try_configuration(q)) return true;
    }
    if (table_.known()) return search.try_samples_near(sample, few_);
    if (below != at && search.try_descent(configuration(below), kFewIterations)) return true;
    if (seeds_) {
      constexpr int kSeeds = 4;
      Eigen::MatrixXd near;
      const int count = seeds_->nearest(data_.pose(at), kSeeds, near);
      for (int i = 0; i < count; ++i)
        if (search.try_descent(near.col(i), kFewIterations)) return true;
    }
    return false;
  }

  /// Calls use(neighbour) for poses one step away: the same tool pose in the six voxels around, similar ones in the
  /// same voxel.
  template <class Use>
  void each_neighbour(std::size_t at, const Use& use) const {
    const std::size_t poses = data_.poses(), voxel = at / poses, k = at % poses;
    const std::size_t nz = data_.shape[2], ny = data_.shape[1], nx = data_.shape[0];
    const std::size_t z = voxel % nz, y = voxel / nz % ny, x = voxel / nz / ny;
    if (z > 0) use(at - poses);
    if (z + 1 < nz) use(at + poses);
    if (y > 0) use(at - poses * nz);
    if (y + 1 < ny) use(at + poses * nz);
    if (x > 0) use(at - poses * nz * ny);
    if (x + 1 < nx) use(at + poses * nz * ny);
    for (const std::size_t other : directions_[k]) use(voxel * poses + other);
  }

  /// Poses with a neighbour that the sweep before reached.
  std::vector<std::size_t> border_of(int sweep) const {
    std::vector<std::size_t> border;
    for (std::size_t at = 0; at < state_.size(); ++at) {
      if (state_[at].reached() || state_[at].settled) continue;
      bool fresh = false;
      each_neighbour(at, [&](std::size_t other) {
        fresh = fresh || (state_[other].reached() && state_[other].sweep == sweep - 1);
      });
      if (fresh) border.push_back(at);
    }
    return border;
  }

  bool search_border(std::size_t at, int sweep, detail::PoseSearch& search) {
    bool found = false;
    each_neighbour(at, [&](std::size_t other) {
      if (found || !state_[other].reached() || state_[other].sweep != sweep - 1) return;
      const Eigen::VectorXd q = configuration(other);
      found = (table_.known() && search.try_locked(q)) || search.try_descent(q, kFewIterations);
    });
    if (found || state_[at].searched) return found;
    if (table_.known() && (search.try_samples(few_, table_.size()) || search.try_nearly_inside(kFewIterations)))
      return true;
    return search.try_random_descents(data_.options.restarts, kFewIterations);
  }

  /// Reads what earlier sweeps found and writes only afterwards: the order of the work does not matter.
  bool sweep_border(const std::vector<std::size_t>& border, int sweep) {
    const std::size_t n = arm_.size();
    std::vector<std::uint8_t> result(border.size());
    std::vector<std::uint8_t> out_of_reach(border.size());
    std::vector<float> q(border.size() * n);
    const std::size_t blocks = (border.size() + kBorderBlock - 1) / kBorderBlock;
    const auto work = [&](std::size_t block, int worker) {
      detail::PoseSearch& search = searches_[worker];
      for (std::size_t i = block * kBorderBlock; i < std::min(border.size(), (block + 1) * kBorderBlock); ++i) {
        search.start(target(border[i]), border[i]);
        if (search_border(border[i], sweep, search)) {
          result[i] = static_cast<std::uint8_t>(Rejection::none);
          std::copy(search.found().data(), search.found().data() + n, q.begin() + static_cast<long>(i * n));
        } else {
          result[i] = static_cast<std::uint8_t>(search.cause());
          out_of_reach[i] = search.out_of_reach();
        }
      }
    };
    if (!parallel_for(blocks, threads_, work, Monitor{monitor_.stop, {}}, kStage)) return false;
    for (std::size_t i = 0; i < border.size(); ++i) {
      State& state = state_[border[i]];
      state.searched = true;
      state.settled = out_of_reach[i];
      if (result[i] == static_cast<std::uint8_t>(Rejection::none))
        keep(border[i], Eigen::Map<const Eigen::VectorXf>(q.data() + i * n, static_cast<long>(n)), sweep);
      else
        state.cause = std::max(state.cause, result[i]);
    }
    return true;
  }

  void store() {
    const std::size_t n = arm_.size();
    data_.configurations.clear();
    for (std::size_t at = 0; at < state_.size(); ++at) {
      data_.classes[at] = state_[at].cause;
      if (state_[at].reached())
        data_.configurations.insert(data_.configurations.end(), found_.begin() + static_cast<long>(at * n),
                                    found_.begin() + static_cast<long>((at + 1) * n));
    }
    data_.complete();
  }

  const JointGroup& arm_;
  const Monitor& monitor_;
  Data& data_;
  const CapabilityMap* within_;
  int threads_;
  detail::BranchTable table_;
  int few_;  ///< Values of the free joints tried everywhere; all are along the border.
  std::vector<State> state_;
  std::vector<float> found_;
  std::vector<detail::PoseSearch> searches_;
  std::vector<std::vector<std::size_t>> directions_;
  std::optional<ReachDatabase> seeds_;
};

/// The map of no voxels when stopped.
CapabilityMap run(std::shared_ptr<Data> data, const JointGroup& arm, const World& world, const Monitor& monitor,
                  const CapabilityMap* within) {
  data->arm_key = detail::capability_arm_key(arm);
  data->joints = arm.size();
  data->lay_out();
  data->classes.assign(data->voxel_count() * data->poses(), 0);
  if (Builder(arm, world, monitor, *data, within).run()) return CapabilityMap(std::move(data));
  auto empty = std::make_shared<Data>();
  empty->options = data->options;
  empty->arm_key = data->arm_key;
  empty->joints = data->joints;
  empty->tool_poses = data->tool_poses;
  empty->complete();
  return CapabilityMap(std::move(empty));
}

}  // namespace

CapabilityMap CapabilityMap::build(const JointGroup& arm, const World& world, const CapabilityOptions& options,
                                   const Monitor& monitor) {
  options.check();
  require(!arm.has_base(), "arm", arm.name(), "must not have base joints: the map is relative to the base");
  auto data = std::make_shared<Data>();
  data->options = options;
  return run(std::move(data), arm, world, monitor, nullptr);
}

CapabilityMap CapabilityMap::restricted(const JointGroup& arm, const World& world, const Monitor& monitor) const {
  require(!arm.has_base() && detail::capability_arm_key(arm) == arm_key(), "arm", arm.name(),
          "must be the arm that the map was made for");
  require(voxel_count() > 0, "map", "empty", "must have voxels");
  auto data = std::make_shared<Data>();
  data->options = options();
  return run(std::move(data), arm, world, monitor, this);
}

}  // namespace mmgrasp
