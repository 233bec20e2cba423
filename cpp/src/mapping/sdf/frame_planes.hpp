#pragma once

// A depth image made ready for integration: a plane with its variance for every pixel.

#include <vector>

#include "mapping/sdf/integrate_kernel.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp::detail {

/// Part of a pixel's ray that passes the band around its surface, as depths; empty (far < near) without a surface.
struct BandDepths {
  float near = 1, far = 0;
};

struct FramePlanes {
  std::vector<PixelPlane> planes;
  std::vector<PixelShare> shares;  ///< Empty: all errors are the pixels' own.
  std::vector<BandDepths> bands;
  IntegrationReport report;  ///< Counts of pixels.
  double median_depth = 0;   ///< Median of the depths measured in range [m].
};

/// `image` has been cleaned and checked.
FramePlanes frame_planes(const DepthImage& image, const DepthCamera& camera, const FrameUncertainty& uncertainty,
                         const SdfOptions& options);

}  // namespace mmgrasp::detail
