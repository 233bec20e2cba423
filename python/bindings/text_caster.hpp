#pragma once

// Included before everything else (CMakeLists.txt): all files must convert texts alike.

#include <pybind11/pybind11.h>

#include <string>

namespace pybind11::detail {

/// Texts are str. pybind11 itself takes bytes as well, whatever their encoding.
template <>
struct type_caster<std::string> : string_caster<std::string> {
  bool load(handle source, bool convert) {
    const bool is_text = source && PyUnicode_Check(source.ptr());
    return is_text && string_caster<std::string>::load(source, convert);
  }
};

}  // namespace pybind11::detail
