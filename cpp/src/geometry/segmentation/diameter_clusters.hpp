#pragma once

#include <vector>

#include "geometry/segmentation/face_graph.hpp"

namespace mmgrasp::detail {

struct DiameterClusters {
  std::vector<int> labels;  ///< Cluster of each face.
  int count = 0;            ///< Gaussians the data called for.
};

/// Clusters faces by the logarithm of their shape diameters with a Gaussian mixture, and draws the borders by minimum
/// cuts (P1, section 5.1): each face pays minus the logarithm of its share in the cluster, by area; each edge between
/// two clusters pays `smoothing` by its length, a tenth of it where the solid is creased inwards by a right angle.
DiameterClusters cluster_diameters(const FaceGraph& graph, const std::vector<double>& diameters, int most_clusters,
                                   double smoothing, unsigned seed);

}  // namespace mmgrasp::detail
