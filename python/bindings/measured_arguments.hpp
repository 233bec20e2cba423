#pragma once

#include <string>
#include <vector>

#include "arrays.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::python {

/// An array of real numbers as T, in which NaN and infinity may stand for what was not measured.
template <typename T>
py::array_t<T, py::array::c_style> measured_argument(const py::object& value, const std::string& name) {
  const py::array raw = plain_array(value, name);
  if (!raw || std::string("fiu").find(raw.dtype().kind()) == std::string::npos) {
    throw InvalidInput(name + ": must be an array of real numbers");
  }
  return py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(raw);
}

/// (n, 3) or (rows, columns, 3).
inline std::vector<Eigen::Vector3d> points_argument(const py::object& value, const std::string& name) {
  const auto array = measured_argument<double>(value, name);
  const bool rows = (array.ndim() == 2 || array.ndim() == 3) && array.shape(array.ndim() - 1) == 3;
  if (!rows) throw InvalidInput(name + ": must have the shape (n, 3) or (rows, columns, 3)");
  std::vector<Eigen::Vector3d> points(array.size() / 3);
  if (!points.empty()) std::copy(array.data(), array.data() + array.size(), points[0].data());
  return points;
}

}  // namespace mmgrasp::python
