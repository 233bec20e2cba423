#include "mapping/sdf/sdf_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <type_traits>

#include "mmgrasp/core/detail/crc32.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

constexpr char kMagic[] = "mmgrasp probabilistic sdf\n";
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHeader = sizeof(kMagic) - 1 + sizeof(kVersion) + sizeof(std::uint64_t);

/// Appends plain values; numbers are little endian, as on every machine this runs on.
class Bytes {
 public:
  template <typename T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    text_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <typename T, std::size_t n>
  void add(const T (&values)[n]) {
    text_.append(reinterpret_cast<const char*>(values), sizeof(values));
  }
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    text_ += text;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Takes them off again; refuses to read beyond the end, and numbers that no map holds.
class Reader {
 public:
  Reader(const std::string& text, std::size_t begin, std::size_t end, const std::string& path)
      : text_(text), at_(begin), end_(end), path_(path) {}

  [[noreturn]] void refuse(const std::string& reason) const { throw IoError("map '" + path_ + "': " + reason); }
  template <typename T>
  T take() {
    T value;
    raw(&value, sizeof(T));
    return value;
  }
  double number() {
    const auto value = take<double>();
    if (!std::isfinite(value)) refuse("damaged: holds a number that is not finite");
    return value;
  }
  std::size_t count(std::size_t bytes_each) {
    const auto value = take<std::uint64_t>();
    if (value > (end_ - at_) / bytes_each) refuse("damaged: a count goes beyond the end");
    return value;
  }
  template <typename T, std::size_t n>
  void array(T (&values)[n]) {
    raw(values, sizeof(values));
  }
  std::string string() {
    std::string out(count(1), '\0');
    raw(out.data(), out.size());
    return out;
  }
  bool done() const { return at_ == end_; }

 private:
  void raw(void* to, std::size_t size) {
    if (size > end_ - at_) refuse("damaged: ends too soon");
    std::memcpy(to, text_.data() + at_, size);
    at_ += size;
  }

  const std::string& text_;
  std::size_t at_, end_;
  const std::string& path_;
};

void add_camera(Bytes& out, const DepthCamera& camera) {
  out.add(camera.name);
  const PinholeCamera& c = camera.intrinsics;
  out.add(static_cast<std::int32_t>(c.width));
  out.add(static_cast<std::int32_t>(c.height));
  for (const double value : {c.fx, c.fy, c.cx, c.cy, c.nearest, c.farthest}) out.add(value);
  const DepthNoise& n = camera.noise;
  for (const double value : {n.constant, n.linear, n.quadratic, n.slant, n.slant_power}) out.add(value);
  out.add(camera.systematic);
  out.add(camera.systematic_scale);
}

DepthCamera take_camera(Reader& in) {
  DepthCamera camera;
  camera.name = in.string();
  PinholeCamera& c = camera.intrinsics;
  c.width = in.take<std::int32_t>();
  c.height = in.take<std::int32_t>();
  for (double* value : {&c.fx, &c.fy, &c.cx, &c.cy, &c.nearest, &c.farthest}) *value = in.number();
  DepthNoise& n = camera.noise;
  for (double* value : {&n.constant, &n.linear, &n.quadratic, &n.slant, &n.slant_power}) *value = in.number();
  camera.systematic = in.number();
  camera.systematic_scale = in.number();
  camera.check();
  return camera;
}

std::string content_of(const SdfGrid& grid) {
  Bytes out;
  const SdfOptions& o = grid.options;
  out.add(o.voxel);
  out.add(o.truncation);
  out.add(static_cast<std::int32_t>(o.distance));
  out.add(o.max_incidence);
  out.add(o.outlier_gate);
  out.add(static_cast<std::int32_t>(o.persistence));
  out.add(o.max_memory);
  out.add(static_cast<std::int32_t>(grid.frames));
  out.add(static_cast<std::uint64_t>(grid.cameras.size()));
  for (std::size_t k = 0; k < grid.cameras.size(); ++k) {
    add_camera(out, grid.cameras[k]);
    out.add(static_cast<std::int32_t>(grid.camera_layer[k]));
  }
  for (int k = 0; k < 16; ++k) out.add(grid.key_frame.T_world_camera.matrix().data()[k]);
  out.add(static_cast<std::uint64_t>(grid.key_frame.points.size()));
  for (const Eigen::Vector3d& p : grid.key_frame.points) {
    for (int k = 0; k < 3; ++k) out.add(p[k]);
  }
  std::vector<int> order(grid.keys.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return grid.keys[a].packed() < grid.keys[b].packed(); });
  out.add(static_cast<std::uint64_t>(grid.layers.size()));
  out.add(static_cast<std::uint64_t>(order.size()));
  for (const int block : order) {
    throw_if_interrupted();
    out.add(grid.keys[block].packed());
    for (const auto& layer : grid.layers) {
      const VoxelBlock* voxels = layer[block].get();
      out.add(static_cast<std::uint8_t>(voxels != nullptr));
      if (!voxels) continue;
      for (const auto& row : voxels->rows) out.add(row);
      out.add(voxels->near);
      out.add(voxels->free);
      out.add(voxels->sum_weight);
      out.add(voxels->sum_correlation);
      out.add(voxels->sum_systematic);
    }
  }
  return out.text();
}

void check_voxels(const VoxelBlock& voxels, double truncation, const Reader& in) {
  for (int i = 0; i < kBlockVoxels; ++i) {
    const bool sound = std::abs(voxels.mean(i)) <= 1.001 * truncation && std::isfinite(voxels.weight(i)) &&
                       voxels.weight(i) >= 0 && (voxels.weight(i) > 0) == (voxels.near[i] > 0);
    if (!sound) in.refuse("damaged: a voxel holds what no frame gives");
  }
}

void take_blocks(Reader& in, SdfGrid& grid) {
  grid.layers.resize(in.count(1));
  for (const int layer : grid.camera_layer) {
    if (layer < 0 || layer >= static_cast<int>(grid.layers.size())) in.refuse("damaged: a camera without a layer");
  }
  const std::size_t blocks = in.count(1);
  for (std::size_t k = 0; k < blocks; ++k) {
    throw_if_interrupted();
    const BlockKey key = BlockKey::unpack(in.take<std::uint64_t>());
    if (grid.find(key) >= 0) in.refuse("damaged: a block twice");
    const int block = grid.add(key);
    bool any = false;
    for (auto& layer : grid.layers) {
      if (in.take<std::uint8_t>() == 0) continue;
      any = true;
      layer[block] = std::make_unique<VoxelBlock>();
      VoxelBlock& voxels = *layer[block];
      for (auto& row : voxels.rows) in.array(row);
      in.array(voxels.near);
      in.array(voxels.free);
      voxels.looked_through =
          std::any_of(std::begin(voxels.free), std::end(voxels.free), [](std::uint8_t frames) { return frames > 0; });
      voxels.sum_weight = in.number();
      for (double& sum : voxels.sum_correlation) sum = in.number();
      voxels.sum_systematic = in.number();
      check_voxels(voxels, grid.options.truncation, in);
    }
    if (!any) in.refuse("damaged: a block without voxels");
    grid.update_correlation(block);
  }
}

std::shared_ptr<SdfGrid> grid_of(Reader& in) {
  SdfOptions o;
  o.voxel = in.number();
  o.truncation = in.number();
  const auto distance = in.take<std::int32_t>();
  if (distance < 0 || distance > 1) in.refuse("damaged: a kind of distance that does not exist");
  o.distance = static_cast<SdfDistance>(distance);
  o.max_incidence = in.number();
  o.outlier_gate = in.number();
  o.persistence = in.take<std::int32_t>();
  o.max_memory = in.number();
  o.check();
  auto grid = std::make_shared<SdfGrid>(o);
  grid->frames = in.take<std::int32_t>();
  const std::size_t cameras = in.count(1);
  for (std::size_t k = 0; k < cameras; ++k) {
    grid->cameras.push_back(take_camera(in));
    grid->camera_layer.push_back(in.take<std::int32_t>());
  }
  Eigen::Matrix4d T;
  for (int k = 0; k < 16; ++k) T.data()[k] = in.number();
  grid->key_frame.T_world_camera = checked_pose(T, "pose");
  grid->key_frame.points.resize(in.count(3 * sizeof(double)));
  for (Eigen::Vector3d& p : grid->key_frame.points) {
    for (int k = 0; k < 3; ++k) p[k] = in.number();
  }
  take_blocks(in, *grid);
  if (!in.done()) in.refuse("damaged: bytes after the last block");
  return grid;
}

}  // namespace

void write_sdf(const SdfGrid& grid, const std::string& path) {
  const std::string content = content_of(grid);
  Bytes head;
  head.add(kVersion);
  head.add(static_cast<std::uint64_t>(content.size()));
  const std::uint32_t sum = crc32(content.data(), content.size());
  write_file(path, "map",
             {{kMagic, sizeof(kMagic) - 1}, head.text(), content, {reinterpret_cast<const char*>(&sum), sizeof(sum)}});
}

std::shared_ptr<SdfGrid> read_sdf(const std::string& path) {
  const std::string text = file_content(path, "map", kLargestMap);
  const std::size_t magic = sizeof(kMagic) - 1;
  Reader head(text, std::min(magic, text.size()), text.size(), path);
  if (text.compare(0, magic, kMagic) != 0) head.refuse("is no map of mmgrasp");
  if (text.size() < kHeader) head.refuse("truncated: the header is not whole");
  const auto version = head.take<std::uint32_t>();
  if (version != kVersion) {
    head.refuse("has version " + std::to_string(version) + " of the format, this program reads version " +
                std::to_string(kVersion));
  }
  const auto size = head.take<std::uint64_t>();
  const std::size_t there = text.size() - kHeader;
  if (there < sizeof(std::uint32_t) || there - sizeof(std::uint32_t) < size) {
    head.refuse("truncated: " + std::to_string(text.size()) + " bytes, " +
                std::to_string(kHeader + size + sizeof(std::uint32_t)) + " expected");
  }
  if (there - sizeof(std::uint32_t) > size) head.refuse("bytes after the end");
  std::uint32_t sum;
  std::memcpy(&sum, text.data() + kHeader + size, sizeof(sum));
  if (crc32(text.data() + kHeader, size) != sum) head.refuse("damaged: its checksum is wrong");
  Reader content(text, kHeader, kHeader + size, path);
  try {
    return grid_of(content);
  } catch (const InvalidInput& error) {
    content.refuse(std::string("damaged: ") + error.what());
  }
}

}  // namespace mmgrasp::detail
