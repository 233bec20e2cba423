#include "mapping/sdf/marching_cubes.hpp"

namespace mmgrasp::detail {

const int kCellEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                               {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

namespace {

// Corners of the six faces, counter-clockwise seen from outside.
constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

int edge_between(int a, int b) {
  for (int e = 0; e < 12; ++e) {
    if ((kCellEdges[e][0] == a && kCellEdges[e][1] == b) || (kCellEdges[e][0] == b && kCellEdges[e][1] == a)) return e;
  }
  return -1;
}

std::vector<std::array<int, 3>> triangles_of(int pattern) {
  // From the edge where the contour enters a face to the one where it leaves; on each face every run of corners behind
  // the surface is cut off by one line. Seen from outside, what is behind lies to the left of the line.
  int next[12];
  for (int& edge : next) edge = -1;
  for (const auto& face : kFaces) {
    for (int i = 0; i < 4; ++i) {
      const bool behind = pattern >> face[i] & 1, after = pattern >> face[(i + 1) & 3] & 1;
      if (behind || !after) continue;
      // The run behind begins after corner i; find its end.
      int j = (i + 1) & 3;
      while (pattern >> face[(j + 1) & 3] & 1) j = (j + 1) & 3;
      next[edge_between(face[i], face[(i + 1) & 3])] = edge_between(face[j], face[(j + 1) & 3]);
    }
  }
  std::vector<std::array<int, 3>> out;
  bool used[12] = {};
  for (int first = 0; first < 12; ++first) {
    if (next[first] < 0 || used[first]) continue;
    std::vector<int> loop;
    for (int edge = first; !used[edge]; edge = next[edge]) {
      used[edge] = true;
      loop.push_back(edge);
    }
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) out.push_back({loop[0], loop[k], loop[k + 1]});
  }
  return out;
}

}  // namespace

const std::array<std::vector<std::array<int, 3>>, 256>& marching_cubes_triangles() {
  static const auto table = [] {
    std::array<std::vector<std::array<int, 3>>, 256> out;
    for (int pattern = 0; pattern < 256; ++pattern) out[pattern] = triangles_of(pattern);
    return out;
  }();
  return table;
}

}  // namespace mmgrasp::detail
