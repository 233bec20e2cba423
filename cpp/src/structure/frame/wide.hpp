#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

namespace mmgrasp::detail {

/// A number of 34 decimals, for the few frames that lose their answer in 16.
using Wide = boost::multiprecision::cpp_bin_float_quad;

}  // namespace mmgrasp::detail
