#pragma once

#include <array>
#include <numeric>
#include <string>
#include <vector>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

/// "list[index]", for messages.
inline std::string entry(const char* list, std::size_t index) {
  return std::string(list) + "[" + std::to_string(index) + "]";
}

/// Throws InvalidInput for a node of no `part` ("section", "member") and when the parts do not join all nodes to one
/// piece. `ends`: of each part; indices of nodes.
inline void check_one_piece(std::size_t nodes, const std::vector<std::array<int, 2>>& ends, const std::string& part,
                            const std::string& whole) {
  std::vector<int> parent(nodes);
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<bool> used(nodes, false);
  const auto root = [&](int node) {
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
  };
  for (const auto& [a, b] : ends) {
    parent[root(a)] = root(b);
    used[a] = used[b] = true;
  }
  for (std::size_t i = 0; i < nodes; ++i) {
    if (!used[i]) require(false, entry("nodes", i), "of no " + part, "every node must belong to a " + part);
    if (root(static_cast<int>(i)) == root(0)) continue;
    require(false, entry("nodes", i), "not connected to nodes[0]", "a " + whole + " is one connected piece");
  }
}

}  // namespace mmgrasp::detail
