// OctoMap behind OccupancyMap: the public header shows nothing of it.
#include "mmgrasp/mapping/occupancy_map.hpp"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "mapping/sdf/frame_checks.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/octree.hpp"

namespace mmgrasp {
namespace {

constexpr int kDepth = 16, kHalf = 1 << (kDepth - 1);  // OctoMap's trees: levels, cells on either side of the origin

constexpr double kFinest = 1e-4, kCoarsest = 1e3;  // edge of a cell [m]

using Leaves = std::map<double, std::vector<Eigen::Vector3d>>;  // by edge length

std::vector<Voxels> voxels_of(Leaves leaves) {
  std::vector<Voxels> out;
  for (auto& [edge, centres] : leaves) {
    out.push_back({std::make_shared<const std::vector<Eigen::Vector3d>>(std::move(centres)), edge});
  }
  return out;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Smallest cells from the tree's corner, first and last along each axis.
struct KeyRange {
  int first[3], last[3];

  KeyRange(const Eigen::AlignedBox3d& bounds, double resolution) {
    for (int k = 0; k < 3; ++k) {
      // A bound that lies on the lattice but for rounding takes no further cell.
      const double low = std::floor(bounds.min()[k] / resolution + 1e-6) + kHalf,
                   high = std::ceil(bounds.max()[k] / resolution - 1e-6) + kHalf - 1;
      require(low >= 0 && high < 2 * kHalf, "bounds", low < 0 ? bounds.min()[k] : bounds.max()[k],
              "must lie within 32767 cells of the origin [m]");
      first[k] = static_cast<int>(low);
      last[k] = std::max(first[k], static_cast<int>(high));
    }
  }
};

/// A cube of the octree: `edge` smallest cells long.
struct Cube {
  int low[3];
  int edge;

  Cube child(int i) const {
    const int half = edge / 2;
    return {{low[0] + (i & 1) * half, low[1] + (i >> 1 & 1) * half, low[2] + (i >> 2 & 1) * half}, half};
  }
};

/// Unknown cells within a range of keys, as large as they can be.
class UnknownCells {
 public:
  UnknownCells(const octomap::OcTree& tree, const KeyRange& range, Leaves& leaves)
      : tree_(tree), range_(range), leaves_(leaves) {}

  void run() { visit(tree_.getRoot(), {{0, 0, 0}, 2 * kHalf}); }

 private:
  void visit(const octomap::OcTreeNode* node, const Cube& cube) {
    bool whole = true;
    for (int k = 0; k < 3; ++k) {
      const int last = cube.low[k] + cube.edge - 1;
      if (last < range_.first[k] || cube.low[k] > range_.last[k]) return;
      whole = whole && cube.low[k] >= range_.first[k] && last <= range_.last[k];
    }
    if (node && !tree_.nodeHasChildren(node)) return;
    if (!node && whole) {
      const double edge = cube.edge * tree_.getResolution();
      const Eigen::Vector3d low(cube.low[0] - kHalf, cube.low[1] - kHalf, cube.low[2] - kHalf);
      leaves_[edge].push_back(tree_.getResolution() * (low + Eigen::Vector3d::Constant(0.5 * cube.edge)));
      return;
    }
    for (int i = 0; i < 8; ++i) {
      const octomap::OcTreeNode* const child = node && tree_.nodeChildExists(node, static_cast<unsigned>(i))
                                                   ? tree_.getNodeChild(node, static_cast<unsigned>(i))
                                                   : nullptr;
      visit(child, cube.child(i));
    }
  }

  const octomap::OcTree& tree_;
  const KeyRange& range_;
  Leaves& leaves_;
};

/// Adds a frame as octomap's insertPointCloud() does, with one ray for each cell that holds a pixel, but piece by
/// piece: all cells are known, and Ctrl-C was heard, before the first one changes.
void cast(octomap::OcTree& tree, const octomap::Pointcloud& ends, const octomap::point3d& eye, double longest) {
  constexpr std::size_t kPiece = 500;  // rays, of up to some thousand cells each
  octomap::KeySet hit, free, occupied;
  octomap::Pointcloud piece;
  const auto cast_piece = [&] {
    detail::throw_if_interrupted();
    tree.computeUpdate(piece, eye, free, occupied, longest);
    piece.clear();
  };
  detail::InterruptionPoll poll;
  for (const octomap::point3d& end : ends) {
    poll();
    const octomap::OcTreeKey key = tree.coordToKey(end);
    if (!hit.insert(key).second) continue;
    piece.push_back(tree.keyToCoord(key));
    if (piece.size() == kPiece) cast_piece();
  }
  cast_piece();
  detail::throw_if_interrupted();
  for (const octomap::OcTreeKey& key : free)
    if (occupied.count(key) == 0) tree.updateNode(key, false, true);
  for (const octomap::OcTreeKey& key : occupied) tree.updateNode(key, true, true);
}

}  // namespace

struct OccupancyMap::Impl {
  explicit Impl(const OccupancyOptions& chosen) : options(chosen), tree(chosen.resolution) {
    tree.setProbHit(chosen.hit);
    tree.setProbMiss(chosen.miss);
  }

  OccupancyOptions options;
  octomap::OcTree tree;
  int frames = 0;
};

void OccupancyOptions::check() const {
  require(resolution >= kFinest && resolution <= kCoarsest, "resolution", resolution, "must be in [1e-4, 1e3] m");
  require(hit > 0.5 && hit < 1, "hit", hit, "must be above 0.5 and below 1");
  require(miss > 0 && miss < 0.5, "miss", miss, "must be above 0 and below 0.5");
  require(max_range > 0, "max_range", max_range, "must be positive [m]");
}

void OccupancyObstacleOptions::check() const {
  if (bounds.isEmpty()) return;  // none
  require_numbers(bounds.min(), "bounds[0]", "m");
  require_numbers(bounds.max(), "bounds[1]", "m");
}

OccupancyMap::OccupancyMap(const OccupancyOptions& options) {
  options.check();
  impl_ = std::make_shared<Impl>(options);
}

const OccupancyOptions& OccupancyMap::options() const {
  return impl_->options;
}

OccupancyReport OccupancyMap::integrate(const DepthImage& image, const DepthCamera& camera) {
  detail::check_frame(image, camera, {});
  DepthImage frame = image;
  frame.camera = camera.intrinsics;
  OccupancyReport report;
  frame.clean();
  report.invalid = frame.invalid;
  detail::check_depths(frame);
  const Eigen::Vector3d eye = frame.T_world_camera.translation();
  const double range = (kHalf - 1) * impl_->options.resolution;
  double farthest = eye.cwiseAbs().maxCoeff();
  octomap::Pointcloud ends;
  for (int v = 0; v < frame.camera.height; ++v) {
    detail::throw_if_interrupted();
    for (int u = 0; u < frame.camera.width; ++u) {
      const float z = frame.at(u, v);
      if (!(z > 0)) continue;
      ++report.measured;
      if (z < frame.camera.nearest || z > frame.camera.farthest) {
        ++report.out_of_range;
        continue;
      }
      const Eigen::Vector3d end = frame.point(u, v);
      farthest = std::max(farthest, end.cwiseAbs().maxCoeff());
      ends.push_back(static_cast<float>(end.x()), static_cast<float>(end.y()), static_cast<float>(end.z()));
      ++report.used;
    }
  }
  require(farthest < range, "resolution", impl_->options.resolution,
          "is too small for a frame that reaches " + std::to_string(farthest) +
              " m from the origin: an octree ends after 32767 cells");
  // Copies of this map keep what they had.
  if (impl_.use_count() > 1) impl_ = std::make_shared<Impl>(*impl_);
  const double longest = std::isfinite(impl_->options.max_range) ? impl_->options.max_range : -1;
  const octomap::point3d origin(static_cast<float>(eye.x()), static_cast<float>(eye.y()), static_cast<float>(eye.z()));
  cast(impl_->tree, ends, origin, longest);
  impl_->tree.updateInnerOccupancy();
  impl_->tree.prune();
  ++impl_->frames;
  return report;
}

std::vector<Occupancy> OccupancyMap::states(const Eigen::Matrix3Xd& points) const {
  require_positions(points, "point");
  std::vector<Occupancy> out;
  out.reserve(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d cell = (points.col(i) / impl_->options.resolution).array().floor() + kHalf;
    const bool inside = (cell.array() >= 0).all() && (cell.array() < 2 * kHalf).all();
    const octomap::OcTreeNode* node = nullptr;
    if (inside && impl_->tree.getRoot()) {
      const auto key = [&](int k) { return static_cast<octomap::key_type>(cell[k]); };
      node = impl_->tree.search(octomap::OcTreeKey(key(0), key(1), key(2)));
    }
    out.push_back(!node                               ? Occupancy::unknown
                  : impl_->tree.isNodeOccupied(*node) ? Occupancy::occupied
                                                      : Occupancy::free);
  }
  return out;
}

std::vector<Voxels> OccupancyMap::obstacle_cells(const OccupancyObstacleOptions& options) const {
  options.check();
  Leaves leaves;
  for (auto leaf = impl_->tree.begin_leafs(), end = impl_->tree.end_leafs(); leaf != end; ++leaf) {
    if (impl_->tree.isNodeOccupied(*leaf)) leaves[leaf.getSize()].emplace_back(leaf.getX(), leaf.getY(), leaf.getZ());
  }
  const Eigen::AlignedBox3d within = options.bounds.isEmpty() ? bounds() : options.bounds;
  if (!options.unknown_is_free && !within.isEmpty()) {
    UnknownCells(impl_->tree, KeyRange(within, impl_->options.resolution), leaves).run();
  }
  return voxels_of(std::move(leaves));
}

int OccupancyMap::frames() const {
  return impl_->frames;
}

std::size_t OccupancyMap::cells() const {
  return impl_->tree.getNumLeafNodes();
}

std::size_t OccupancyMap::memory() const {
  return impl_->tree.memoryUsage();
}

Eigen::AlignedBox3d OccupancyMap::bounds() const {
  Eigen::AlignedBox3d box;
  for (auto leaf = impl_->tree.begin_leafs(), end = impl_->tree.end_leafs(); leaf != end; ++leaf) {
    const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * leaf.getSize());
    box.extend(Eigen::AlignedBox3d(Eigen::Vector3d(centre - half), Eigen::Vector3d(centre + half)));
  }
  return box;
}

void OccupancyMap::save(const std::string& path) const {
  const bool binary = ends_with(path, ".bt");
  if (!binary && !ends_with(path, ".ot")) {
    throw IoError("octree file '" + path + "': its name must end in .bt or .ot");
  }
  // OctoMap's own writers and readers of whole files talk to the terminal.
  octomap::OcTree tree = impl_->tree;
  std::ostringstream data;
  if (binary) {
    tree.toMaxLikelihood();
    tree.prune();
    if (tree.getRoot()) tree.writeBinaryNode(data, tree.getRoot());
  } else {
    tree.writeData(data);
  }
  std::ostringstream head;
  head << (binary ? "# Octomap OcTree binary file\n" : "# Octomap OcTree file\n") << "id OcTree\nsize " << tree.size()
       << "\nres " << std::setprecision(17) << tree.getResolution() << "\ndata\n";
  detail::write_file(path, "octree file", {head.str(), data.str()});
}

OccupancyMap OccupancyMap::load(const std::string& path, OccupancyOptions options) {
  const OctreeFile file = read_octree_file(path);
  if (!(file.resolution >= kFinest && file.resolution <= kCoarsest)) {
    std::ostringstream text;
    text << "octree file '" << path << "': res = " << file.resolution << ": must be in [1e-4, 1e3] m";
    throw IoError(text.str());
  }
  options.resolution = file.resolution;
  OccupancyMap out(options);
  if (file.nodes == 0) return out;
  // OctoMap's readers trust what they read; here it has been checked.
  std::istringstream data(file.content.substr(file.data));
  file.binary ? out.impl_->tree.readBinaryData(data) : out.impl_->tree.readData(data);
  return out;
}

}  // namespace mmgrasp
