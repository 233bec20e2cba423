#include "collision/pair_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "collision/bodies.hpp"
#include "collision/field_walk.hpp"
#include "collision/narrow.hpp"

namespace mmgrasp::detail {

namespace {

// Far above the rounding of what is compared, so that a proof never contradicts the exact check.
constexpr double kSlack = 2e-6;
// Beyond this the angle itself is rounded too coarsely.
constexpr double kLargestAngle = 1e4;

// Cells along each axis as powers of two, coarse to fine, by the number of axes.
std::vector<int> bits_for(std::size_t axes) {
  if (axes == 1) return {5, 10};
  if (axes == 2) return {4, 6, 7, 8};
  return {4, 6};
}

Rigid moved(const PairChain::Axis& axis, double value) {
  Rigid motion;
  if (axis.slides) {
    motion.t[2] = value;
  } else {
    motion.R = Eigen::AngleAxisd(value, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  return axis.before * motion;
}

// Looks at nodes and balls that a proof may cost: it is sought once for each cell, but cells are many.
constexpr long kBudget = 3000;
// The balls of smaller meshes say less than their triangles, and no sooner.
constexpr std::size_t kManyTriangles = 5000;

// The lower body while the joints stay within a cell.
class Sweep {
 public:
  Sweep(const PairChain& chain, const double* middle, const double* half) {
    Rigid at = chain.upper_in_frame.to(Rigid());
    for (std::size_t i = 0; i < chain.axes.size(); ++i) {
      at = at * moved(chain.axes[i], middle[i]);
      turns_[count_++] = {at.t, at.R.col(2), half[i], chain.axes[i].slides};
    }
    lower_in_upper_ = at * chain.lower_in_frame;
  }

  const Rigid& lower_in_upper() const { return lower_in_upper_; }

  // How far a point within `radius` of the hull of these, frame of the upper body, can get from where it is in the
  // middle of the cell: the joints move one after the other, the lowest first, so that those above still stand in the
  // middle.
  double operator()(const Eigen::Vector3d* points, int count, double radius) const {
    double motion = 0;
    for (int i = count_; i-- > 0;) {
      const Turn& turn = turns_[i];
      if (turn.slides) {
        motion += turn.half;
        continue;
      }
      double squared = 0;
      for (int k = 0; k < count; ++k)
        squared = std::max(squared, (points[k] - turn.point).cross(turn.direction).squaredNorm());
      motion += turn.half * (std::sqrt(squared) + radius + motion);
    }
    return motion + kSlack;
  }

 private:
  struct Turn {
    Eigen::Vector3d point, direction;  // of the axis in the middle of the cell, frame of the upper body
    double half;
    bool slides;
  };
  Turn turns_[PairChain::kMaxAxes];
  int count_ = 0;
  Rigid lower_in_upper_;
};

// The balls of the lower body stay out of the upper one.
bool balls_stay_out(const DistanceField& field, const CoverLevels& covers, const Sweep& sweep, long& budget) {
  const int levels = static_cast<int>(covers.size());
  const auto stays_out = [&](const auto& self, int level, int first, int last) -> bool {
    const CoverView cover = covers[static_cast<std::size_t>(level)].view();
    for (int i = first; i < std::min(last, cover.filled); ++i) {
      if (cover.x[i] > 1e17f) continue;  // an empty place
      if (--budget < 0) return false;
      const Eigen::Vector3d centre = sweep.lower_in_upper() * Eigen::Vector3d(cover.x[i], cover.y[i], cover.z[i]);
      const double radius = cover.outer[i];
      const double room = field.distance(centre) - radius;
      if (room > 0 && room > sweep(&centre, 1, radius)) continue;
      if (level + 1 == levels || !self(self, level + 1, kLanes * i, kLanes * (i + 1))) return false;
    }
    return true;
  };
  return !covers.empty() && !covers.front().empty() && stays_out(stays_out, 0, 0, covers.front().view().filled);
}

}  // namespace

PairTable::PairTable(const PairChain& chain) : chain_(chain) {
  const std::vector<int> bits = bits_for(chain.axes.size());
  for (const int own : bits) {
    const std::size_t cells = std::size_t{1} << (static_cast<std::size_t>(own) * chain.axes.size());
    levels_.push_back({own, bits.back() - own, std::make_unique<std::atomic<std::uint8_t>[]>(cells)});
    for (std::size_t i = 0; i < cells; ++i) levels_.back().cells[i].store(0, std::memory_order_relaxed);
  }
}

bool PairTable::find(const double* q, int* fine) const {
  const int count = 1 << levels_.back().bits;
  for (std::size_t i = 0; i < chain_.axes.size(); ++i) {
    const PairChain::Axis& axis = chain_.axes[i];
    const double value = axis.multiplier * q[axis.column] + axis.offset;
    if (!(std::abs(value) < kLargestAngle)) return false;
    double share = (value - axis.low) * axis.per_size;
    if (axis.wraps) {
      share -= static_cast<int>(share);
      if (share < 0) share += 1;
    } else if (share < 0 || share > 1) {
      return false;
    }
    fine[i] = std::min(static_cast<int>(share * count), count - 1);
  }
  return true;
}

std::atomic<std::uint8_t>& PairTable::at(const Level& level, const int* fine) const {
  std::size_t index = 0;
  for (std::size_t i = 0; i < chain_.axes.size(); ++i)
    index = (index << level.bits) | static_cast<std::size_t>(fine[i] >> level.shift);
  return level.cells[index];
}

// What a cell holds is all there is to know about it, no other memory hangs on it: relaxed order is enough. A count or
// a proof lost to another thread is found again.
bool PairTable::apart(const double* q) const {
  int fine[PairChain::kMaxAxes];
  if (!find(q, fine)) return false;
  for (const Level& level : levels_) {
    const std::uint8_t state = at(level, fine).load(std::memory_order_relaxed);
    if (state != kUnsure) return state == kApart;
  }
  return false;
}

bool PairTable::spent(const double* q, int cost, const BodyShape& upper, const BodyShape& lower) const {
  int fine[PairChain::kMaxAxes];
  if (!find(q, fine)) return false;
  for (const Level& level : levels_) {
    std::atomic<std::uint8_t>& cell = at(level, fine);
    const int state = cell.load(std::memory_order_relaxed);
    if (state == kUnsure) continue;
    if (state == kApart) return true;
    if (state + cost < (level.shift > 0 ? kWorth : kWorthFinest)) {
      cell.store(static_cast<std::uint8_t>(state + cost), std::memory_order_relaxed);
      return false;
    }
    const bool apart = proven(level, fine, upper, lower);
    cell.store(apart ? kApart : kUnsure, std::memory_order_relaxed);
    return apart;
  }
  return false;
}

bool PairTable::proven(const Level& level, const int* fine, const BodyShape& upper, const BodyShape& lower) const {
  double middle[PairChain::kMaxAxes], half[PairChain::kMaxAxes];
  for (std::size_t i = 0; i < chain_.axes.size(); ++i) {
    const PairChain::Axis& axis = chain_.axes[i];
    const double width = axis.size / (1 << level.bits);
    middle[i] = axis.low + width * ((fine[i] >> level.shift) + 0.5);
    half[i] = 0.5 * width + 1e-9;
  }
  const Sweep sweep(chain_, middle, half);
  const BodyBounds::Detail& below = lower.bounds->detail(*lower.solid);
  const auto& field = upper.bounds->detail(*upper.solid).field;
  if (field == nullptr) return false;
  const Solid &a = *upper.solid, &b = *lower.solid;
  const bool meshes = a.kind == SolidKind::mesh && b.kind == SolidKind::mesh;
  long budget = kBudget;
  if (!meshes || b.triangles.size() > kManyTriangles) {
    if (balls_stay_out(*field, below.covers, sweep, budget)) return true;
    if (!meshes) return false;
    budget = kBudget;
  }
  if (tree_hits_field(a, *field, b, sweep.lower_in_upper(), sweep, budget)) return false;
  // Surfaces that never meet leave each part inside or outside all the while.
  return !one_inside(a, b, sweep.lower_in_upper());
}

namespace {

// Bodies and chain; the bodies by address, which their entry tells apart from later ones.
using Key = std::pair<std::pair<const Solid*, const Solid*>, std::vector<double>>;

struct Entry {
  std::weak_ptr<const Solid> upper, lower;
  std::shared_ptr<const PairTable> table;
};

// Tables that no checker uses go first when there are more.
constexpr std::size_t kMaxTables = 400;

std::vector<double> numbers(const PairChain& chain) {
  std::vector<double> out;
  const auto add = [&](const Rigid& T) {
    out.insert(out.end(), T.R.data(), T.R.data() + 9);
    out.insert(out.end(), T.t.data(), T.t.data() + 3);
  };
  add(chain.upper_in_frame);
  add(chain.lower_in_frame);
  for (const PairChain::Axis& axis : chain.axes) {
    add(axis.before);
    out.insert(out.end(), {axis.multiplier, axis.offset, static_cast<double>(axis.column), axis.slides ? 1.0 : 0.0,
                           axis.low, axis.size});
  }
  return out;
}

bool may_have_one(const Solid& solid) {
  return (solid.kind == SolidKind::convex || solid.kind == SolidKind::mesh) && solid.margin == 0;
}

}  // namespace

std::shared_ptr<const PairTable> shared_table(const PairChain& chain, const std::shared_ptr<const Solid>& upper,
                                              const std::shared_ptr<const Solid>& lower) {
  if (!may_have_one(*upper) || !may_have_one(*lower)) return nullptr;
  static std::mutex mutex;
  static std::map<Key, Entry> known;
  const Key key{{upper.get(), lower.get()}, numbers(chain)};
  const std::lock_guard<std::mutex> lock(mutex);
  const auto it = known.find(key);
  if (it != known.end() && it->second.upper.lock() == upper && it->second.lower.lock() == lower)
    return it->second.table;
  for (auto other = known.begin(); other != known.end();) {
    const bool dead = other->second.upper.expired() || other->second.lower.expired();
    const bool idle = known.size() >= kMaxTables && other->second.table.use_count() == 1;
    other = dead || idle ? known.erase(other) : std::next(other);
  }
  Entry& entry = known[key];
  entry = {upper, lower, std::make_shared<const PairTable>(chain)};
  return entry.table;
}

}  // namespace mmgrasp::detail
