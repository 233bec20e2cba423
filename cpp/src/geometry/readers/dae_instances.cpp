#include "geometry/readers/dae_instances.hpp"

#include <algorithm>
#include <stdexcept>

namespace mmgrasp::detail {
namespace {

constexpr int kMostLevels = 200;  // as of elements in elements; the importer recurses once per level

}  // namespace

void DaeInstances::begin_node(std::string_view id) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  if (!id.empty()) by_id_.emplace(id, node);
  if (!open_.empty()) nodes_[open_.back()].children.push_back(node);
  open_.push_back(node);
}

void DaeInstances::place_node(std::string_view id) {
  if (!open_.empty()) nodes_[open_.back()].placed_nodes.push_back(id);
}

void DaeInstances::place_geometry(std::string_view id) {
  if (!open_.empty()) nodes_[open_.back()].placed_geometries.push_back(id);
}

std::string DaeInstances::fault(std::size_t largest) const {
  std::vector<std::optional<DaeExtent>> known(nodes_.size());
  try {
    for (std::size_t node = 0; node < nodes_.size(); ++node) extent(node, 0, largest, known);
  } catch (const std::length_error& error) {
    return error.what();
  }
  return {};
}

DaeInstances::DaeExtent DaeInstances::extent(std::size_t node, int above, std::size_t largest,
                                             std::vector<std::optional<DaeExtent>>& known) const {
  if (known[node]) return *known[node];
  DaeExtent whole{1, 1};
  const auto add = [&](const DaeExtent& part) {
    whole.content += part.content;
    whole.levels = std::max(whole.levels, part.levels + 1);
    if (whole.content > largest)
      throw std::length_error("instances multiply to more than " + std::to_string(largest) + " nodes and corners");
    if (above + whole.levels > kMostLevels)
      throw std::length_error("nodes place each other more than " + std::to_string(kMostLevels) + " deep (a circle?)");
  };
  if (above >= kMostLevels) add({0, 1});
  for (const std::size_t child : nodes_[node].children) add(extent(child, above + 1, largest, known));
  for (const std::string_view id : nodes_[node].placed_nodes) {
    const auto [begin, end] = by_id_.equal_range(id);
    for (auto placed = begin; placed != end; ++placed) add(extent(placed->second, above + 1, largest, known));
  }
  for (const std::string_view id : nodes_[node].placed_geometries) {
    const auto corners = corners_.find(id);
    if (corners != corners_.end()) add({corners->second, 0});
  }
  known[node] = whole;
  return whole;
}

}  // namespace mmgrasp::detail
