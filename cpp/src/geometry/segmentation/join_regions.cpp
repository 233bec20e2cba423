#include "geometry/segmentation/join_regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/segmentation/convex_parts.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

/// What the estimate of a volume may be wrong by, as a share of the joined hull.
constexpr double kVolumeError = 0.004;

/// Two regions also join when at least the share kMinShareOnHull of each lies on the hull of both: flat sides of one
/// box have no volume of their own. A face lies on the hull when it is no deeper in it than kMaxHullDepth times the
/// cube root of the hull's volume.
constexpr double kMinShareOnHull = 0.95, kMaxHullDepth = 0.005;
/// Most faces of a region whose depth is measured for that; they are spread over its area.
constexpr std::size_t kMaxFacesMeasured = 300;

struct Region {
  double area = 0;
  std::vector<Eigen::Vector3d> middles;  ///< Middles of some of its faces, spread over its area.
  std::map<int, double> around;          ///< Length of the border with each neighbour [m].
  RegionHull hull;
  bool alive = true;
  /// Twice the area over the length of the border: its width where it is long, half its radius where it is round.
  double width() const {
    double length = 0;
    for (const auto& [other, shared] : around) length += shared;
    return length > 0 ? 2 * area / length : kInfinity;
  }
};

/// Regions with their hulls: narrow ones join a neighbour, then pairs are joined whose common hull holds little that
/// belongs to neither, the best pair first.
class RegionJoiner {
 public:
  RegionJoiner(const FaceGraph& graph, int count, const std::vector<char>& outer, const std::vector<int>& labels)
      : regions_(count), into_(count) {
    for (int r = 0; r < count; ++r) into_[r] = r;
    std::vector<std::vector<int>> vertices(count);
    std::vector<double> all(count, 0), next(count, 0);
    std::vector<char> has_outer(count, 0);
    for (int f = 0; f < graph.size(); ++f) {
      if (labels[f] < 0) continue;
      regions_[labels[f]].area += graph.areas[f];
      has_outer[labels[f]] |= outer[f];
    }
    // A bore's wall may be given to the next body but one, and its hull would then reach through the one between.
    const auto shapes = [&](int f) { return labels[f] >= 0 && (outer[f] || !has_outer[labels[f]]); };
    for (int f = 0; f < graph.size(); ++f) {
      if (shapes(f)) all[labels[f]] += graph.areas[f];
    }
    std::vector<double> area(count, 0);
    for (int f = 0; f < graph.size(); ++f) {
      if (!shapes(f)) continue;
      Region& region = regions_[labels[f]];
      area[labels[f]] += graph.areas[f];
      if (area[labels[f]] >= next[labels[f]]) {
        region.middles.push_back(graph.centres[f]);
        next[labels[f]] += all[labels[f]] / kMaxFacesMeasured;
      }
      for (const int v : graph.faces[f]) vertices[labels[f]].push_back(v);
    }
    for (int r = 0; r < count; ++r) {
      std::sort(vertices[r].begin(), vertices[r].end());
      vertices[r].erase(std::unique(vertices[r].begin(), vertices[r].end()), vertices[r].end());
      std::vector<Eigen::Vector3d> points;
      for (const int v : vertices[r]) points.push_back(graph.vertices[v]);
      regions_[r].hull = region_hull(points);
    }
    for (const FaceBorder& border : graph.borders) {
      const int a = labels[border.first], b = labels[border.second];
      if (a < 0 || b < 0 || a == b) continue;
      regions_[a].around[b] += border.length;
      regions_[b].around[a] += border.length;
    }
  }

  void join_narrow(double narrowest) {
    while (true) {
      int least = -1;
      double width = narrowest;
      for (std::size_t r = 0; r < regions_.size(); ++r) {
        if (!regions_[r].alive || regions_[r].width() >= width) continue;
        width = regions_[r].width();
        least = static_cast<int>(r);
      }
      if (least < 0) return;
      int best = -1;
      auto best_cost = std::make_pair(kInfinity, 0.0);
      for (const auto& [other, shared] : regions_[least].around) {
        const auto cost = std::make_pair(uncovered_volume(regions_[least].hull, regions_[other].hull), -shared);
        if (cost >= best_cost) continue;
        best_cost = cost;
        best = other;
      }
      // The hull stays what it was: a rounded edge does not make a flare of a cylinder.
      const RegionHull hull = regions_[best].hull.volume > 0 ? regions_[best].hull : RegionHull{};
      join(best, least);
      if (hull.volume > 0) regions_[best].hull = hull;
    }
  }

  void join_convex(double convexity) {
    std::map<std::pair<int, int>, double> known;
    while (true) {
      std::pair<int, int> best{-1, -1};
      double least = kInfinity;
      for (std::size_t r = 0; r < regions_.size(); ++r) {
        if (!regions_[r].alive) continue;
        for (const auto& [other, shared] : regions_[r].around) {
          const std::pair<int, int> pair{static_cast<int>(r), other};
          if (pair.first > other) continue;
          auto at = known.find(pair);
          if (at == known.end())
            at = known.emplace(pair, excess(regions_[pair.first], regions_[other], convexity)).first;
          if (at->second >= least) continue;
          least = at->second;
          best = pair;
        }
      }
      if (least > 0) return;
      join(best.first, best.second);
      for (auto at = known.begin(); at != known.end();) {
        const bool stale = at->first.first == best.first || at->first.second == best.first ||
                           at->first.first == best.second || at->first.second == best.second;
        at = stale ? known.erase(at) : std::next(at);
      }
    }
  }

  int renumber(std::vector<int>& labels) const {
    std::vector<int> number(regions_.size(), -1);
    int count = 0;
    for (int& label : labels) {
      if (label < 0) continue;
      int root = label;
      while (into_[root] != root) root = into_[root];
      if (number[root] < 0) number[root] = count++;
      label = number[root];
    }
    return count;
  }

 private:
  /// How much more of the joined hull is uncovered than may be, as a share of it; joined where it is not above 0. Below
  /// -0.5 where both lie on that hull.
  static double excess(const Region& a, const Region& b, double convexity) {
    RegionHull hull;
    const double open = uncovered_volume(a.hull, b.hull, &hull);
    if (hull.volume <= 0) return kInfinity;
    if (share_on(hull, a) >= kMinShareOnHull && share_on(hull, b) >= kMinShareOnHull) return -1;
    return (open - convexity * std::min(a.hull.volume, b.hull.volume)) / hull.volume - kVolumeError;
  }

  static double share_on(const RegionHull& hull, const Region& region) {
    const double depth = kMaxHullDepth * std::cbrt(hull.volume);
    std::size_t on = 0;
    for (const Eigen::Vector3d& x : region.middles) {
      on += std::any_of(hull.planes.begin(), hull.planes.end(),
                        [&](const Eigen::Vector4d& p) { return p.head<3>().dot(x) > p.w() - depth; });
    }
    return region.middles.empty() ? 0 : static_cast<double>(on) / static_cast<double>(region.middles.size());
  }

  void join(int kept, int removed) {
    Region &a = regions_[kept], &b = regions_[removed];
    a.area += b.area;
    a.middles.insert(a.middles.end(), b.middles.begin(), b.middles.end());
    std::vector<Eigen::Vector3d> points = a.hull.points;
    points.insert(points.end(), b.hull.points.begin(), b.hull.points.end());
    a.hull = region_hull(points);
    for (const auto& [other, shared] : b.around) {
      regions_[other].around.erase(removed);
      if (other == kept) continue;
      a.around[other] += shared;
      regions_[other].around[kept] += shared;
    }
    a.around.erase(removed);
    b = Region{};
    b.alive = false;
    into_[removed] = kept;
  }

  std::vector<Region> regions_;
  std::vector<int> into_;
};

}  // namespace

int join_regions(const FaceGraph& graph, const std::vector<char>& outer, double narrowest, double convexity,
                 std::vector<int>& labels) {
  const int count = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
  RegionJoiner joiner(graph, count, outer, labels);
  joiner.join_narrow(narrowest);
  joiner.join_convex(convexity);
  return joiner.renumber(labels);
}

}  // namespace mmgrasp::detail
