#include "mmgrasp/structure/beam_section.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

using detail::kPi;

constexpr double kLargestModulus = 1e40;  // That of members which do not bend at all [Pa].

void BeamMaterial::check() const {
  require_not_negative(density, "density", "kg/m3");
  require_positive(youngs_modulus, "youngs_modulus", "Pa", kLargestModulus);
  require_positive(shear_modulus, "shear_modulus", "Pa", kLargestModulus);
  require_not_negative(stress_limit, "stress_limit", "Pa", kLargestNumber);
}

BeamMaterial copper() {
  return {8960, 110e9, 40e9, 0};
}

void BeamSection::check() const {
  require_positive(area, "area", "m2");
  require_positive(iy, "iy", "m4");
  require_positive(iz, "iz", "m4");
  require_positive(torsion, "torsion", "m4");
  require_not_negative(y_extent, "y_extent", "m");  // zero where it is not known
  require_not_negative(z_extent, "z_extent", "m");
  require_not_negative(torsion_modulus, "torsion_modulus", "m3");
}

BeamSection round_section(double outer_diameter, double inner_diameter) {
  require_length(outer_diameter, "outer_diameter");
  require_number(inner_diameter, "inner_diameter", "m");
  require(inner_diameter >= 0 && inner_diameter < outer_diameter, "inner_diameter", inner_diameter,
          "must be zero or positive and less than outer_diameter = " + std::to_string(outer_diameter));
  const double outer = outer_diameter * outer_diameter, inner = inner_diameter * inner_diameter;
  BeamSection section;
  section.area = kPi / 4 * (outer - inner);
  section.iy = section.iz = kPi / 64 * (outer * outer - inner * inner);
  section.torsion = 2 * section.iy;
  section.y_extent = section.z_extent = outer_diameter / 2;
  section.torsion_modulus = section.torsion / section.y_extent;
  section.round = true;
  return section;
}

BeamSection rectangular_section(double y_length, double z_length, double wall) {
  require_length(y_length, "y_length");
  require_length(z_length, "z_length");
  const double shorter = std::min(y_length, z_length), longer = std::max(y_length, z_length);
  require_number(wall, "wall", "m");
  require(wall >= 0 && 2 * wall < shorter, "wall", wall,
          "must be zero for a bar, or positive and less than half of the shorter side of " + std::to_string(shorter));
  const double y_hole = wall > 0 ? y_length - 2 * wall : 0, z_hole = wall > 0 ? z_length - 2 * wall : 0;
  BeamSection section;
  section.area = y_length * z_length - y_hole * z_hole;
  section.iz = (z_length * std::pow(y_length, 3) - z_hole * std::pow(y_hole, 3)) / 12;
  section.iy = (y_length * std::pow(z_length, 3) - y_hole * std::pow(z_hole, 3)) / 12;
  section.y_extent = y_length / 2;
  section.z_extent = z_length / 2;
  if (wall > 0) {
    const double y_middle = y_length - wall, z_middle = z_length - wall, enclosed = y_middle * z_middle;
    section.torsion = 2 * wall * enclosed * enclosed / (y_middle + z_middle);
    section.torsion_modulus = 2 * enclosed * wall;
    return section;
  }
  double constant = 0, stress = 0;  // Saint-Venant's series; the shear stress is largest half-way along the longer side
  for (int n = 1; n < 40; n += 2) {
    const double at = n * kPi * longer / (2 * shorter);
    constant += std::tanh(at) / std::pow(n, 5);
    stress += at < 300 ? 1 / (n * n * std::cosh(at)) : 0;
  }
  section.torsion = longer * std::pow(shorter, 3) / 3 * (1 - 192 / std::pow(kPi, 5) * shorter / longer * constant);
  section.torsion_modulus = section.torsion / (shorter * (1 - 8 / (kPi * kPi) * stress));
  return section;
}

}  // namespace mmgrasp
