#pragma once

#include <string>

#include "arrays.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::python {

/// (n,), also infinite or NaN; size < 0 takes any length.
inline Eigen::VectorXd any_numbers(const py::handle& value, const std::string& name, Eigen::Index size,
                                   const std::string& like = "") {
  const py::array given = plain_array(value, name);
  if (!given || std::string("fiub").find(given.dtype().kind()) == std::string::npos) {
    throw InvalidInput(name + ": must be an array of numbers");
  }
  if (given.ndim() != 1 || (size >= 0 && given.shape(0) != size)) {
    throw InvalidInput(name + " has shape " + std::string(py::str(given.attr("shape"))) + ": must be (" +
                       (size >= 0 ? std::to_string(size) : "n") + ",)" + like);
  }
  return py::cast<Eigen::VectorXd>(py::array_t<double, py::array::forcecast>(given));
}

}  // namespace mmgrasp::python
