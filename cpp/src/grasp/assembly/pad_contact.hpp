#pragma once

#include <vector>

#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/grasp/assembly_grasps.hpp"

namespace mmgrasp::detail {

/// What a pad is pressed on: a facet, and the other faces of its segment that reach out of its lowest point.
struct PadFaces {
  const Facet& facet;
  std::vector<int> reaching_out;
};
PadFaces pad_faces(const TriangleMesh& mesh, const std::vector<int>& segment, const Facet& facet,
                   const Eigen::Vector3d& outwards);

/// Opens a jaw grasp, and moves it along its closing axis, so that either pad stands on the outermost point under it of
/// the facet that it holds: a pad pressed on a face that is rough, or tilted, stops there. Other faces that stand out
/// of a facet by no more than its own points under the pad differ are stood on, too; what stands out farther is left to
/// be met.
void stand_on_facets(const TriangleMesh& mesh, const PadFaces& first, const PadFaces& second, AssemblyGrasp& grasp);

/// How far the corners of the outward wall among the faces lie off the cylinder [m]: the median, by area.
double wall_deviation(const TriangleMesh& mesh, const std::vector<int>& faces, const CylinderFit& cylinder);

/// The faces that reach out of the cylinder: the only ones that can open fingers farther.
std::vector<int> faces_beyond(const TriangleMesh& mesh, const std::vector<int>& faces, const CylinderFit& cylinder);

/// Opens a centric grasp so that no point of the faces, of those that stand out of the cylinder by at most `rough` [m],
/// reaches into a pad.
void stand_on_wall(const TriangleMesh& mesh, const std::vector<int>& faces, double rough, AssemblyGrasp& grasp);

}  // namespace mmgrasp::detail
