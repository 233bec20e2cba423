#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mmgrasp::detail {

/// Which nodes of a COLLADA file place which nodes and geometries, to know how large its scene is before it is built:
/// a chain of nodes that each place the next ten times is of a few lines and fills any memory.
class DaeInstances {
 public:
  void begin_geometry(std::string_view id) { geometry_ = id; }
  void add_corners(std::size_t corners) { corners_[geometry_] += corners; }
  void begin_node(std::string_view id);
  void end_node() { open_.pop_back(); }
  void place_node(std::string_view id);
  void place_geometry(std::string_view id);

  /// Empty when nodes are at most 200 deep in each other and none holds more than `largest` nodes and corners.
  std::string fault(std::size_t largest) const;

 private:
  struct DaeNode {
    std::vector<std::size_t> children;
    std::vector<std::string_view> placed_nodes, placed_geometries;
  };
  struct DaeExtent {
    std::size_t content = 0;  ///< Nodes and corners.
    int levels = 0;
  };

  /// What a node holds; the rule that is broken comes as std::length_error. `above` counts the levels over it.
  DaeExtent extent(std::size_t node, int above, std::size_t largest,
                   std::vector<std::optional<DaeExtent>>& known) const;

  std::vector<DaeNode> nodes_;
  std::multimap<std::string_view, std::size_t> by_id_;
  std::vector<std::size_t> open_;
  std::map<std::string_view, std::size_t> corners_;
  std::string_view geometry_;
};

}  // namespace mmgrasp::detail
