#include "mapping/segmentation/supporting_plane.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/pcl_segmentation.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
/// Fewer thinned points make no plane that supports anything.
constexpr std::size_t kFewestPoints = 10;
/// Cosine of the angle between a plane's normal and that of a surface which is part of it.
constexpr double kAlongPlane = 0.7;
/// Smaller pieces, by their share of all cells, are not the table.
constexpr double kSmallPiece = 0.05;

/// Cells that hang together over cells for which `belongs`: the piece of each, or -1, and the pieces' sizes.
struct Pieces {
  std::vector<int> piece_of, size;
};

Pieces pieces_of(const SurfaceCells& cells, const std::vector<char>& belongs) {
  Pieces out;
  out.piece_of.assign(cells.size(), -1);
  std::vector<int> stack;
  for (int start = 0; start < cells.size(); ++start) {
    if (!belongs[start] || out.piece_of[start] >= 0) continue;
    const int piece = static_cast<int>(out.size.size());
    out.size.push_back(0);
    out.piece_of[start] = piece;
    stack.assign(1, start);
    while (!stack.empty()) {
      const int c = stack.back();
      stack.pop_back();
      ++out.size[piece];
      for (int k = cells.first_neighbour[c]; k < cells.first_neighbour[c + 1]; ++k) {
        const int next = cells.neighbours[k];
        if (!belongs[next] || out.piece_of[next] >= 0) continue;
        out.piece_of[next] = piece;
        stack.push_back(next);
      }
    }
  }
  return out;
}

/// Positive where `plane`'s normal points up.
double upwards(const FoundPlane& plane, const SurfaceCells& cells, const ObjectSegmentationOptions& options,
               const Vector3d& eye) {
  if (!options.up.isZero()) return plane.normal.dot(options.up);
  if (cells.normal.empty()) return plane.normal.dot(eye) - plane.offset;
  double sum = 0;
  for (int c = 0; c < cells.size(); ++c) {
    const double height = plane.normal.dot(cells.position[c]) - plane.offset;
    if (std::abs(height) <= options.plane_tolerance) sum += plane.normal.dot(cells.normal[c]);
  }
  return sum;
}

/// `found` with its normal upwards, or nothing when most other cells lie below it.
std::optional<SupportingPlane> supporting(const FoundPlane& found, const SurfaceCells& cells,
                                          const ObjectSegmentationOptions& options, const Vector3d& eye) {
  const double sign = upwards(found, cells, options, eye) < 0 ? -1 : 1;
  const SupportingPlane plane{sign * found.normal, sign * found.offset};
  std::ptrdiff_t above = 0, below = 0;
  for (const Vector3d& p : cells.position) {
    const double height = plane.normal.dot(p) - plane.offset;
    above += height > options.plane_tolerance;
    below += height < -options.plane_tolerance;
  }
  return above >= below ? std::make_optional(plane) : std::nullopt;
}

}  // namespace

std::optional<SupportingPlane> find_supporting_plane(const SurfaceCells& cells,
                                                     const ObjectSegmentationOptions& options, const Vector3d& eye) {
  std::vector<Vector3d> rest = cells.position;
  while (rest.size() >= kFewestPoints) {
    const FoundPlane found =
        dominant_plane(rest, options.plane_tolerance, options.plane_iterations, options.up, options.up_angle);
    if (!found.found || found.inliers.size() < options.min_plane_share * cells.size()) return std::nullopt;
    if (const auto plane = supporting(found, cells, options, eye)) return plane;
    std::vector<char> taken(rest.size(), 0);
    for (const int i : found.inliers) taken[i] = 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (!taken[i]) rest[kept++] = rest[i];
    }
    rest.resize(kept);
  }
  return std::nullopt;
}

std::vector<Vector3d> surface_of_plane(const std::vector<Vector3d>& inliers, const SupportingPlane& plane,
                                       double cell) {
  SurfaceCells cells = surface_cells(inliers, cell);
  fit_normals(inliers, Vector3d::Zero(), cells);
  std::vector<char> along(cells.size());
  for (int c = 0; c < cells.size(); ++c) along[c] = std::abs(cells.normal[c].dot(plane.normal)) >= kAlongPlane;
  const Pieces pieces = pieces_of(cells, along);
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    const int piece = pieces.piece_of[cells.cell_of[i]];
    if (piece >= 0 && pieces.size[piece] >= kSmallPiece * cells.size()) out.push_back(inliers[i]);
  }
  return out;
}

}  // namespace mmgrasp::detail
