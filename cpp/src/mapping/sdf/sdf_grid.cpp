#include "mapping/sdf/sdf_grid.hpp"

#include "mapping/sdf/crossing_cells.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

int KeyTable::insert(std::uint64_t key, int value) {
  if (2 * (size_ + 1) > slots_.size()) grow();
  for (std::size_t at = hash(key) & mask_;; at = (at + 1) & mask_) {
    Slot& slot = slots_[at];
    if (slot.value >= 0 && slot.key == key) return slot.value;
    if (slot.value >= 0) continue;
    slot = {key, value};
    ++size_;
    return value;
  }
}

void KeyTable::grow() {
  const std::vector<Slot> old = std::move(slots_);
  slots_.assign(old.empty() ? 64 : 2 * old.size(), {});
  mask_ = slots_.size() - 1;
  size_ = 0;
  for (const Slot& slot : old) {
    if (slot.value >= 0) insert(slot.key, slot.value);
  }
}

SdfGrid::SdfGrid(const SdfGrid& other)
    : options(other.options),
      cameras(other.cameras),
      camera_layer(other.camera_layer),
      frames(other.frames),
      key_frame(other.key_frame),
      table(other.table),
      keys(other.keys),
      bounds(other.bounds),
      correlation(other.correlation),
      mask_table(other.mask_table),
      masks(other.masks) {
  layers.resize(other.layers.size());
  for (std::size_t l = 0; l < layers.size(); ++l) {
    layers[l].reserve(other.layers[l].size());
    for (const auto& block : other.layers[l]) {
      layers[l].push_back(block ? std::make_unique<VoxelBlock>(*block) : nullptr);
    }
  }
}

std::shared_ptr<SdfGrid> SdfGrid::cropped(const Eigen::AlignedBox3d& box) const {
  const auto out = std::make_shared<SdfGrid>(options);
  out->cameras = cameras;
  out->camera_layer = camera_layer;
  out->frames = frames;
  out->key_frame = key_frame;
  out->layers.resize(layers.size());
  const Eigen::Vector3d voxel = Eigen::Vector3d::Constant(options.voxel);
  const Eigen::AlignedBox3d grown(box.min() - voxel, box.max() + voxel);
  for (std::size_t block = 0; block < keys.size(); ++block) {
    if (!grown.intersects(box_of(keys[block]))) continue;
    const int copy = out->add(keys[block]);
    out->correlation[copy] = correlation[block];
    for (std::size_t l = 0; l < layers.size(); ++l) {
      if (layers[l][block]) out->layers[l][copy] = std::make_unique<VoxelBlock>(*layers[l][block]);
    }
  }
  return out;
}

Eigen::AlignedBox3d SdfGrid::box_of(const BlockKey& key) const {
  const Eigen::Vector3d first = kBlockSide * options.voxel * Eigen::Vector3d(key.x, key.y, key.z);
  return {first, first + Eigen::Vector3d::Constant((kBlockSide - 1) * options.voxel)};
}

int SdfGrid::add(const BlockKey& key) {
  const int block = static_cast<int>(keys.size());
  keys.push_back(key);
  bounds.extend(box_of(key));
  correlation.push_back({0, 0, 0});
  for (auto& layer : layers) layer.emplace_back();
  table.insert(key.packed(), block);
  const BlockKey of_mask{key.x >> 3, key.y >> 3, key.z >> 3};
  const int mask = mask_table.insert(of_mask.packed(), static_cast<int>(masks.size()));
  if (mask == static_cast<int>(masks.size())) masks.push_back({});
  masks[mask][key.z & 7] |= std::uint64_t{1} << (8 * (key.y & 7) + (key.x & 7));
  return block;
}

std::shared_ptr<CrossingCells> SdfGrid::crossing_cells() const {
  const std::lock_guard<std::mutex> guard(crossing_mutex_);
  if (!crossing_) crossing_ = std::make_shared<CrossingCells>(keys.size());
  return crossing_;
}

void SdfGrid::forget_crossing_cells() {
  const std::lock_guard<std::mutex> guard(crossing_mutex_);
  crossing_.reset();
}

void SdfGrid::check_camera(const DepthCamera& camera) const {
  for (const DepthCamera& known : cameras) {
    if (known.name != camera.name) continue;
    const bool same = known.systematic == camera.systematic && known.systematic_scale == camera.systematic_scale;
    require(same, "camera.name", "\"" + camera.name + "\"",
            "is the name of a camera with another systematic error; give this one a name of its own");
  }
}

int SdfGrid::find_layer(const DepthCamera& camera) const {
  const bool common = camera.systematic == 0 && camera.systematic_scale == 0;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const DepthCamera& known = cameras[k];
    if (known.name == camera.name || (common && known.systematic == 0 && known.systematic_scale == 0))
      return camera_layer[k];
  }
  return static_cast<int>(layers.size());
}

int SdfGrid::layer_of(const DepthCamera& camera) {
  for (const DepthCamera& known : cameras) {
    if (known.name == camera.name) return find_layer(camera);
  }
  const int layer = find_layer(camera);
  if (layer == static_cast<int>(layers.size())) {
    layers.emplace_back();
    layers.back().resize(keys.size());
  }
  cameras.push_back(camera);
  camera_layer.push_back(layer);
  return layer;
}

void SdfGrid::update_correlation(int block) {
  double weight = 0, sum[3] = {0, 0, 0};
  for (const auto& layer : layers) {
    const VoxelBlock* voxels = layer[block].get();
    if (!voxels) continue;
    weight += voxels->sum_weight;
    for (int k = 0; k < 3; ++k) sum[k] += voxels->sum_correlation[k];
  }
  for (int k = 0; k < 3; ++k) correlation[block][k] = weight > 0 ? static_cast<float>(sum[k] / weight) : 1.0f;
}

std::size_t SdfGrid::bytes() const {
  std::size_t blocks = 0, pointers = 0;
  for (const auto& layer : layers) {
    pointers += layer.capacity();
    for (const auto& block : layer) blocks += block != nullptr;
  }
  return blocks * sizeof(VoxelBlock) + pointers * sizeof(void*) + keys.capacity() * sizeof(BlockKey) +
         correlation.capacity() * sizeof(correlation[0]) + masks.capacity() * sizeof(BlockMask) + table.bytes() +
         mask_table.bytes();
}

}  // namespace mmgrasp::detail
