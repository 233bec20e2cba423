#pragma once

#include <string>

namespace mmgrasp::detail {

/// A length [m] as "12.5 mm", to so many digits.
std::string millimetres(double length, int digits = 4);

/// The next length of whole hundredths of a millimetre that is no shorter, or no longer [m]: what is advised must be
/// right as it is printed.
double hundredths_up(double length);
double hundredths_down(double length);

}  // namespace mmgrasp::detail
