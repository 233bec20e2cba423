#include "collision/checker/clearance_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/narrow/convex_clearance.hpp"
#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr int kFinest = 512;                      // Cells around.
constexpr int kCoarser = 4;                       // Cells of one level in one of the level above, each way.
constexpr double kQuantum = 2.5e-4;               // Resolution of the clearances kept [m].
constexpr std::uint8_t kWholeCell = 255;          // The code of a cell in which the bodies stay apart everywhere.
constexpr double kMaxClearance = 253 * kQuantum;  // Wider clearances are kept as this one.
constexpr double kMaxExactClearance = 0.01;       // Triangles are only tested for clearances up to this [m].
constexpr double kLeastClearance = 1e-9;          // What is known within a whole cell [m].
constexpr double kRounding = 1e-6;                // Poses here and in the checker are rounded differently.
constexpr std::size_t kMaxTables = 256;

constexpr int cells_around(int level) {
  int n = kFinest;
  for (; level < 2; ++level) n /= kCoarser;
  return n;
}

double middle(int level, long i) {
  return (static_cast<double>(i) + 0.5) * (kTwoPi / cells_around(level));
}

Rigid turned(const Rigid& T, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Rigid out = T;
  out.R.col(0) = c * T.R.col(0) + s * T.R.col(1);
  out.R.col(1) = c * T.R.col(1) - s * T.R.col(0);
  return out;
}

long wrapped(long i, long n) {
  const long rest = i % n;
  return rest < 0 ? rest + n : rest;
}

// How many steps on the angles stay in their cell of the finest level.
double steps_in_cell(const std::array<double, 2>& angles, const std::array<double, 2>& step) {
  double steps = kInfinity;
  for (int k = 0; k < 2; ++k) {
    const double at = angles[k] * (kFinest / kTwoPi), in_cell = at - std::floor(at);
    const double each = step[k] * (kFinest / kTwoPi);
    if (each != 0) steps = std::min(steps, (each > 0 ? 1 - in_cell : in_cell) / std::abs(each));
  }
  // Rounding of the angles is far less than a millionth of a step.
  return std::max(0.0, steps - 1e-6);
}

}  // namespace

ClearanceTable::ClearanceTable(const TableBody& a, const TableBody& b, const RevolutePair& joints)
    : a_(*a.solid), b_(*b.solid), bounds_a_(*a.bounds), bounds_b_(*b.bounds), joints_(joints) {
  for (int level = 0; level < kLevels; ++level)
    within_cell_[level] = (joints.rates[0] + joints.rates[1]) * kPi / cells_around(level) + kRounding;
}
ClearanceTable::~ClearanceTable() = default;

double ClearanceTable::at_least(double first, double second, double wanted) const {
  constexpr double kPerRadian = kFinest / kTwoPi;
  const long i = std::lround(std::floor(first * kPerRadian)), j = std::lround(std::floor(second * kPerRadian));
  const long in_i = wrapped(i, kFinest), in_j = wrapped(j, kFinest);
  first -= static_cast<double>(i - in_i) / kPerRadian;
  second -= static_cast<double>(j - in_j) / kPerRadian;
  double best = 0;
  for (int level = 0, shift = kFinest / cells_around(0); level < kLevels; ++level, shift /= kCoarser) {
    // Cells that cannot prove enough are not read.
    if (best > 0 && widest(level) < wanted) break;
    const long ci = in_i / shift, cj = in_j / shift;
    const double off = joints_.rates[0] * std::abs(first - middle(level, ci)) +
                       joints_.rates[1] * std::abs(second - middle(level, cj)) + kRounding;
    const std::uint8_t known = code(level, static_cast<int>(ci), static_cast<int>(cj));
    best = std::max(best, known == kWholeCell ? kLeastClearance : (known - 1) * kQuantum - off);
    if (best > wanted) break;
  }
  return best;
}

bool ClearanceTable::stays_apart(const std::array<double, 2>& from, const std::array<double, 2>& step, long first,
                                 long last) const {
  // Rates and clearances are sums of a few numbers.
  const double each = (joints_.rates[0] * std::abs(step[0]) + joints_.rates[1] * std::abs(step[1])) * (1 + 1e-9);
  for (long at = first; at <= last;) {
    const std::array<double, 2> angles{from[0] + static_cast<double>(at) * step[0],
                                       from[1] + static_cast<double>(at) * step[1]};
    const double apart = at_least(angles[0], angles[1], each) - kRounding;
    double proven = apart / each;
    if (apart <= 0) {
      if (!in_whole_cell(angles[0], angles[1])) return false;
      proven = steps_in_cell(angles, step);
    }
    if (proven >= static_cast<double>(last - at)) return true;
    at += 1 + static_cast<long>(proven);
  }
  return true;
}

bool ClearanceTable::in_whole_cell(double first, double second) const {
  const auto cell = [](double angle) {
    return static_cast<int>(wrapped(std::lround(std::floor(angle * (kFinest / kTwoPi))), kFinest));
  };
  return code(kLevels - 1, cell(first), cell(second)) == kWholeCell;
}

double ClearanceTable::widest(int level) const {
  return std::min(4 * within_cell_[level], kMaxClearance);
}

std::uint8_t ClearanceTable::code(int level, int i, int j) const {
  const int n = cells_around(level);
  std::call_once(made_[level], [&] { cells_[level] = std::make_unique<Code[]>(static_cast<std::size_t>(n) * n); });
  Code& cell = cells_[level][static_cast<std::size_t>(i) * n + j];
  std::uint8_t known = cell.load(std::memory_order_relaxed);
  if (known == 0) {
    known = measured(level, i, j);
    cell.store(known, std::memory_order_relaxed);
  }
  return known;
}

std::uint8_t ClearanceTable::measured(int level, int i, int j) const {
  const auto in_quanta = [](double clearance) {
    return static_cast<std::uint8_t>(1 + static_cast<int>(std::clamp(clearance, 0.0, kMaxClearance) / kQuantum));
  };
  const Rigid T = turned(turned(joints_.before, middle(level, i)) * joints_.between, middle(level, j)) * joints_.after;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  ConvexClearance hulls;
  ClearanceKind kind = ClearanceKind::overlapping;
  if (a_.has_hull && b_.has_hull) kind = convex_clearance(a_.core, b_.core, T, widest(level), axis, hulls);
  if (kind == ClearanceKind::beyond) return in_quanta(widest(level));
  if (kind == ClearanceKind::apart && hulls.distance > 2 * within_cell_[level]) return in_quanta(hulls.distance);
  for (const double clearance : {2 * within_cell_[level], within_cell_[level]}) {
    Closing closing;
    closing.most = clearance;
    if (clearance <= kMaxExactClearance && !collide(T, closing)) return in_quanta(clearance);
  }
  if (level == kLevels - 1 && stays_apart_in_cell(i, j)) return kWholeCell;
  return in_quanta(kind == ClearanceKind::apart ? hulls.distance : 0);
}

bool ClearanceTable::stays_apart_in_cell(int i, int j) const {
  const Rigid first = turned(joints_.before, middle(kLevels - 1, i));
  const Rigid second = turned(first * joints_.between, middle(kLevels - 1, j));
  const Rigid T = second * joints_.after;
  const double half = kPi / kFinest;
  Closing closing;
  closing.directed = closing.two_motions = true;
  closing.centre = T * b_.sphere_centre;
  closing.radius = b_.sphere_radius;
  closing.turn = half * first.R.col(2);
  closing.shift = closing.turn.cross(closing.centre - first.t);
  closing.second_turn = half * second.R.col(2);
  closing.second_shift = closing.second_turn.cross(closing.centre - second.t);
  // Along a straight way in both angles a point p bends from it by at most half of |w1 x (w1 x u1)| + |w2 x (w2 x u2)|
  // + 2 |w1 x (w2 x u2)|, u_k leading from axis k to p: no farther anywhere in the cell than the spheres' radii here
  // and what half a cell turns them.
  const double reach_1 = (1 + 2 * half) * ((closing.centre - first.t).norm() + closing.radius);
  const double reach_2 = (closing.centre - second.t).norm() + closing.radius;
  closing.bend = 0.5 * half * half * (reach_1 + 3 * reach_2) + kRounding;
  closing.most = closing.shift.norm() + closing.second_shift.norm() +
                 (closing.turn.norm() + closing.second_turn.norm()) * closing.radius + closing.bend;
  return closing.most <= kMaxExactClearance && !collide(T, closing);
}

bool ClearanceTable::collide(const Rigid& b_in_a, const Closing& closing) const {
  const Rigid T_a;
  if (a_.sphere_radius < b_.sphere_radius) return meshes_collide(a_, T_a, *bounds_a_.grid(a_), b_, b_in_a, closing);
  return meshes_collide(b_, b_in_a, *bounds_b_.grid(b_), a_, T_a, closing.swapped());
}

std::shared_ptr<const ClearanceTable> shared_clearance_table(const TableBody& a, const TableBody& b,
                                                             const RevolutePair& joints) {
  struct Entry {
    std::weak_ptr<const Solid> a, b;
    std::shared_ptr<const ClearanceTable> table;
  };
  using Key = std::pair<std::pair<const Solid*, const Solid*>, std::vector<double>>;
  static std::mutex mutex;
  static std::map<Key, Entry> known;
  std::vector<double> numbers(joints.rates.begin(), joints.rates.end());
  for (const Rigid* T : {&joints.before, &joints.between, &joints.after}) {
    numbers.insert(numbers.end(), T->R.data(), T->R.data() + 9);
    numbers.insert(numbers.end(), T->t.data(), T->t.data() + 3);
  }
  const Key key{{a.solid.get(), b.solid.get()}, std::move(numbers)};
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto it = known.begin(); it != known.end();) {
    it = it->second.a.expired() || it->second.b.expired() ? known.erase(it) : std::next(it);
  }
  const auto it = known.find(key);
  if (it != known.end()) return it->second.table;
  if (known.size() >= kMaxTables) known.erase(known.begin());
  // A user of the table owns the solids, but perhaps other bounds of them, which another thread made.
  std::shared_ptr<const ClearanceTable> table(
      new ClearanceTable(a, b, joints),
      [kept = std::pair(a.bounds, b.bounds)](const ClearanceTable* old) { delete old; });
  known[key] = {a.solid, b.solid, table};
  return table;
}

}  // namespace mmgrasp::detail
