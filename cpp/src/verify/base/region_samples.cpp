// Draws base poses in the regions of a plan, beside them and elsewhere: the proof of the least number of stops rests on
// them.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "verify/base/grasp_search.hpp"
#include "verify/base/left_out_cells.hpp"
#include "verify/base/searched_cells.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr int kTries = 300;             // IK solutions tried for a part: fewer than at the stops, which must be robust.
constexpr int kBeside = 1;              // Cells so many rows or columns from a region are beside it.
constexpr double kLeastServing = 0.85;  // Least share of the poses drawn in a region that serve all its parts.
constexpr int kSectors = 8;             // The border is looked at in pieces: a region may lack one side only.
constexpr double kOutside = 0.5;        // Largest share of the cells beside it that do (in 67 regions 7 % did at most).
constexpr double kPiece = 0.75;         // Largest share of the cells of one piece.
constexpr double kClaimed = 0.9;        // Least share of the poses drawn in the disc that a stop claims.
constexpr std::size_t kFewest = 5;      // Fewer samples than this tell nothing.
constexpr int kFirstLook = 5;           // Cells drawn in each piece of the border, more where these serve.
constexpr int kAround = 2;              // So many rows and columns around a cell that serves are looked at as well.
constexpr std::size_t kPatch = 12;      // Fewest cells around it that a planner should have found.

/// Some of the cells that are shown to it, each as likely as any other.
class DrawnCells {
 public:
  explicit DrawnCells(int count) : count_(count) {}
  void show(const Cell& cell, Rng& rng) {
    const std::size_t place = shown_ < count_ ? shown_ : rng.index(shown_ + 1);
    ++shown_;
    if (place == cells_.size())
      cells_.push_back(cell);
    else if (place < count_)
      cells_[place] = cell;
  }
  const std::vector<Cell>& cells() const { return cells_; }

 private:
  std::size_t count_, shown_ = 0;
  std::vector<Cell> cells_;
};

/// Cells of one region, and those outside of it that were searched for its tray: beside it, and some farther off.
class RegionCells : public SearchedCells {
 public:
  /// Cells farther off are drawn: `looks` at each heading that the region has, `samples` at others.
  RegionCells(const PlanToCheck& plan, const CheckedRegion& region, int looks, int samples, Rng& rng)
      : SearchedCells(plan, region), grid_(plan.grid) {
    std::vector<bool> known(static_cast<std::size_t>(grid_.nx) * grid_.ny, false);
    std::vector<bool> has_layer(grid_.headings.size(), false);
    visit([&](const Cell& cell) {
      if (!has(cell)) return;
      inside.push_back(cell);
      known[index({0, cell.ix, cell.iy})] = has_layer[cell.layer] = true;
    });
    for (const bool here : has_layer) {
      const int count = here ? looks : samples;
      elsewhere.insert(elsewhere.end(), 2, DrawnCells(count));
    }
    visit([&](const Cell& cell) {
      if (!is_left_out(cell)) return;
      if (beside_region(cell)) return beside.push_back(cell);
      if (known[index({0, cell.ix, cell.iy})]) elsewhere[2 * cell.layer].show(cell, rng);
      elsewhere[2 * cell.layer + 1].show(cell, rng);
    });
  }

  /// The cells beside the region by the side of it on which they lie: those of each heading in sectors around its
  /// middle, sides of few cells together.
  std::vector<std::vector<Cell>> border() const {
    std::vector<Eigen::Vector3d> middles(grid_.headings.size(), Eigen::Vector3d::Zero());  // sums, and how many
    for (const Cell& cell : inside) middles[cell.layer] += Eigen::Vector3d(cell.ix, cell.iy, 1);
    std::vector<std::vector<Cell>> pieces(grid_.headings.size() * kSectors);
    for (const Cell& cell : beside) {
      const Eigen::Vector3d& sum = middles[cell.layer];
      const double angle = std::atan2(cell.iy - sum.y() / sum.z(), cell.ix - sum.x() / sum.z());
      const int sector = static_cast<int>(std::floor((angle / mmgrasp::detail::kPi + 1) / 2 * kSectors));
      pieces[cell.layer * kSectors + std::clamp(sector, 0, kSectors - 1)].push_back(cell);
    }
    std::vector<std::vector<Cell>> large(grid_.headings.size());  // at first what is left of each heading
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      std::vector<Cell>& rest = large[i / kSectors];
      if (pieces[i].size() < kFewest)
        rest.insert(rest.end(), pieces[i].begin(), pieces[i].end());
      else
        large.push_back(std::move(pieces[i]));
    }
    return large;
  }

  /// The cells outside of the region around one of them, itself included.
  std::vector<Cell> around(const Cell& middle) const {
    std::vector<Cell> near;
    for (int iy = middle.iy - kAround; iy <= middle.iy + kAround; ++iy) {
      for (int ix = middle.ix - kAround; ix <= middle.ix + kAround; ++ix) {
        const Cell cell{middle.layer, ix, iy};
        if (is_left_out(cell)) near.push_back(cell);
      }
    }
    return near;
  }

  std::vector<Cell> inside, beside;
  /// Those farther off, two for each heading: at places that the region has at other headings, and anywhere.
  std::vector<DrawnCells> elsewhere;

 private:
  bool beside_region(const Cell& cell) const {
    for (const auto& [dx, dy] : {std::pair{kBeside, 0}, {-kBeside, 0}, {0, kBeside}, {0, -kBeside}}) {
      if (has({cell.layer, cell.ix + dx, cell.iy + dy})) return true;
    }
    return false;
  }

  const CheckedGrid& grid_;
};

template <class T>
std::vector<T> drawn(const std::vector<T>& all, int count, Rng& rng) {
  std::vector<T> some;
  for (int i = 0; i < count && !all.empty(); ++i) some.push_back(all[rng.index(all.size())]);
  return some;
}

/// Draws base poses inside a region, which must serve its tray, and cells beside it, which must not.
class RegionCheck {
 public:
  RegionCheck(const Context& context, Faults& faults, GraspSearch search, Rng rng)
      : context_(context), plan_(context.plan), faults_(faults), search_(std::move(search)), rng_(rng) {}

  void region(const CheckedRegion& region) {
    const std::vector<int> parts = wanted_parts(plan_, {region.tray});
    const std::size_t size = plan_.grid.headings.size() * static_cast<std::size_t>(plan_.grid.nx) * plan_.grid.ny;
    if (parts.empty() || region.cells.size() != size) return;  // the latter is said at the stops
    const int count = context_.options.region_samples;
    const RegionCells cells(plan_, region, std::min(kFirstLook, count), count, rng_);
    const std::string where = "region of tray '" + region.tray + "'";
    std::vector<Eigen::Vector3d> poses;
    for (const Cell& cell : drawn(cells.inside, count, rng_)) {
      const double x = rng_.uniform(0, 1), y = rng_.uniform(0, 1);
      poses.push_back(cells.pose(cell, x, y));
    }
    const double needed = kLeastServing * static_cast<double>(poses.size());
    const int from = serving(poses, parts, needed);
    if (context_.monitor.stopped()) return;
    if (poses.size() >= kFewest && from < needed) {
      faults_.push_back({"region-inflated", where,
                         "only from " + std::to_string(from) + " of " + std::to_string(poses.size()) +
                             " base poses drawn in it all parts can be grasped"});
    }
    if (plan_.padded) return;
    Look all;
    for (const std::vector<Cell>& piece : cells.border()) {
      Look look = looked_at(cells, piece, kFirstLook, parts);
      all += look;
      if (piece.size() < kFewest) continue;
      if (look.share() > kOutside) look += looked_at(cells, piece, count, parts);
      if (context_.monitor.stopped()) return;
      if (look.share() <= kPiece) continue;
      incomplete(where, look, "beside it, around " + text_of(cells, piece[piece.size() / 2]));
      return;  // one piece that is missing is enough
    }
    if (cells.beside.size() >= kFewest && all.share() > kOutside)
      incomplete(where, all, "beside it");
    else
      missing_patch(cells, where, parts);
  }

  /// The disc that a stop claims, beyond its uncertainty disc, which is checked more closely.
  void stop(std::size_t index) {
    const CheckedStop& stop = plan_.stops[index];
    const double least = plan_.positioning_uncertainty;
    if (!(stop.radius > least + 1e-6)) return;
    const std::vector<int> parts = wanted_parts(plan_, stop.trays);
    const int count = 2 * context_.options.region_samples;
    std::vector<Eigen::Vector3d> poses;
    for (int i = 0; i < count; ++i) {
      const double radius = std::sqrt(rng_.uniform(least * least, stop.radius * stop.radius));
      const double angle = rng_.uniform(-mmgrasp::detail::kPi, mmgrasp::detail::kPi);
      poses.push_back(stop.pose + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
    }
    const int good = serving(poses, parts, kClaimed * count);
    if (good >= kClaimed * count || context_.monitor.stopped()) return;
    faults_.push_back({"stop-radius", "stop " + std::to_string(index),
                       "says that all parts can be grasped within " + text(stop.radius) + " m: between " + text(least) +
                           " m and there they can from " + std::to_string(good) + " of " + std::to_string(count) +
                           " base poses"});
  }

 private:
  /// How many cells were looked at, and how many of them serve.
  struct Look {
    int good = 0, tried = 0;

    double share() const { return tried == 0 ? 0.0 : static_cast<double>(good) / tried; }
    void operator+=(const Look& other) {
      good += other.good;
      tried += other.tried;
    }
  };

  /// Cells are drawn wherever the tray was searched; where one serves, those around it mostly must not.
  void missing_patch(const RegionCells& cells, const std::string& where, const std::vector<int>& parts) {
    const int count = context_.options.region_samples;
    for (const DrawnCells& layer : cells.elsewhere) {
      for (const Cell& cell : layer.cells()) {
        if (context_.monitor.stopped()) return;
        if (!whole_cell_serves(plan_, search_, cells, cell, parts)) continue;
        const std::vector<Cell> patch = cells.around(cell);
        if (patch.size() < kPatch) continue;
        const Look look = looked_at(cells, patch, count, parts);
        if (context_.monitor.stopped()) return;
        if (look.share() > kPiece) return incomplete(where, look, "outside of it, around " + text_of(cells, cell));
      }
    }
  }

  static std::string text_of(const RegionCells& cells, const Cell& cell) {
    const Eigen::Vector3d middle = cells.pose(cell, 0.5, 0.5);
    return "(" + text(middle.x()) + ", " + text(middle.y()) + ") at heading " + text(middle.z()) + ",";
  }

  Look looked_at(const RegionCells& cells, const std::vector<Cell>& piece, int count, const std::vector<int>& parts) {
    Look look;
    for (const Cell& cell : drawn(piece, count, rng_)) {
      if (context_.monitor.stopped()) return look;
      look.good += whole_cell_serves(plan_, search_, cells, cell, parts);
      ++look.tried;
    }
    return look;
  }

  void incomplete(const std::string& region, const Look& look, const std::string& place) {
    faults_.push_back({"region-incomplete", region,
                       "from " + std::to_string(look.good) + " of " + std::to_string(look.tried) + " cells drawn " +
                           place + " all parts can be grasped: the least number of stops is not proven"});
  }

  bool serves(const Eigen::Vector3d& pose, const std::vector<int>& parts, Effort effort = Effort::usual) {
    return base_pose_serves(plan_, search_, pose, parts, effort);
  }

  /// How many of the poses serve, up to `needed`: as long as these are missing, a pose that seems lost is checked
  /// again with more tries, since a search by samples may miss a grasp that is there.
  int serving(const std::vector<Eigen::Vector3d>& poses, const std::vector<int>& parts, double needed) {
    std::vector<Eigen::Vector3d> lost;
    for (const Eigen::Vector3d& pose : poses)
      if (!context_.monitor.stopped() && !serves(pose, parts)) lost.push_back(pose);
    int good = static_cast<int>(poses.size() - lost.size());
    for (const Eigen::Vector3d& pose : lost)
      if (good < needed && !context_.monitor.stopped()) good += serves(pose, parts, Effort::thorough);
    return good;
  }

  const Context& context_;
  const PlanToCheck& plan_;
  Faults& faults_;
  GraspSearch search_;
  Rng rng_;
};

}  // namespace

void check_regions(const Context& context, Faults& faults, std::size_t& configurations) {
  if (context.options.region_samples == 0) return;
  const std::size_t regions = context.plan.regions.size(), stops = context.plan.stops.size();
  const Pools pools = planned_holds(context);
  std::vector<Judge> judges(resolve_threads(context.options.threads), Judge(context.stage));
  std::vector<Faults> found(regions + stops);
  const auto work = [&](std::size_t item, int worker) {
    Judge& judge = judges[worker];
    const unsigned seed = context.options.seed;
    GraspSearch search(context, judge, pools, Rng(seed, 2 * item + 1'000'000), kTries);
    RegionCheck check(context, found[item], std::move(search), Rng(seed, 2 * item + 1'000'001));
    if (item < regions)
      check.region(context.plan.regions[item]);
    else
      check.stop(item - regions);
  };
  parallel_for(found.size(), context.options.threads, work, context.monitor, "regions");
  for (const Faults& some : found) faults.insert(faults.end(), some.begin(), some.end());
  for (const Judge& judge : judges) configurations += judge.queries();
  if (!context.plan.padded) check_left_out_cells(context, pools, faults, configurations);
}

}  // namespace mmgrasp::verify::detail
