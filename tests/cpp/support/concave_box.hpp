#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::test {

/// A box with one face pushed in: closed and not convex.
inline MeshShape concave_box(const Eigen::Vector3d& size) {
  std::vector<Eigen::Vector3d> v;
  for (int i = 0; i < 8; ++i)
    v.push_back(0.5 * size.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  v.push_back({0, 0, 0.3 * size.z()});
  return {make_mesh(v, {{0, 2, 3},
                        {0, 3, 1},
                        {0, 1, 5},
                        {0, 5, 4},
                        {2, 6, 7},
                        {2, 7, 3},
                        {0, 4, 6},
                        {0, 6, 2},
                        {1, 3, 7},
                        {1, 7, 5},
                        {4, 5, 8},
                        {5, 7, 8},
                        {7, 6, 8},
                        {6, 4, 8}})};
}

}  // namespace mmgrasp::test
