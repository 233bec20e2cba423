#pragma once

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// What a beam is made of.
struct MMGRASP_EXPORT BeamMaterial {
  double density = 0;         ///< [kg/m3]; >= 0.
  double youngs_modulus = 0;  ///< [Pa]; > 0.
  double shear_modulus = 0;   ///< [Pa]; > 0.
  double stress_limit = 0;    ///< Von Mises stress that it may bear [Pa]; 0: none is given.
  /// Throws InvalidInput naming field, value and rule.
  void check() const;
};

/// The copper of P2 table 3.4, which gives no stress limit.
MMGRASP_EXPORT BeamMaterial copper();

/// Cross section of a straight beam whose x runs along it: areas and second moments about the principal axes y and z.
struct MMGRASP_EXPORT BeamSection {
  double area = 0;     ///< [m2]; > 0.
  double iy = 0;       ///< Second moment about y, for bending in z [m4]; > 0.
  double iz = 0;       ///< Second moment about z, for bending in y [m4]; > 0.
  double torsion = 0;  ///< Torsion constant J [m4]; > 0.
  /// Farthest fibres in y and z [m], and torque over the largest shear stress [m3]: what stresses follow from. Zero
  /// where they are not known; no stress is reported then.
  double y_extent = 0, z_extent = 0, torsion_modulus = 0;
  bool round = false;  ///< Bending in y and z adds as vectors, not at a corner.

  bool stresses_known() const { return y_extent > 0 && z_extent > 0 && torsion_modulus > 0; }
  /// Throws InvalidInput naming field, value and rule.
  void check() const;
};

/// Tube by its diameters [m]; an inner diameter of zero is a bar. Throws InvalidInput unless 0 <= inner < outer.
MMGRASP_EXPORT BeamSection round_section(double outer_diameter, double inner_diameter = 0);
/// Rectangle by its outer lengths in y and z and its wall [m]; a wall of zero is a bar. Torsion of bars by
/// Saint-Venant's series, of tubes by Bredt's formulas for thin walls. Throws InvalidInput unless the lengths are
/// positive and the wall is zero, or positive and less than half of either.
MMGRASP_EXPORT BeamSection rectangular_section(double y_length, double z_length, double wall = 0);

}  // namespace mmgrasp
