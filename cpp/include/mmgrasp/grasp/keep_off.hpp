#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"

namespace mmgrasp {

/// A box in the frame of a part's mesh: the surface in it is not to be touched.
struct MMGRASP_EXPORT KeepOffBox {
  Pose T_mesh_box = Pose::Identity();              ///< Its middle.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< Its lengths [m], > 0.
  void check() const;                              ///< Throws InvalidInput naming field, value and rule.
};

/// The surface of a part that no finger may touch.
struct MMGRASP_EXPORT KeepOff {
  std::string part;                ///< The part's name.
  std::vector<int> segments = {};  ///< Numbers of the segments that segment_mesh() cuts it into by default.
  std::vector<KeepOffBox> boxes = {};
  std::vector<std::string> names = {};  ///< Segments by segment_names(): "cylinder_1", or "<part>/cylinder_1".
  std::string source = {};              ///< Who asks for it (a file and its line): messages about it begin with that.
};

/// Pieces of a surface: convex, plane polygons [m].
using SurfacePieces = std::vector<std::vector<Eigen::Vector3d>>;

/// The pieces of some faces of a mesh (in its own frame), and those of the whole mesh in a box. Throws InvalidInput for
/// numbers of no face, or a wrong box.
MMGRASP_EXPORT SurfacePieces surface_of_faces(const TriangleMesh& mesh, const std::vector<int>& faces);
MMGRASP_EXPORT SurfacePieces surface_in_box(const TriangleMesh& mesh, const KeepOffBox& box);

/// Whether the pads of a grasp lie on a piece of surface, in the frame of the active subassembly: nearer than `near`
/// [m] to the plane of a pad, in its width, above the tips. A pad is as long as its finger. Throws InvalidInput for a
/// wrong grasp, or `near` <= 0.
MMGRASP_EXPORT bool pads_touch(const AssemblyGrasp& grasp, const SurfacePieces& pieces, double near = 0.0005);

}  // namespace mmgrasp
