#include "task/base_sequence/inscribed_circle.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

// Lengths in here are in cells: cell (ix, iy) is the square [ix, ix + 1] x [iy, iy + 1].
namespace mmgrasp {
namespace {

using Point = Eigen::Vector2d;

struct Box2 {
  double x0, x1, y0, y1;
  bool empty() const { return x0 > x1 || y0 > y1; }
  double size() const { return std::max(x1 - x0, y1 - y0); }
  Point middle() const { return {0.5 * (x0 + x1), 0.5 * (y0 + y1)}; }
  Point closest(const Point& p) const { return {std::clamp(p.x(), x0, x1), std::clamp(p.y(), y0, y1)}; }
};

struct Cell {
  int ix, iy;
};

double squared(double v) {
  return v * v;
}

double distance_to(const Cell& blocked, const Point& p) {
  const double dx = std::max({blocked.ix - p.x(), 0.0, p.x() - blocked.ix - 1});
  const double dy = std::max({blocked.iy - p.y(), 0.0, p.y() - blocked.iy - 1});
  return std::sqrt(dx * dx + dy * dy);
}

/// Largest distance from a point of the box to the blocked cell.
double farthest(const Cell& blocked, const Box2& box) {
  const double dx = std::max({blocked.ix - box.x0, 0.0, box.x1 - blocked.ix - 1});
  const double dy = std::max({blocked.iy - box.y0, 0.0, box.y1 - blocked.iy - 1});
  return std::sqrt(dx * dx + dy * dy);
}

/// One cell of the region with what limits a disc centred in it.
struct Room {
  Cell cell;
  double at_centre = 0;          // distance from its middle to the complement
  double left, right, down, up;  // free interval through the cell along its row and its column
  std::vector<Cell> blocked;     // complement cells that are nearest to some point of the cell
};

/// Branch and bound for the largest disc in a union of cells: squares of centres are split, the most promising first.
class DiscSearch {
 public:
  DiscSearch(int nx, int ny, const std::vector<std::uint8_t>& cells) : nx_(nx), ny_(ny), cells_(cells) {}

  /// Largest radius, and of all centres with it (to `tolerance`) the one nearest to the centroid.
  InscribedCircle run(double tolerance) {
    collect();
    InscribedCircle circle;
    if (rooms_.empty()) return circle;
    tolerance_ = tolerance;
    maximise();
    circle.centre = nearest_centre();
    circle.radius = radius_at(circle.centre);
    return circle;
  }

 private:
  bool free(int ix, int iy) const {
    return ix >= 0 && iy >= 0 && ix < nx_ && iy < ny_ && cells_[static_cast<std::size_t>(iy) * nx_ + ix];
  }

  void collect() {
    const std::vector<double> room_at = squared_distances();
    double best = 0;
    std::size_t count = 0;
    for (int iy = 0; iy < ny_; ++iy) {
      for (int ix = 0; ix < nx_; ++ix) {
        if (!free(ix, iy)) continue;
        best = std::max(best, room_at[static_cast<std::size_t>(iy) * nx_ + ix]);
        centroid_ += Point(ix + 0.5, iy + 0.5);
        ++count;
      }
    }
    if (count == 0) return;
    centroid_ /= static_cast<double>(count);
    best_ = std::sqrt(best);
    std::vector<Cell> border;
    for (int iy = -1; iy <= ny_; ++iy) {
      for (int ix = -1; ix <= nx_; ++ix) {
        if (!free(ix, iy) && beside_region(ix, iy)) border.push_back({ix, iy});
      }
    }
    // A radius changes no faster than its centre moves, and no point of a cell is farther than 1/sqrt(2) from its
    // middle.
    const double least = squared(std::max(best_ - std::sqrt(0.5) - 1e-9, 0.0));
    for (int iy = 0; iy < ny_; ++iy) {
      for (int ix = 0; ix < nx_; ++ix) {
        const double squared_room = room_at[static_cast<std::size_t>(iy) * nx_ + ix];
        if (free(ix, iy) && squared_room >= least) rooms_.push_back(make_room({ix, iy}, squared_room, border));
      }
    }
  }

  bool beside_region(int ix, int iy) const {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (free(ix + dx, iy + dy)) return true;
      }
    }
    return false;
  }

  /// Squared distance from the middle of each cell of the region to the nearest cell of the complement: along rows
  /// first, then the least over the rows.
  std::vector<double> squared_distances() const {
    const auto gap = [](int steps) { return squared(std::max(steps - 0.5, 0.0)); };
    std::vector<int> along(cells_.size());  // steps within the row
    for (int iy = 0; iy < ny_; ++iy) {
      detail::throw_if_interrupted();
      int* row = along.data() + static_cast<std::ptrdiff_t>(iy) * nx_;
      for (int ix = 0, steps = 0; ix < nx_; ++ix) row[ix] = steps = free(ix, iy) ? steps + 1 : 0;
      for (int ix = nx_ - 1, steps = 0; ix >= 0; --ix)
        row[ix] = std::min(row[ix], steps = free(ix, iy) ? steps + 1 : 0);
    }
    detail::InterruptionPoll poll(256);
    std::vector<double> distances(cells_.size(), 0);
    for (int iy = 0; iy < ny_; ++iy) {
      for (int ix = 0; ix < nx_; ++ix) {
        if (!free(ix, iy)) continue;
        poll();
        double least = gap(along[static_cast<std::size_t>(iy) * nx_ + ix]);
        for (int steps = 1; gap(steps) < least; ++steps) {
          for (const int y : {iy - steps, iy + steps}) {
            const int other = y < 0 || y >= ny_ ? 0 : along[static_cast<std::size_t>(y) * nx_ + ix];
            least = std::min(least, gap(other) + gap(steps));
          }
        }
        distances[static_cast<std::size_t>(iy) * nx_ + ix] = least;
      }
    }
    return distances;
  }

  Room make_room(const Cell& cell, double squared_room, const std::vector<Cell>& border) const {
    detail::throw_if_interrupted();
    Room room;
    room.cell = cell;
    room.at_centre = std::sqrt(squared_room);
    // Any point of the cell is within 1/sqrt(2) of its middle, so farther cells are never the nearest.
    const double bound = squared(room.at_centre + std::sqrt(2.0) + 1e-9);
    for (const Cell& b : border) {
      const double d = squared(std::max(std::abs(b.ix - cell.ix) - 0.5, 0.0)) +
                       squared(std::max(std::abs(b.iy - cell.iy) - 0.5, 0.0));
      if (d <= bound) room.blocked.push_back(b);
    }
    int ix = cell.ix, iy = cell.iy;
    while (free(ix - 1, cell.iy)) --ix;
    room.left = ix;
    for (ix = cell.ix; free(ix + 1, cell.iy);) ++ix;
    room.right = ix + 1;
    while (free(cell.ix, iy - 1)) --iy;
    room.down = iy;
    for (iy = cell.iy; free(cell.ix, iy + 1);) ++iy;
    room.up = iy + 1;
    return room;
  }

  static double radius_in(const Room& room, const Point& p) {
    double least = detail::kInfinity;
    for (const Cell& b : room.blocked) least = std::min(least, distance_to(b, p));
    return least;
  }

  double radius_at(const Point& p) const {
    double best = 0;
    for (const Room& room : rooms_) {
      if (p.x() < room.cell.ix || p.x() > room.cell.ix + 1 || p.y() < room.cell.iy || p.y() > room.cell.iy + 1)
        continue;
      best = std::max(best, radius_in(room, p));
    }
    return best;
  }

  /// What is left of the box for centres of discs of radius r. The walls at the ends of the cell's own row and column
  /// span the whole box, so they cut straight: this ends the search along corridors, where a continuum of centres is
  /// equally good.
  static Box2 cut(const Room& room, Box2 box, double r) {
    box.x0 = std::max(box.x0, room.left + r);
    box.x1 = std::min(box.x1, room.right - r);
    box.y0 = std::max(box.y0, room.down + r);
    box.y1 = std::min(box.y1, room.up - r);
    return box;
  }

  static bool ruled_out(const Room& room, const Box2& box, double r) {
    for (const Cell& b : room.blocked) {
      if (farthest(b, box) < r) return true;
    }
    return false;
  }

  static Box2 whole(const Room& room) {
    return {double(room.cell.ix), room.cell.ix + 1.0, double(room.cell.iy), room.cell.iy + 1.0};
  }

  static void split(const Box2& box, Box2 (&parts)[2]) {
    parts[0] = parts[1] = box;
    const Point m = box.middle();
    if (box.x1 - box.x0 >= box.y1 - box.y0) {
      parts[0].x1 = parts[1].x0 = m.x();
    } else {
      parts[0].y1 = parts[1].y0 = m.y();
    }
  }

  struct Node {
    double key;
    std::size_t order;  // equal keys: first in, first out
    int room;
    Box2 box;
    bool operator<(const Node& other) const { return key != other.key ? key < other.key : order > other.order; }
  };

  /// Best first: the key bounds the radius in the box from above.
  void maximise() {
    std::priority_queue<Node> queue;
    std::size_t order = 0;
    for (const Room& room : rooms_) {
      best_ = std::max(best_, room.at_centre);
      best_ = std::max(best_, radius_in(room, Point(room.cell.ix, room.cell.iy)));
    }
    const auto push = [&](int index, Box2 box) {
      const Room& room = rooms_[index];
      const double wanted = best_ + tolerance_;
      box = cut(room, box, wanted);
      if (box.empty() || ruled_out(room, box, wanted)) return;
      const Point m = box.middle();
      const double r = radius_in(room, m);
      best_ = std::max(best_, r);
      const double bound = r + 0.5 * std::hypot(box.x1 - box.x0, box.y1 - box.y0);
      if (bound > best_ + tolerance_) queue.push({bound, order++, index, box});
    };
    for (int i = 0; i < static_cast<int>(rooms_.size()); ++i) push(i, whole(rooms_[i]));
    detail::InterruptionPoll poll(64);
    while (!queue.empty()) {
      poll();
      const Node node = queue.top();
      queue.pop();
      if (node.key <= best_ + tolerance_) break;
      Box2 parts[2];
      split(node.box, parts);
      for (const Box2& part : parts) push(node.room, part);
    }
  }

  /// Best first on the distance to the centroid, over centres whose radius is the best one less twice the tolerance.
  Point nearest_centre() const {
    const double wanted = best_ - 2 * tolerance_;
    const double enough =
        wanted - 0.01 * tolerance_;  // less than what is cut away, or roundings could keep boxes forever
    std::priority_queue<Node> queue;
    std::size_t order = 0;
    const auto push = [&](int index, Box2 box) {
      const Room& room = rooms_[index];
      box = cut(room, box, wanted);
      if (box.empty() || ruled_out(room, box, wanted)) return;
      const Point m = box.middle();
      if (radius_in(room, m) + 0.5 * std::hypot(box.x1 - box.x0, box.y1 - box.y0) < wanted) return;
      queue.push({-(box.closest(centroid_) - centroid_).norm(), order++, index, box});
    };
    for (int i = 0; i < static_cast<int>(rooms_.size()); ++i) push(i, whole(rooms_[i]));
    detail::InterruptionPoll poll(64);
    while (!queue.empty()) {
      poll();
      const Node node = queue.top();
      queue.pop();
      const Room& room = rooms_[node.room];
      for (const Point& p : {node.box.closest(centroid_), node.box.middle()}) {
        if (radius_in(room, p) < enough) continue;
        // The middle is not the nearest point of the box; a box this small makes no difference.
        if (p == node.box.closest(centroid_) || node.box.size() < tolerance_) return p;
      }
      Box2 parts[2];
      split(node.box, parts);
      for (const Box2& part : parts) push(node.room, part);
    }
    return centroid_;  // not reached: the best centre found is never cut away
  }

  int nx_, ny_;
  const std::vector<std::uint8_t>& cells_;
  std::vector<Room> rooms_;
  Point centroid_ = Point::Zero();
  double best_ = 0;
  double tolerance_ = 0;
};

}  // namespace

namespace detail {

InscribedCircle inscribed_circle_in_cells(int nx, int ny, const std::vector<std::uint8_t>& cells, double tolerance) {
  if (nx <= 0 || ny <= 0) return {};
  return DiscSearch(nx, ny, cells).run(tolerance);
}

}  // namespace detail

InscribedCircle inscribed_circle(const BaseGrid& grid, const CellMask& cells, int heading) {
  // The search needs only the rows and columns that hold cells.
  int x0 = grid.nx, x1 = -1, y0 = grid.ny, y1 = -1;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      if (!cells[grid.index(heading, ix, iy)]) continue;
      x0 = std::min(x0, ix);
      x1 = std::max(x1, ix);
      y0 = std::min(y0, iy);
      y1 = std::max(y1, iy);
    }
  }
  if (x1 < x0) return {};
  const int nx = x1 - x0 + 1, ny = y1 - y0 + 1;
  std::vector<std::uint8_t> part(static_cast<std::size_t>(nx) * ny);
  for (int iy = 0; iy < ny; ++iy) {
    for (int ix = 0; ix < nx; ++ix) {
      part[static_cast<std::size_t>(iy) * nx + ix] = cells[grid.index(heading, x0 + ix, y0 + iy)] ? 1 : 0;
    }
  }
  InscribedCircle circle = detail::inscribed_circle_in_cells(nx, ny, part, detail::kCircleError / grid.resolution);
  circle.radius *= grid.resolution;
  circle.centre = grid.origin + (circle.centre + Eigen::Vector2d(x0, y0)) * grid.resolution;
  return circle;
}

}  // namespace mmgrasp
