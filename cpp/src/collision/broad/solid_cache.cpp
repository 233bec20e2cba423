#include "collision/broad/solid_cache.hpp"

#include <map>
#include <mutex>

namespace mmgrasp::detail {

namespace {

using Key = std::tuple<const void*, double, double>;

struct Entry {
  std::weak_ptr<const void> source;  // distinguishes a new mesh at an old address from the one the solid was made of
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
using BoundsKey = std::tuple<std::size_t, const void*, double, double, double>;

BoundsKey bounds_key(const Shape& shape) {
  const std::size_t kind = shape.index();
  if (const auto* s = std::get_if<Box>(&shape)) return {kind, nullptr, s->size[0], s->size[1], s->size[2]};
  if (const auto* s = std::get_if<Sphere>(&shape)) return {kind, nullptr, s->radius, 0, 0};
  if (const auto* s = std::get_if<Cylinder>(&shape)) return {kind, nullptr, s->radius, s->length, 0};
  if (const auto* s = std::get_if<Capsule>(&shape)) return {kind, nullptr, s->radius, s->length, 0};
  if (const auto* s = std::get_if<MeshShape>(&shape)) return {kind, s->mesh.get(), 0, 0, 0};
  return {kind, nullptr, 0, 0, 0};  // planes and voxels have none
}

struct BoundsEntry {
  std::weak_ptr<const void> source;  // of meshes only
  std::shared_ptr<const BoundingVolumes> bounds;
};

// Most primitives kept: nothing shows when the last user of a size is removed.
constexpr std::size_t kMaxPrimitives = 1000;

bool of_primitive(const BoundsKey& key) {
  return std::get<1>(key) == nullptr;
}

}  // namespace

std::shared_ptr<const BoundingVolumes> shared_bounds(const Solid& solid, const Shape& shape) {
  static std::map<BoundsKey, BoundsEntry> known;
  const BoundsKey key = bounds_key(shape);
  std::shared_ptr<const void> source;
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) source = mesh->mesh;
  {
    const std::lock_guard<std::mutex> lock(cache_mutex);
    const auto it = known.find(key);
    if (it != known.end() && it->second.source.lock() == source) return it->second.bounds;
  }
  auto bounds = std::make_shared<const BoundingVolumes>(solid, shape);
  const std::lock_guard<std::mutex> lock(cache_mutex);
  std::size_t primitives = 0;
  for (auto it = known.begin(); it != known.end();) {
    const bool dead = !of_primitive(it->first) && it->second.source.expired();
    primitives += of_primitive(it->first);
    it = dead ? known.erase(it) : std::next(it);
  }
  for (auto it = known.begin(); primitives >= kMaxPrimitives && it != known.end();) {
    // Checkers that use them own them too: only new checkers make what is removed again.
    it = of_primitive(it->first) ? known.erase(it) : std::next(it);
  }
  known[key] = {source, bounds};
  return bounds;
}

}  // namespace mmgrasp::detail
