#include "gripper_design/millimetres.hpp"

#include <cmath>
#include <sstream>

namespace mmgrasp::detail {
namespace {

constexpr double kPerMetre = 1e5;   // Hundredths of a millimetre.
constexpr double kRounding = 1e-6;  // What sums are off by, in hundredths.

}  // namespace

std::string millimetres(double length, int digits) {
  std::ostringstream out;
  out.precision(digits);
  out << 1e3 * length << " mm";
  return out.str();
}

double hundredths_up(double length) {
  return std::ceil(kPerMetre * length - kRounding) / kPerMetre;
}

double hundredths_down(double length) {
  return std::floor(kPerMetre * length + kRounding) / kPerMetre;
}

}  // namespace mmgrasp::detail
