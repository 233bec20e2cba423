#include "mapping/sdf/integrate.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/sdf/frame_checks.hpp"
#include "mapping/sdf/frame_planes.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kBlocksOfItem = 16;
constexpr int kTile = 8;  // pixels along the edge of a tile of the coarse image

/// A block that this frame may change.
struct WorkBlock {
  BlockKey key;
  int block = -1;                     // in the grid; -1: new
  std::unique_ptr<VoxelBlock> fresh;  // where the grid has no voxels of this layer yet
  VoxelBlock* voxels = nullptr;
  bool touched = false;
  int contradicted = 0;  // voxels at which the gate shut
};

/// The depths at which a block is surely free, or surely hidden, by tiles.
class CoarseImage {
 public:
  CoarseImage(const FramePlanes& frame, const PinholeCamera& camera) : camera_(camera) {
    columns_ = (camera.width + kTile - 1) / kTile;
    rows_ = (camera.height + kTile - 1) / kTile;
    tiles_.resize(static_cast<std::size_t>(columns_) * rows_);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
        Tile& tile = tiles_[static_cast<std::size_t>(v / kTile) * columns_ + u / kTile];
        tile.all_free_until = std::min(tile.all_free_until, frame.planes[i].free_depth);
        tile.some_free_until = std::max(tile.some_free_until, frame.planes[i].free_depth);
        if (frame.bands[i].far < frame.bands[i].near) continue;
        tile.nearest = std::min(tile.nearest, frame.bands[i].near);
        tile.farthest = std::max(tile.farthest, frame.bands[i].far);
      }
    }
  }

  /// Whether a sphere may meet the band around a surface.
  bool meets_surface(const Vector3d& centre, double radius) const {
    const double nearest = centre.z() - radius;
    if (nearest <= camera_.nearest) return centre.z() + radius > camera_.nearest;
    const double x = centre.x() / centre.z(), y = centre.y() / centre.z();
    const double spread = radius / nearest * (1 + std::max(std::abs(x), std::abs(y)));
    const int row0 = tile(camera_.cy + camera_.fy * (y - spread), rows_),
              row1 = tile(camera_.cy + camera_.fy * (y + spread), rows_);
    const int column0 = tile(camera_.cx + camera_.fx * (x - spread), columns_),
              column1 = tile(camera_.cx + camera_.fx * (x + spread), columns_);
    for (int row = row0; row <= row1; ++row) {
      for (int column = column0; column <= column1; ++column) {
        const Tile& each = tiles_[static_cast<std::size_t>(row) * columns_ + column];
        if (nearest <= each.farthest && centre.z() + radius >= each.nearest) return true;
      }
    }
    return false;
  }

  enum class View { free, hidden, mixed };
  /// A sphere around `centre` in the camera's frame, apart from surfaces of this frame.
  View view(const Vector3d& centre, double radius) const {
    const double nearest = centre.z() - radius;
    if (centre.z() + radius <= camera_.nearest) return View::hidden;
    if (nearest <= camera_.nearest) return View::mixed;
    // Projections of the sphere lie within this of its centre's.
    const double x = centre.x() / centre.z(), y = centre.y() / centre.z();
    const double spread = radius / nearest * (1 + std::max(std::abs(x), std::abs(y)));
    const double u0 = camera_.cx + camera_.fx * (x - spread), u1 = camera_.cx + camera_.fx * (x + spread);
    const double v0 = camera_.cy + camera_.fy * (y - spread), v1 = camera_.cy + camera_.fy * (y + spread);
    if (u1 < -0.5 || v1 < -0.5 || u0 > camera_.width - 0.5 || v0 > camera_.height - 0.5) return View::hidden;
    const bool inside = u0 >= 0 && v0 >= 0 && u1 <= camera_.width - 1 && v1 <= camera_.height - 1;
    float all = static_cast<float>(kInfinity), some = -1;
    for (int row = tile(v0, rows_); row <= tile(v1, rows_); ++row) {
      for (int column = tile(u0, columns_); column <= tile(u1, columns_); ++column) {
        const Tile& each = tiles_[static_cast<std::size_t>(row) * columns_ + column];
        all = std::min(all, each.all_free_until);
        some = std::max(some, each.some_free_until);
      }
    }
    if (nearest > some) return View::hidden;
    return inside && centre.z() + radius < all ? View::free : View::mixed;
  }

 private:
  struct Tile {
    float all_free_until = static_cast<float>(kInfinity), some_free_until = -1;
    float nearest = static_cast<float>(kInfinity), farthest = -1;  // of the bands around surfaces
  };
  static int tile(double pixel, int count) {
    return std::clamp(static_cast<int>(std::clamp(pixel + 0.5, 0.0, 1e6)) / kTile, 0, count - 1);
  }

  const PinholeCamera& camera_;
  int columns_ = 0, rows_ = 0;
  std::vector<Tile> tiles_;
};

/// Puts one frame into the map: finds the blocks near its surface, makes room for them, updates their voxels.
class FrameIntegration {
 public:
  FrameIntegration(SdfGrid& grid, const DepthImage& image, const DepthCamera& camera, const FramePlanes& frame)
      : grid_(grid),
        image_(image),
        camera_(camera),
        frame_(frame),
        block_(kBlockSide * grid.options.voxel),
        coarse_(frame, image.camera) {
    T_camera_world_ = image.T_world_camera.inverse(Eigen::Isometry);
    layer_ = grid_.find_layer(camera_);
  }

  /// Blocks near this frame's surface. Throws InvalidInput when they do not fit.
  void collect() {
    const double footprint = frame_.median_depth / image_.camera.fx;
    const int stride = std::clamp(static_cast<int>(0.5 * block_ / footprint), 1, 16);
    const int columns = (image_.camera.width + stride - 1) / stride,
              rows = (image_.camera.height + stride - 1) / stride;
    std::vector<Eigen::AlignedBox3d> boxes(static_cast<std::size_t>(columns) * rows);
    parallel_for(rows, grid_.options.threads, [&](std::size_t row, int) {
      for (int column = 0; column < columns; ++column) {
        boxes[row * columns + column] = tile_box(column * stride, static_cast<int>(row) * stride, stride);
      }
    });
    for (const Eigen::AlignedBox3d& box : boxes) {
      if (!box.isEmpty()) add_box(box);
    }
    check_memory();
    for (WorkBlock& work : work_) {
      if (work.block >= 0 && layer_ < static_cast<int>(grid_.layers.size())) {
        work.voxels = grid_.layers[layer_][work.block].get();
      }
    }
  }

  /// Other blocks of the grid that this frame looks through, in all layers.
  void collect_free() {
    for (int block = 0; block < static_cast<int>(grid_.keys.size()); ++block) {
      if (candidates_.find(grid_.keys[block].packed()) == 1) continue;
      switch (coarse_.view(centre_of(grid_.keys[block]), radius())) {
        case CoarseImage::View::hidden:
          break;
        case CoarseImage::View::free:
          free_.push_back(block);
          break;
        case CoarseImage::View::mixed:
          mixed_.push_back(block);
          break;
      }
    }
  }

  void run() {
    const KernelFrame kernel = kernel_frame();
    const int threads = grid_.options.threads;
    const auto items = [](std::size_t count) { return (count + kBlocksOfItem - 1) / kBlocksOfItem; };
    // New blocks are tried on a spare one: most candidates turn out to lie beside the surface.
    std::vector<std::unique_ptr<VoxelBlock>> spare(resolve_threads(threads));
    parallel_for(items(work_.size()), threads, [&](std::size_t item, int worker) {
      const std::size_t last = std::min(work_.size(), (item + 1) * kBlocksOfItem);
      for (std::size_t i = item * kBlocksOfItem; i < last; ++i) update_candidate(kernel, work_[i], spare[worker]);
    });
    parallel_for(items(mixed_.size()), threads, [&](std::size_t item, int) {
      const std::size_t last = std::min(mixed_.size(), (item + 1) * kBlocksOfItem);
      for (std::size_t i = item * kBlocksOfItem; i < last; ++i) update_free(kernel, mixed_[i], nullptr);
    });
    for (const int block : free_) {
      for (const auto& layer : grid_.layers) {
        if (layer[block]) count_all_free(*layer[block]);
      }
    }
  }

  /// Takes the new blocks into the grid and counts them.
  void commit(IntegrationReport& report) {
    const int layer = grid_.layer_of(camera_);
    for (WorkBlock& work : work_) {
      report.contradicted += work.contradicted;
      if (work.fresh && work.touched) {
        if (work.block < 0) {
          work.block = grid_.add(work.key);
          ++report.new_blocks;
        }
        grid_.layers[layer][work.block] = std::move(work.fresh);
      }
      if (work.touched) grid_.update_correlation(work.block);
    }
  }

 private:
  /// Box around the bands of a tile's pixels, with half a pixel around.
  Eigen::AlignedBox3d tile_box(int u0, int v0, int stride) const {
    Eigen::AlignedBox3d box;
    const PinholeCamera& c = image_.camera;
    double widest = 0;
    for (int v = v0; v < std::min(v0 + stride, c.height); ++v) {
      for (int u = u0; u < std::min(u0 + stride, c.width); ++u) {
        const BandDepths& band = frame_.bands[static_cast<std::size_t>(v) * c.width + u];
        if (band.far < band.near) continue;
        const Vector3d ray = image_.T_world_camera.linear() * Vector3d((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1);
        box.extend(image_.T_world_camera.translation() + band.near * ray);
        box.extend(image_.T_world_camera.translation() + band.far * ray);
        widest = std::max<double>(widest, band.far);
      }
    }
    if (box.isEmpty()) return box;
    const Vector3d half_pixel = Vector3d::Constant(0.5 * widest / std::min(c.fx, c.fy));
    return {box.min() - half_pixel, box.max() + half_pixel};
  }

  void add_box(const Eigen::AlignedBox3d& box) {
    const double voxel = grid_.options.voxel;
    int first[3], last[3];
    for (int k = 0; k < 3; ++k) {
      const double low = std::ceil(box.min()[k] / voxel), high = std::floor(box.max()[k] / voxel);
      const bool inside = low > -kMostBlocks * 8.0 && high < kMostBlocks * 8.0;
      require(inside, "voxel", voxel, "is too small for a map that reaches this far from the origin");
      first[k] = static_cast<int>(low) >> 3;
      last[k] = static_cast<int>(high) >> 3;
    }
    for (int z = first[2]; z <= last[2]; ++z) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int x = first[0]; x <= last[0]; ++x) add_candidate({x, y, z});
      }
    }
  }

  double radius() const { return 0.5 * std::sqrt(3.0) * (kBlockSide - 1) * grid_.options.voxel; }
  Vector3d centre_of(const BlockKey& key) const {
    const double half = 0.5 * (kBlockSide - 1) * grid_.options.voxel;
    return T_camera_world_ * Vector3d(block_ * Vector3d(key.x, key.y, key.z) + Vector3d::Constant(half));
  }

  void add_candidate(const BlockKey& key) {
    if (candidates_.find(key.packed()) >= 0) return;
    const bool meets = coarse_.meets_surface(centre_of(key), radius());
    candidates_.insert(key.packed(), meets ? 1 : 0);
    if (!meets) return;
    work_.emplace_back();
    work_.back().key = key;
    work_.back().block = grid_.find(key);
    const bool stored = work_.back().block >= 0 && layer_ < static_cast<int>(grid_.layers.size()) &&
                        grid_.layers[layer_][work_.back().block];
    if (!stored) ++missing_;
    // Far beyond the limit nothing is gained by counting on.
    if (missing_ * sizeof(VoxelBlock) > 4 * grid_.options.max_memory + 1e9) check_memory();
  }

  void check_memory() const {
    const double now = static_cast<double>(grid_.bytes()), more = static_cast<double>(missing_ * sizeof(VoxelBlock));
    if (now + more <= grid_.options.max_memory) return;
    const auto megabytes = [](double bytes) { return std::to_string(std::llround(bytes / 1e6)) + " MB"; };
    throw InvalidInput("max_memory = " + megabytes(grid_.options.max_memory) + ": the map has " + megabytes(now) +
                       " and this frame would add up to " + megabytes(more) + " at a voxel of " +
                       std::to_string(grid_.options.voxel) + " m: larger voxels, a smaller range or more memory");
  }

  KernelFrame kernel_frame() const {
    const PinholeCamera& c = image_.camera;
    KernelFrame out;
    out.pixels = frame_.planes.data();
    out.shares = frame_.shares.empty() ? nullptr : frame_.shares.data();
    out.width = c.width;
    out.height = c.height;
    out.fx = static_cast<float>(c.fx);
    out.fy = static_cast<float>(c.fy);
    out.cx = static_cast<float>(c.cx + 0.5);
    out.cy = static_cast<float>(c.cy + 0.5);
    out.nearest = static_cast<float>(c.nearest);
    const SdfOptions& options = grid_.options;
    out.gate_squared = static_cast<float>(options.outlier_gate * options.outlier_gate);
    out.gate_least = static_cast<float>(0.5 * options.voxel);
    out.persistence = options.persistence;
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = grid_.options.voxel * image_.T_world_camera.linear().row(k).transpose();
      for (int axis = 0; axis < 3; ++axis) out.step[k][axis] = static_cast<float>(step[axis]);
    }
    return out;
  }

  Vector3d first_voxel(const BlockKey& key) const { return T_camera_world_ * (block_ * Vector3d(key.x, key.y, key.z)); }

  KernelBlock kernel_block(const BlockKey& key, VoxelBlock& voxels) const {
    KernelBlock out;
    const Vector3d origin = first_voxel(key);
    for (int k = 0; k < 3; ++k) out.origin[k] = static_cast<float>(origin[k]);
    out.rows = voxels.rows[0];
    out.near = voxels.near;
    out.free = voxels.free;
    return out;
  }

  bool update(const KernelFrame& kernel, const BlockKey& key, VoxelBlock& voxels, int* contradicted = nullptr) const {
    KernelBlock block = kernel_block(key, voxels);
    integrate_block(kernel, block);
    if (contradicted) *contradicted = block.contradicted;
    voxels.looked_through |= block.looked_through;
    if (!block.touched) return false;
    voxels.sum_weight += block.sum_weight;
    voxels.sum_systematic += block.sum_systematic;
    const double common = 1 - static_cast<double>(block.sum_white) / block.sum_weight;
    for (int k = 0; k < 3; ++k) {
      const double shared = common + (1 - common) * shared_pixels(kernel, key, k);
      voxels.sum_correlation[k] += block.sum_weight * shared;
    }
    return true;
  }

  /// Share of the voxels that project into the same pixel as their neighbour along an axis: the errors are the same
  /// there and independent elsewhere.
  double shared_pixels(const KernelFrame& kernel, const BlockKey& key, int axis) const {
    Vector3d centre = first_voxel(key);
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) centre[i] += 0.5 * (kBlockSide - 1) * kernel.step[k][i];
    }
    if (!(centre.z() > kernel.nearest)) return 1;
    const float* const step = kernel.step[axis];
    const double du = kernel.fx * (step[0] - step[2] * centre.x() / centre.z()) / centre.z();
    const double dv = kernel.fy * (step[1] - step[2] * centre.y() / centre.z()) / centre.z();
    return std::max(0.0, 1 - std::abs(du)) * std::max(0.0, 1 - std::abs(dv));
  }

  void update_candidate(const KernelFrame& kernel, WorkBlock& work, std::unique_ptr<VoxelBlock>& spare) const {
    if (work.voxels) {
      work.touched = update(kernel, work.key, *work.voxels, &work.contradicted);
    } else {
      if (!spare) spare = std::make_unique<VoxelBlock>();
      work.touched = update(kernel, work.key, *spare);
      if (work.touched) work.fresh = std::move(spare);
    }
    if (work.block >= 0) update_free(kernel, work.block, work.voxels);
  }

  /// Layers of a block that get no surface from this frame: only what is looked through counts.
  void update_free(KernelFrame kernel, int block, const VoxelBlock* updated) const {
    kernel.surfaces = false;
    for (const auto& layer : grid_.layers) {
      if (layer[block] && layer[block].get() != updated) update(kernel, grid_.keys[block], *layer[block]);
    }
  }

  void count_all_free(VoxelBlock& voxels) const {
    for (int i = 0; i < kBlockVoxels; ++i) {
      if (voxels.near[i] == 0) continue;
      const int most = voxels.near[i] + grid_.options.persistence,
                frames = std::max<int>(voxels.free[i], std::min(most, voxels.free[i] + 1));
      voxels.free[i] = static_cast<std::uint8_t>(std::min(255, frames));
    }
    voxels.looked_through = true;
  }

  SdfGrid& grid_;
  const DepthImage& image_;
  const DepthCamera& camera_;
  const FramePlanes& frame_;
  const double block_;
  const CoarseImage coarse_;
  Pose T_camera_world_ = Pose::Identity();
  int layer_ = 0;
  std::vector<WorkBlock> work_;
  KeyTable candidates_;  // 1: in work_, 0: checked and apart from every surface
  std::size_t missing_ = 0;
  std::vector<int> free_, mixed_;
};

}  // namespace

IntegrationReport integrate_frame(SdfGrid& grid, DepthImage image, const DepthCamera& camera,
                                  const FrameUncertainty& uncertainty) {
  check_frame(image, camera, uncertainty);
  grid.check_camera(camera);
  image.clean();
  image.camera = camera.intrinsics;
  check_depths(image);
  IntegrationReport checked;
  if (grid.frames > 0) check_pose(grid.key_frame, image, grid.options, checked);
  if (!grid.frame_planes) grid.frame_planes = std::make_shared<FramePlanes>();
  FramePlanes& frame = *grid.frame_planes;
  frame_planes(image, camera, uncertainty, grid.options, frame);
  IntegrationReport report = frame.report;
  report.invalid = image.invalid;
  report.agreement = checked.agreement;
  report.warning = checked.warning;
  require(report.too_noisy == 0 || report.used > 0, "truncation", grid.options.truncation,
          "must be at least three standard deviations of the depth: all pixels are noisier");
  KeyFrame key_frame = KeyFrame::of(image);
  FrameIntegration integration(grid, image, camera, frame);
  integration.collect();
  integration.collect_free();
  integration.run();
  integration.commit(report);
  // A key frame serves until the camera sees something else. A doubtful one does not take its place.
  if (grid.frames == 0 || (std::isnan(report.agreement) && report.warning.empty()))
    grid.key_frame = std::move(key_frame);
  ++grid.frames;
  return report;
}

}  // namespace mmgrasp::detail
