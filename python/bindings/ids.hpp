#pragma once

#include <pybind11/pybind11.h>

#include <utility>
#include <vector>

#include "mmgrasp/task/ids.hpp"

namespace mmgrasp::python {

/// Parts given as (tray, part).
inline std::vector<PartRef> parts_argument(const std::vector<std::pair<int, int>>& tray_and_part) {
  std::vector<PartRef> parts;
  for (const auto& [tray, part] : tray_and_part) parts.push_back({TrayId(tray), part});
  return parts;
}

}  // namespace mmgrasp::python

namespace pybind11::detail {

/// To Python a tray's id is its index. (There is no load(): arguments take numbers.)
template <>
struct type_caster<mmgrasp::TrayId> {
  PYBIND11_TYPE_CASTER(mmgrasp::TrayId, const_name("int"));

  static handle cast(mmgrasp::TrayId id, return_value_policy, handle) { return PyLong_FromLong(id); }
};

}  // namespace pybind11::detail
