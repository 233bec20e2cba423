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

}  // namespace mmgrasp::detail
