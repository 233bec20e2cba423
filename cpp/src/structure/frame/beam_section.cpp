#include "mmgrasp/structure/beam_section.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using detail::kPi;

void require_positive(double value, const char* field, const char* unit) {
  if (std::isfinite(value) && value > 0) return;
  require(false, field, value, std::string("must be positive [") + unit + "]");
}

}  // namespace

void BeamMaterial::check() const {
  require(std::isfinite(density) && density >= 0, "density", density, "must be zero or positive [kg/m3]");
  require_positive(youngs_modulus, "youngs_modulus", "Pa");
  require_positive(shear_modulus, "shear_modulus", "Pa");
  require(std::isfinite(stress_limit) && stress_limit >= 0, "stress_limit", stress_limit,
          "must be positive [Pa], or zero for none");
}

BeamMaterial copper() {
  return {8960, 110e9, 40e9, 0};
}

void BeamSection::check() const {
  require_positive(area, "area", "m2");
  require_positive(iy, "iy", "m4");
  require_positive(iz, "iz", "m4");
  require_positive(torsion, "torsion", "m4");
  const auto extent = [](double value, const char* field) {
    require(std::isfinite(value) && value >= 0, field, value, "must be positive, or zero where it is not known");
  };
  extent(y_extent, "y_extent");
  extent(z_extent, "z_extent");
  extent(torsion_modulus, "torsion_modulus");
}

BeamSection round_section(double outer_diameter, double inner_diameter) {
  require_positive(outer_diameter, "outer_diameter", "m");
  require(std::isfinite(inner_diameter) && inner_diameter >= 0 && inner_diameter < outer_diameter, "inner_diameter",
          inner_diameter, "must be zero or positive and less than outer_diameter = " + std::to_string(outer_diameter));
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
  require_positive(y_length, "y_length", "m");
  require_positive(z_length, "z_length", "m");
  const double shorter = std::min(y_length, z_length), longer = std::max(y_length, z_length);
  require(std::isfinite(wall) && wall >= 0 && 2 * wall < shorter, "wall", wall,
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
