#include "task/base_route/base_search.hpp"

#include <array>
#include <cmath>
#include <queue>
#include <unordered_map>

#include "mmgrasp/core/pose.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kHeadings = 16;
constexpr int kPortals = 15;  // Poses before and behind each end on its own heading line.
constexpr std::size_t kMaxExpansions = 400000;
constexpr std::size_t kProbe = 20000;  // Expansions after which the other end is searched from, with as many.

/// Drives that end on lattice points again, one a heading, counterclockwise.
constexpr std::array<std::array<int, 2>, kHeadings> kDrives = {{{1, 0},
                                                                {2, 1},
                                                                {1, 1},
                                                                {1, 2},
                                                                {0, 1},
                                                                {-1, 2},
                                                                {-1, 1},
                                                                {-2, 1},
                                                                {-1, 0},
                                                                {-2, -1},
                                                                {-1, -1},
                                                                {-1, -2},
                                                                {0, -1},
                                                                {1, -2},
                                                                {1, -1},
                                                                {2, -1}}};

/// A state of the search: a lattice pose, or a portal on the heading line of the start or the goal.
struct Key {
  enum Kind { lattice, start, goal } kind;
  int ix, iy, ih;  // portals: ix counts along the line
  std::uint64_t packed() const {
    return static_cast<std::uint64_t>(kind) << 60 | static_cast<std::uint64_t>(ix + (1 << 20)) << 32 |
           static_cast<std::uint64_t>(iy + (1 << 20)) << 8 | static_cast<std::uint64_t>(ih);
  }
};

struct Node {
  Eigen::Vector3d pose;
  std::uint64_t parent = 0;
  std::vector<Eigen::Vector3d> way;  // poses after the parent's, this one last
  double cost = 0;
};

struct Entry {
  double estimate;
  std::size_t order;
  double cost;
  Key key;
  std::uint64_t parent;
  std::vector<Eigen::Vector3d> way;
  bool checked;
  bool operator<(const Entry& other) const {
    return estimate != other.estimate ? estimate > other.estimate : order > other.order;
  }
};

/// A* over a lattice of base poses around the start, joined to either end along its heading. Edges are checked only
/// when they would be used.
class BaseSearch {
 public:
  BaseSearch(BaseClearance& clearance, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
             const BaseSearchSettings& settings, std::size_t budget, const Monitor& monitor)
      : clearance_(clearance), from_(from), to_(to), settings_(settings), budget_(budget), monitor_(monitor) {}

  FoundBasePath run() {
    if (!clearance_.free(from_) || !clearance_.free(to_)) return {};
    start_span_ = free_span(from_);
    goal_span_ = free_span(to_);
    const Key start{Key::start, 0, 0, 0};
    open_.push({0, order_++, 0, start, start.packed(), {from_}, true});
    while (!open_.empty()) {
      if (monitor_.stopped()) return {Outcome::stopped, {}};
      if (expansions_ >= budget_) return {Outcome::timeout, {}};
      const Entry entry = open_.top();
      open_.pop();
      const std::uint64_t id = entry.key.packed();
      if (closed_.count(id)) continue;
      // Edges are checked only when they would be used.
      if (!entry.checked && !way_free(closed_.at(entry.parent).pose, entry.way)) continue;
      closed_[id] = Node{entry.way.back(), entry.parent, entry.way, entry.cost};
      if (entry.key.kind == Key::goal && entry.key.ix == 0) return {Outcome::solved, trace(id, start.packed())};
      ++expansions_;
      if (expansions_ % kProbe == 0) {
        if (expansions_ == kProbe && budget_ > kProbe && walled_in(to_)) return {};
        monitor_.report("route, long search", static_cast<double>(expansions_) / static_cast<double>(budget_));
      }
      expand(entry.key, closed_[id]);
    }
    return {};
  }

 private:
  struct Span {
    int back = 0, ahead = 0;
  };

  /// Whether a short search from an end tries every way without getting out: every primitive can be driven back.
  bool walled_in(const Eigen::Vector3d& end) {
    const Eigen::Vector3d& other = end == to_ ? from_ : to_;
    return BaseSearch(clearance_, end, other, settings_, kProbe, monitor_).run().outcome == Outcome::not_found;
  }

  Eigen::Vector3d portal(const Eigen::Vector3d& end, int k) const {
    const double s = k * settings_.resolution;
    return {end.x() + s * std::cos(end.z()), end.y() + s * std::sin(end.z()), end.z()};
  }

  Span free_span(const Eigen::Vector3d& end) {
    Span span;
    if (settings_.base != BaseKind::diff_drive) return span;
    while (span.ahead < kPortals && clearance_.segment_free(portal(end, span.ahead), portal(end, span.ahead + 1)))
      ++span.ahead;
    while (-span.back < kPortals && clearance_.segment_free(portal(end, span.back), portal(end, span.back - 1)))
      --span.back;
    return span;
  }

  Eigen::Vector3d lattice_pose(int ix, int iy, int ih) const {
    const auto& d = kDrives[ih];
    return {from_.x() + ix * settings_.resolution, from_.y() + iy * settings_.resolution,
            std::atan2(static_cast<double>(d[1]), static_cast<double>(d[0]))};
  }

  bool way_free(const Eigen::Vector3d& from, const std::vector<Eigen::Vector3d>& way) {
    Eigen::Vector3d last = from;
    for (const Eigen::Vector3d& pose : way) {
      if (!clearance_.segment_free(last, pose)) return false;
      last = pose;
    }
    return true;
  }

  void push(const Key& key, const Node& parent, std::uint64_t parent_id, std::vector<Eigen::Vector3d> way,
            bool checked) {
    if (closed_.count(key.packed())) return;
    const double cost = parent.cost + way_cost(parent.pose, way, settings_.turn_weight);
    const Eigen::Vector3d& end = way.back();
    // Never more than the true cost: the straight distance, and the turn still missing.
    double rest = (end - to_).head<2>().norm();
    if (rest < 1e-9) rest = settings_.turn_weight * std::abs(wrap_angle(end.z() - to_.z()));
    open_.push({cost + rest, order_++, cost, key, parent_id, std::move(way), checked});
  }

  /// The cheapest direct way that is free.
  void connect(const Key& key, const Eigen::Vector3d& target, const Node& parent, std::uint64_t parent_id) {
    if (closed_.count(key.packed())) return;
    for (auto& way : direct_ways(settings_.base, parent.pose, target, settings_.turn_weight)) {
      if (!way_free(parent.pose, way)) continue;
      push(key, parent, parent_id, std::move(way), true);
      return;
    }
  }

  bool lattice_free(int ix, int iy, int ih) {
    const Eigen::Vector3d pose = lattice_pose(ix, iy, ih);
    if (!settings_.bounds.contains(Eigen::Vector2d(pose.head<2>()))) return false;
    const auto [it, is_new] = known_.emplace(Key{Key::lattice, ix, iy, ih}.packed(), false);
    if (is_new) it->second = clearance_.free(pose);
    return it->second;
  }

  void to_lattice(int ix, int iy, int ih, const Node& parent, std::uint64_t parent_id) {
    const Key key{Key::lattice, ix, iy, ih};
    if (closed_.count(key.packed()) || !lattice_free(ix, iy, ih)) return;
    Eigen::Vector3d pose = lattice_pose(ix, iy, ih);
    pose.z() = parent.pose.z() + wrap_angle(pose.z() - parent.pose.z());
    push(key, parent, parent_id, {pose}, false);
  }

  void expand(const Key& key, const Node& node_now) {
    const Node node = node_now;  // the map may move it
    const std::uint64_t id = key.packed();
    if (key.kind == Key::lattice) {
      expand_lattice(key, node, id);
    } else {
      expand_portal(key, node, id);
    }
    // Straight to the goal: always when near, else once in a while.
    const bool is_near = (node.pose - to_).head<2>().norm() < (kPortals + 3) * settings_.resolution;
    if (is_near || (expansions_ & (expansions_ - 1)) == 0 || expansions_ % 128 == 0) {
      connect({Key::goal, 0, 0, 0}, to_, node, id);
    }
    if (!is_near || settings_.base != BaseKind::diff_drive) return;
    for (int k = goal_span_.back; k <= goal_span_.ahead; ++k) {
      const Eigen::Vector3d target = portal(to_, k);
      if (k != 0 && (node.pose - target).head<2>().norm() < 2.5 * settings_.resolution)
        connect({Key::goal, k, 0, 0}, target, node, id);
    }
  }

  void expand_lattice(const Key& key, const Node& node, std::uint64_t id) {
    for (int turn : {1, kHeadings - 1}) to_lattice(key.ix, key.iy, (key.ih + turn) % kHeadings, node, id);
    if (settings_.base == BaseKind::diff_drive) {
      const auto& d = kDrives[key.ih];
      for (int sign : {1, -1}) to_lattice(key.ix + sign * d[0], key.iy + sign * d[1], key.ih, node, id);
      return;
    }
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx != 0 || dy != 0) to_lattice(key.ix + dx, key.iy + dy, key.ih, node, id);
      }
    }
  }

  void expand_portal(const Key& key, const Node& node, std::uint64_t id) {
    const Span& span = key.kind == Key::start ? start_span_ : goal_span_;
    const Eigen::Vector3d& end = key.kind == Key::start ? from_ : to_;
    for (int k : {key.ix - 1, key.ix + 1}) {
      if (k < span.back || k > span.ahead) continue;
      Eigen::Vector3d pose = portal(end, k);
      pose.z() = node.pose.z();  // the same heading, on this path's own count of turns
      push({key.kind, k, 0, 0}, node, id, {pose}, true);
    }
    if (key.kind == Key::goal) return;
    const int ix = static_cast<int>(std::lround((node.pose.x() - from_.x()) / settings_.resolution));
    const int iy = static_cast<int>(std::lround((node.pose.y() - from_.y()) / settings_.resolution));
    for (int ih = 0; ih < kHeadings; ++ih) {
      if (lattice_free(ix, iy, ih)) connect({Key::lattice, ix, iy, ih}, lattice_pose(ix, iy, ih), node, id);
    }
  }

  std::vector<Eigen::Vector3d> trace(std::uint64_t id, std::uint64_t start) const {
    std::vector<Eigen::Vector3d> reversed;
    while (id != start) {
      const Node& node = closed_.at(id);
      reversed.insert(reversed.end(), node.way.rbegin(), node.way.rend());
      id = node.parent;
    }
    reversed.push_back(from_);
    return {reversed.rbegin(), reversed.rend()};
  }

  BaseClearance& clearance_;
  Eigen::Vector3d from_, to_;
  const BaseSearchSettings& settings_;
  std::size_t budget_;
  const Monitor& monitor_;
  Span start_span_, goal_span_;
  std::priority_queue<Entry> open_;
  std::unordered_map<std::uint64_t, Node> closed_;
  std::unordered_map<std::uint64_t, bool> known_;
  std::size_t order_ = 0;
  std::size_t expansions_ = 0;
};

}  // namespace

FoundBasePath search_base_path(BaseClearance& clearance, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                               const BaseSearchSettings& settings, const Monitor& monitor) {
  return BaseSearch(clearance, from, to, settings, kMaxExpansions, monitor).run();
}

}  // namespace mmgrasp::detail
