#include "collision/broad/cover_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "collision/narrow/solid.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/detail/triangle_distance.hpp"

namespace mmgrasp::detail {

namespace {

constexpr int kMaxCells = 64;
constexpr int kRounds = 48, kPartRounds = 16;  // spent on a sphere of the coarsest level, and of the others
// Inner spheres of larger meshes would take too long to find.
constexpr std::size_t kMaxTriangles = 20000;

using Points = std::vector<Eigen::Vector3d>;

// Sphere that holds all points: towards the farthest one again and again (Badoiu and Clarkson), then as large as
// needed.
std::pair<Eigen::Vector3d, double> small_sphere(const Points& points, int rounds) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  Eigen::Vector3d centre = box.center(), best = centre;
  double radius = kInfinity;
  for (int i = 2; i < rounds + 2; ++i) {
    throw_if_interrupted();
    const Eigen::Vector3d* farthest = &points.front();
    double squared = -1;
    for (const Eigen::Vector3d& p : points) {
      const double d = (p - centre).squaredNorm();
      if (d > squared) squared = d, farthest = &p;
    }
    if (std::sqrt(squared) < radius) radius = std::sqrt(squared), best = centre;
    centre += (*farthest - centre) / i;
  }
  return {best, radius};
}

// Cuts the polygon along sign * (x[axis] - at) <= 0.
void cut(Points& polygon, int axis, double at, double sign, Points& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - at), db = sign * (b[axis] - at);
    if (da <= 0) scratch.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      Eigen::Vector3d between = a + (b - a) * (da / (da - db));
      between[axis] = at;
      scratch.push_back(between);
    }
  }
  polygon.swap(scratch);
}

// Cells of a grid over the bounds, about as long as wide.
struct Grid {
  explicit Grid(const Eigen::AlignedBox3d& bounds) : low(bounds.min()) {
    const Eigen::Vector3d size = bounds.sizes();
    double target = std::max(0.5 * size.minCoeff(), 0.05 * size.maxCoeff());
    do {
      for (int k = 0; k < 3; ++k) count[k] = std::max(1, static_cast<int>(std::lround(size[k] / target)));
      target *= 1.1;
    } while (count[0] * count[1] * count[2] > kMaxCells);
    for (int k = 0; k < 3; ++k) step[k] = size[k] / count[k];
  }
  Grid cut(int parts) const {
    Grid out = *this;
    out.step /= parts;
    for (int& n : out.count) n *= parts;
    return out;
  }
  double plane(int axis, int i) const { return low[axis] + i * step[axis]; }

  Eigen::Vector3d low, step;
  std::array<int, 3> count{};
};

// Extreme points of the part of the body in each cell: where its surface is cut by the cell, and the cell's own corners
// within the body.
template <class Contains>
std::vector<Points> cell_points(const TriangleMesh& mesh, const Grid& grid, const Contains& contains) {
  const auto& n = grid.count;
  std::vector<Points> cells(n[0] * n[1] * n[2]);
  const auto cell = [&](int i, int j, int k) -> Points& { return cells[(i * n[1] + j) * n[2] + k]; };
  Points polygon, scratch;
  InterruptionPoll poll(256);
  for (const auto& t : mesh.triangles) {
    poll();
    Eigen::AlignedBox3d box;
    for (const int corner : t) box.extend(mesh.vertices[corner]);
    int first[3], last[3];
    for (int k = 0; k < 3; ++k) {
      const double step = grid.step[k] > 0 ? grid.step[k] : 1;
      // A triangle in a cell's face belongs to both sides.
      first[k] = std::clamp(static_cast<int>(std::floor((box.min()[k] - grid.low[k]) / step - 1e-9)), 0, n[k] - 1);
      last[k] = std::clamp(static_cast<int>(std::floor((box.max()[k] - grid.low[k]) / step + 1e-9)), 0, n[k] - 1);
    }
    for (int i = first[0]; i <= last[0]; ++i) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int k = first[2]; k <= last[2]; ++k) {
          polygon = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
          const int at[3] = {i, j, k};
          for (int axis = 0; axis < 3; ++axis) {
            // Outer cells are open outwards: rounding must not cut off what touches the bounds.
            if (at[axis] > 0) cut(polygon, axis, grid.plane(axis, at[axis]), -1, scratch);
            if (at[axis] + 1 < n[axis]) cut(polygon, axis, grid.plane(axis, at[axis] + 1), 1, scratch);
          }
          Points& points = cell(i, j, k);
          points.insert(points.end(), polygon.begin(), polygon.end());
        }
      }
    }
  }
  for (int i = 0; i <= n[0]; ++i) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int k = 0; k <= n[2]; ++k) {
        const Eigen::Vector3d corner(grid.plane(0, i), grid.plane(1, j), grid.plane(2, k));
        if (!contains(corner)) continue;
        for (int a = std::max(0, i - 1); a <= std::min(i, n[0] - 1); ++a) {
          for (int b = std::max(0, j - 1); b <= std::min(j, n[1] - 1); ++b) {
            for (int c = std::max(0, k - 1); c <= std::min(k, n[2] - 1); ++c) cell(a, b, c).push_back(corner);
          }
        }
      }
    }
  }
  return cells;
}

double surface_distance(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double best = kInfinity;
  for (const auto& t : mesh.triangles)
    best = std::min(best, triangle_distance(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return best;
}

// One sphere, no finer ones: the first of its parts on each level is itself, the other places below it stay empty.
void add_single(CoverLevels& levels, const Eigen::Vector3d& centre, double outer, double inner) {
  int places = 1;
  for (SphereCover& level : levels) {
    level.add(centre, outer, inner);
    for (int i = 1; i < places; ++i) level.add_far();
    places *= kLanes;
  }
}

// A cell of one level with all that lies in it, and its eight parts on the next.
template <class Depth>
class CellSpheres {
 public:
  CellSpheres(const std::vector<Points>& cells, const std::array<int, 3>& count, const Depth& depth,
              CoverLevels& levels)
      : cells_(cells), count_(count), depth_(depth), levels_(levels) {}

  // Adds cell (i, j, k) of the coarsest level, unless it is empty.
  void add(int i, int j, int k) {
    Points points;
    gather(0, i, j, k, points);
    if (points.empty()) return;
    const auto [centre, outer] = small_sphere(points, kRounds);
    add_parts(0, i, j, k, centre, outer, depth_(centre));
  }

 private:
  void gather(std::size_t level, int i, int j, int k, Points& out) const {
    if (level + 1 == levels_.size()) {
      const Points& own = cells_[(i * count_[1] + j) * count_[2] + k];
      out.insert(out.end(), own.begin(), own.end());
      return;
    }
    for (int c = 0; c < 8; ++c) gather(level + 1, 2 * i + (c & 1), 2 * j + (c >> 1 & 1), 2 * k + (c >> 2), out);
  }

  void add_parts(std::size_t level, int i, int j, int k, const Eigen::Vector3d& centre, double outer, double inner) {
    levels_[level].add(centre, outer, inner);
    if (level + 1 == levels_.size()) return;
    Points points;
    for (int c = 0; c < 8; ++c) {
      const int a = 2 * i + (c & 1), b = 2 * j + (c >> 1 & 1), d = 2 * k + (c >> 2);
      points.clear();
      gather(level + 1, a, b, d, points);
      if (points.empty()) {
        add_nothing(level + 1);
        continue;
      }
      const auto [part, radius] = small_sphere(points, kPartRounds);
      // Depth changes no faster than the place.
      add_parts(level + 1, a, b, d, part, radius, inner - (part - centre).norm());
    }
  }

  // Keeps the numbering: eight places on the next level for each sphere.
  void add_nothing(std::size_t level) {
    levels_[level].add_far();
    if (level + 1 == levels_.size()) return;
    for (int c = 0; c < 8; ++c) add_nothing(level + 1);
  }

  const std::vector<Points>& cells_;
  const std::array<int, 3>& count_;
  const Depth& depth_;
  CoverLevels& levels_;
};

template <class Contains, class Depth>
void cover_surface(const TriangleMesh& mesh, const Contains& contains, const Depth& depth, CoverLevels& levels) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& v : mesh.vertices) bounds.extend(v);
  const Grid grid(bounds), finest = grid.cut(1 << (levels.size() - 1));
  const std::vector<Points> cells = cell_points(mesh, finest, contains);
  CellSpheres<Depth> spheres(cells, finest.count, depth, levels);
  for (int i = 0; i < grid.count[0]; ++i) {
    for (int j = 0; j < grid.count[1]; ++j) {
      for (int k = 0; k < grid.count[2]; ++k) spheres.add(i, j, k);
    }
  }
}

// Half-spaces of a convex mesh, each with how far it may be off within the mesh's size: corners are known up to
// `rounding`, and a sliver's plane tilts the more the thinner it is.
struct Face {
  Eigen::Vector3d normal;
  double offset, slack;
};

std::vector<Face> faces_of(const TriangleMesh& mesh, double size, double rounding) {
  std::vector<Face> faces;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Eigen::Vector3d n = (b - a).cross(c - a);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const Eigen::Vector3d normal = n.normalized();
    faces.push_back({normal, normal.dot(a), rounding * (1 + size * longest / n.norm())});
  }
  return faces;
}

void cover_convex(const TriangleMesh& mesh, double size, CoverLevels& levels) {
  const double rounding = 1e-6 * size;
  const std::vector<Face> faces = faces_of(mesh, size, rounding);
  const auto depth = [&](const Eigen::Vector3d& p) {
    double least = kInfinity;
    for (const Face& face : faces) least = std::min(least, face.offset - face.normal.dot(p));
    return least - 3 * rounding;
  };
  const auto contains = [&](const Eigen::Vector3d& p) {
    return std::all_of(faces.begin(), faces.end(),
                       [&](const Face& face) { return face.normal.dot(p) <= face.offset + face.slack; });
  };
  cover_surface(mesh, contains, depth, levels);
}

void cover_box(const Eigen::Vector3d& size, CoverLevels& levels) {
  const Grid grid(Eigen::AlignedBox3d(-0.5 * size, 0.5 * size));
  const std::function<void(std::size_t, const Eigen::Vector3d&, const Eigen::Vector3d&)> add =
      [&](std::size_t level, const Eigen::Vector3d& centre, const Eigen::Vector3d& cell) {
        levels[level].add(centre, 0.5 * cell.norm(), (0.5 * size - centre.cwiseAbs()).minCoeff());
        if (level + 1 == levels.size()) return;
        for (int c = 0; c < 8; ++c) {
          const Eigen::Vector3d side((c & 1) - 0.5, (c >> 1 & 1) - 0.5, (c >> 2) - 0.5);
          add(level + 1, centre + 0.5 * cell.cwiseProduct(side), 0.5 * cell);
        }
      };
  for (int i = 0; i < grid.count[0]; ++i) {
    for (int j = 0; j < grid.count[1]; ++j) {
      for (int k = 0; k < grid.count[2]; ++k)
        add(0, grid.low + grid.step.cwiseProduct(Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5)), grid.step);
    }
  }
}

// The prism around the cylinder; depths are the cylinder's own.
void cover_cylinder(const Cylinder& cylinder, CoverLevels& levels) {
  constexpr int kSegments = 24;
  Cylinder around = cylinder;
  around.radius /= std::cos(kPi / kSegments);
  const auto mesh = shape_mesh(around, kSegments);
  const auto depth = [&](const Eigen::Vector3d& p) {
    return std::min(cylinder.radius - p.head<2>().norm(), 0.5 * cylinder.length - std::abs(p[2]));
  };
  // Within the circumscribed prism by a bound that holds for any phase of its corners.
  const auto contains = [&](const Eigen::Vector3d& p) {
    return p.head<2>().norm() <= around.radius && std::abs(p[2]) <= 0.5 * cylinder.length * kCoverGrowth;
  };
  cover_surface(*mesh, contains, depth, levels);
}

void cover_capsule(const Capsule& capsule, CoverLevels& levels) {
  const double half = 0.5 * capsule.length, r = capsule.radius;
  for (const double end : {-half, half}) add_single(levels, {0, 0, end}, r, r);
  const int slices = static_cast<int>(std::clamp(std::ceil(capsule.length / r), 1.0, 24.0));
  const double step = capsule.length / slices;
  for (int i = 0; i < slices; ++i) add_single(levels, {0, 0, -half + (i + 0.5) * step}, std::hypot(r, 0.5 * step), r);
}

}  // namespace

void cover_mesh(const TriangleMesh& mesh, const Solid& solid, CoverLevels& levels) {
  if (mesh.convex) return cover_convex(mesh, 2 * solid.box_half.norm(), levels);
  const auto nowhere = [](const Eigen::Vector3d&) { return false; };
  const auto no_depth = [](const Eigen::Vector3d&) { return -1.0; };
  if (!mesh.closed) return cover_surface(mesh, nowhere, no_depth, levels);
  const bool small = mesh.triangles.size() <= kMaxTriangles;
  const auto contains = [&](const Eigen::Vector3d& p) { return solid.contains(p); };
  const auto depth = [&](const Eigen::Vector3d& p) {
    return small && solid.contains(p) ? surface_distance(mesh, p) : -1.0;
  };
  cover_surface(mesh, contains, depth, levels);
}

void cover_primitive(const Shape& shape, CoverLevels& levels) {
  if (const auto* s = std::get_if<Sphere>(&shape)) add_single(levels, Eigen::Vector3d::Zero(), s->radius, s->radius);
  if (const auto* s = std::get_if<Capsule>(&shape)) cover_capsule(*s, levels);
  if (const auto* s = std::get_if<Cylinder>(&shape)) cover_cylinder(*s, levels);
  if (const auto* s = std::get_if<Box>(&shape)) cover_box(s->size, levels);
}

}  // namespace mmgrasp::detail
