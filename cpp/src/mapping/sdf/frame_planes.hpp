#pragma once

// A depth image made ready for integration: a plane with its variance for every pixel.

#include <memory>
#include <vector>

#include "mapping/sdf/integrate_kernel.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp::detail {

/// Part of a pixel's ray that passes the band around its surface, as depths; empty (far < near) without a surface.
struct BandDepths {
  float near = 1, far = 0;
};

/// What a fit works in.
struct PlaneScratch;

struct FramePlanes {
  std::vector<PixelPlane> planes;
  std::vector<PixelShare> shares;  ///< Empty: all errors are the pixels' own.
  std::vector<BandDepths> bands;
  IntegrationReport report;  ///< Counts of pixels.
  double median_depth = 0;   ///< Median of the depths measured in range [m].
  std::shared_ptr<PlaneScratch> scratch;
};

/// `image` has been cleaned and checked. What `out` held is lost, its memory is used again: the system would clear
/// megabytes for every frame.
void frame_planes(const DepthImage& image, const DepthCamera& camera, const FrameUncertainty& uncertainty,
                  const SdfOptions& options, FramePlanes& out);

}  // namespace mmgrasp::detail
