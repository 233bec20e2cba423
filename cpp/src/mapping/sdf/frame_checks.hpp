#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// Throws InvalidInput on what cannot be a frame of this camera.
void check_frame(const DepthImage& image, const DepthCamera& camera, const FrameUncertainty& uncertainty);
/// Throws InvalidInput when nothing was measured, or everything out of range and in it at another scale.
void check_depths(const DepthImage& image);
/// Compares the frame with the key frame. Throws InvalidInput when they fit once its pose, the key frame's or
/// both are inverted; sets agreement and warning.
void check_pose(const KeyFrame& key_frame, const DepthImage& image, const SdfOptions& options,
                IntegrationReport& report);

}  // namespace mmgrasp::detail
