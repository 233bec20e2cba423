#include <map>
#include <mutex>

#include "collision/bodies.hpp"

namespace mmgrasp::detail {

namespace {

using Key = std::tuple<const void*, double, double>;

struct Entry {
  std::weak_ptr<const void> source;  // tells a new mesh at an old address from the one the solid was made of
  std::shared_ptr<const Solid> solid;
};

std::mutex cache_mutex;
std::map<Key, Entry>& cache() {
  static std::map<Key, Entry> entries;
  return entries;
}

std::shared_ptr<const Solid> look_up(const Key& key, const std::shared_ptr<const void>& source) {
  const std::lock_guard<std::mutex> lock(cache_mutex);
  const auto it = cache().find(key);
  return it != cache().end() && it->second.source.lock() == source ? it->second.solid : nullptr;
}

void keep(const Key& key, const std::shared_ptr<const void>& source, const std::shared_ptr<const Solid>& solid) {
  const std::lock_guard<std::mutex> lock(cache_mutex);
  for (auto it = cache().begin(); it != cache().end();)
    it = it->second.source.expired() ? cache().erase(it) : std::next(it);
  cache()[key] = {source, solid};
}

}  // namespace

std::shared_ptr<const Solid> shared_solid(const Shape& shape, double padding) {
  std::shared_ptr<const void> source;
  double resolution = 0;
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) source = mesh->mesh;
  if (const auto* voxels = std::get_if<Voxels>(&shape)) {
    source = voxels->centres;
    resolution = voxels->resolution;
  }
  if (source == nullptr) return make_solid(shape, padding);
  const Key key{source.get(), padding, resolution};
  if (auto known = look_up(key, source)) return known;
  auto solid = make_solid(shape, padding);
  keep(key, source, solid);
  return solid;
}

namespace {

// Kind and dimensions of a primitive, or a mesh's address.
using CoverKey = std::tuple<std::size_t, const void*, double, double, double>;

CoverKey cover_key(const Shape& shape) {
  const std::size_t kind = shape.index();
  if (const auto* s = std::get_if<Box>(&shape)) return {kind, nullptr, s->size[0], s->size[1], s->size[2]};
  if (const auto* s = std::get_if<Sphere>(&shape)) return {kind, nullptr, s->radius, 0, 0};
  if (const auto* s = std::get_if<Cylinder>(&shape)) return {kind, nullptr, s->radius, s->length, 0};
  if (const auto* s = std::get_if<Capsule>(&shape)) return {kind, nullptr, s->radius, s->length, 0};
  if (const auto* s = std::get_if<MeshShape>(&shape)) return {kind, s->mesh.get(), 0, 0, 0};
  return {kind, nullptr, 0, 0, 0};  // planes and voxels have an empty cover
}

struct CoverEntry {
  std::weak_ptr<const void> source;  // of meshes only
  std::shared_ptr<const BallCover> cover;
};

constexpr std::size_t kMaxCovers = 1000;

}  // namespace

std::shared_ptr<const BallCover> shared_cover(const Solid& solid, const Shape& shape) {
  static std::map<CoverKey, CoverEntry> covers;
  const CoverKey key = cover_key(shape);
  std::shared_ptr<const void> source;
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) source = mesh->mesh;
  {
    const std::lock_guard<std::mutex> lock(cache_mutex);
    const auto it = covers.find(key);
    if (it != covers.end() && it->second.source.lock() == source) return it->second.cover;
  }
  auto cover = std::make_shared<const BallCover>(cover_body(solid, shape));
  const std::lock_guard<std::mutex> lock(cache_mutex);
  if (covers.size() >= kMaxCovers) covers.clear();
  covers[key] = {source, cover};
  return cover;
}

}  // namespace mmgrasp::detail
