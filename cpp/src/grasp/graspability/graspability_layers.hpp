#pragma once

#include <vector>

#include "grasp/hand/row_spans.hpp"
#include "mmgrasp/grasp/graspability.hpp"

namespace mmgrasp::detail {

/// Connected cells that rise above a height without a step between neighbours: what is likely one part.
class Pieces {
 public:
  Pieces(const HeightMap& map, double above, double step);
  /// 1 over the middle of the piece under a point of the map, 0 at its farthest cell or beside all pieces.
  double centring(const Eigen::Vector2d& point) const;

 private:
  struct Piece {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double radius = 0;
  };
  const HeightMap& map_;
  std::vector<int> label_;  // one a cell, -1 below
  std::vector<Piece> pieces_;
};

/// What a height of the fingertips makes of a height map: where the part would stand between the fingers, what fingers
/// and palm would touch.
struct TipLayer {
  TipLayer(const HeightMap& map, double tip_height, const Hand& hand, const GraspabilityOptions& options, int border);
  double tip_height;
  RowSums contact, fingers, palm;
  Pieces pieces;
};

/// Masks of one closing direction and opening, ready for convolution.
struct HandRuns {
  HandRuns(const HandMasks& masks)
      : contact(masks.contact), fingers(masks.fingers), palm(masks.palm), contact_cells(masks.contact.count()) {}
  int radius() const { return std::max({contact.radius, fingers.radius, palm.radius}); }
  MaskRuns contact, fingers, palm;
  int contact_cells;
};

/// Contact share where nothing is touched, else 0; smoothed by three running means. `peak` is the unsmoothed map.
struct LayerMap {
  std::vector<float> raw, smooth;
  bool empty = true;
};
LayerMap layer_map(const TipLayer& layer, const HandRuns& hand, int smoothing_cells);

/// Cells of local maxima, best first, none nearer than `distance` cells to a better one.
std::vector<int> local_maxima(const LayerMap& map, int nx, int ny, double distance);

/// Heights at which fingertips are tried, lowest first.
std::vector<double> tip_heights(const HeightMap& map, const GraspabilityOptions& options);

enum class Refined { good, too_wide, poor, collision };

/// Centres the hand on the part under a cell, measures it and checks the hand opened for it. A good grasp gets its
/// opening and position in the map's frame, its place and the parts of its quality but `room`.
class Refiner {
 public:
  Refiner(const HeightMap& map, const Hand& hand, const GraspabilityOptions& options)
      : map_(map), hand_(hand), options_(options) {
    for (const float upper : map.upper) {
      if (upper > top_) top_ = upper;
    }
  }
  Refined refine(int ix, int iy, double angle, double opening, const TipLayer& layer, Grasp& grasp,
                 HeightMapProvenance& place, std::vector<QualityFactor>& parts) const;

 private:
  bool touches(const Eigen::Vector2d& middle, const Eigen::Vector2d& along, double u0, double u1, double v_half,
               double above) const;
  bool hand_touches(const Eigen::Vector2d& middle, const Eigen::Vector2d& along, double opening,
                    double tip_height) const;
  float height_at(const Eigen::Vector2d& p) const;

  const HeightMap& map_;
  const Hand& hand_;
  const GraspabilityOptions& options_;
  double top_ = -1e30;  // nothing of the map rises higher
};

}  // namespace mmgrasp::detail
