#include "mapping/segmentation/surface_patches.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

#include <queue>
#include <tuple>

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
/// What a right angle between a cell's normal and the patch's counts, beside the square of the distance in spacings.
constexpr double kTurnWeight = 4;

/// A cell that a patch may take next.
struct Offer {
  double cost;
  int cell, patch;
  bool operator>(const Offer& other) const {
    return std::tie(cost, cell, patch) > std::tie(other.cost, other.cell, other.patch);
  }
};

/// Grows patches from seeds spread evenly over the surface: a cell goes to the patch that it fits best, by distance and
/// by how far the surface bends.
class PatchGrower {
 public:
  PatchGrower(const SurfaceCells& cells, double spacing) : cells_(cells), spacing_(spacing) {
    out_.patch_of.assign(cells.size(), -1);
  }

  SurfacePatches grow() {
    for (const int seed : seeds()) start(seed);
    flood();
    for (int c = 0; c < cells_.size(); ++c) {
      if (out_.patch_of[c] >= 0) continue;  // else a piece of surface without a seed
      start(c);
      flood();
    }
    return std::move(out_);
  }

 private:
  /// The cell nearest to the mean of the cells in each cube of edge `spacing`.
  std::vector<int> seeds() const {
    const SurfaceCells cubes = surface_cells(cells_.position, spacing_);
    std::vector<int> nearest(cubes.size(), -1);
    for (int c = 0; c < cells_.size(); ++c) {
      const Vector3d& middle = cubes.position[cubes.cell_of[c]];
      int& best = nearest[cubes.cell_of[c]];
      if (best < 0 || (cells_.position[c] - middle).squaredNorm() < (cells_.position[best] - middle).squaredNorm()) {
        best = c;
      }
    }
    return nearest;
  }

  void start(int seed) {
    queue_.push({0, seed, out_.size()});
    out_.centre.push_back(Vector3d::Zero());
    normal_.push_back(Vector3d::Zero());
    count_.push_back(0);
  }

  void flood() {
    while (!queue_.empty()) {
      poll_();
      const Offer offer = queue_.top();
      queue_.pop();
      if (out_.patch_of[offer.cell] >= 0) continue;
      take(offer.cell, offer.patch);
      for (int k = cells_.first_neighbour[offer.cell]; k < cells_.first_neighbour[offer.cell + 1]; ++k) {
        const int next = cells_.neighbours[k];
        if (out_.patch_of[next] < 0) queue_.push({cost(next, offer.patch), next, offer.patch});
      }
    }
  }

  void take(int cell, int patch) {
    out_.patch_of[cell] = patch;
    const double share = 1.0 / ++count_[patch];
    out_.centre[patch] += share * (cells_.position[cell] - out_.centre[patch]);
    normal_[patch] += cells_.normal[cell];
  }

  double cost(int cell, int patch) const {
    const Vector3d off = cells_.position[cell] - out_.centre[patch];
    const Vector3d normal = normal_[patch].normalized();
    const double height = normal.dot(off) / cells_.leaf;
    return off.squaredNorm() / (spacing_ * spacing_) + kTurnWeight * (1 - normal.dot(cells_.normal[cell])) +
           height * height;
  }

  const SurfaceCells& cells_;
  double spacing_;
  SurfacePatches out_;
  std::vector<Vector3d> normal_;  ///< Sum over the patch's cells.
  std::vector<int> count_;
  InterruptionPoll poll_{256};
  std::priority_queue<Offer, std::vector<Offer>, std::greater<Offer>> queue_;
};

}  // namespace

SurfacePatches surface_patches(const SurfaceCells& cells, double spacing) {
  return PatchGrower(cells, spacing).grow();
}

}  // namespace mmgrasp::detail
