#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp {

/// How the shape diameter is measured (P1, section 5.1; Shapira, Shamir and Cohen-Or 2008).
struct MMGRASP_EXPORT ShapeDiameterOptions {
  int rays = 30;                     ///< From the middle of each face into the solid; in [1, 1000].
  double cone = 2.0943951023931953;  ///< Full angle of their cone around the inward normal [rad]; in (0, pi).
  double outlier = 1.0;  ///< Rays whose width differs from the median by more standard deviations are left out; > 0.
  bool ray_lengths = false;  ///< P1's mean length of the rays instead of the width between the two surfaces.
  int threads = 0;           ///< 0: all.
  void check() const;        ///< Throws InvalidInput naming field, value and rule.
};

/// Local thickness of a solid at the middle of each face [m]; 0 where no ray leaves the solid (holes in the surface).
///
/// The rays have equal shares of the cone's solid angle and the same directions relative to the normal at every face;
/// each is followed to where it leaves the solid (shells that lie inside it are passed through). A ray from p with
/// outward normal n that leaves at q with outward normal m says that the solid is
///
///     2 (p - q) . (n - m) / |n - m|^2
///
/// wide: the distance of p and q along the mean of the two normals, exact for every ray in a sphere (2 r), a cylinder
/// (2 r), a plate (its thickness) and between the two walls of a tube. The value of a face is the mean over the rays
/// that are no outliers, weighted by the cosine of their angle to the inward normal. With `ray_lengths` it is P1's
/// weighted mean of |p - q|, which is (7/9) 2 r in a sphere and 4/3 of the thickness in a plate (for many rays).
MMGRASP_EXPORT std::vector<double> shape_diameters(const TriangleMesh& mesh, const ShapeDiameterOptions& options = {},
                                                   const Monitor& monitor = {});

}  // namespace mmgrasp
