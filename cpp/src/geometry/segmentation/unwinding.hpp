#pragma once

#include <complex>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// An edge round an axis: its angle and height, and how long it is.
struct HelixTurn {
  double angle, height, length;
  int edge;
};

/// The sum of the edges' lengths as arrows at their angles, once the winding is taken off them: as long as all edges
/// together where these come to lie at one angle. `winding` [rad/m].
MMGRASP_EXPORT std::complex<double> unwound(const std::vector<HelixTurn>& turns, double winding);

/// Which winding of either sense, of size `least`, `least` + `step`, ... up to `most`, makes unwound() longest.
///
/// All are told together by a fast Fourier transform of the arrows over the height, each shared out between the four
/// cells about it by cubic interpolation: off by 6e-4 of all edges' length at most.
MMGRASP_EXPORT double longest_unwound(const std::vector<HelixTurn>& turns, double least, double most, double step);

}  // namespace mmgrasp::detail
