#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::python {

namespace py = pybind11;

/// One keyword of an options struct. Defaults live in the C++ struct alone; this table reads and writes them.
template <typename Options>
struct OptionField {
  std::string name;
  std::string type;  ///< As a Python annotation.
  std::function<void(Options&, const py::handle&)> set;
  std::function<py::object(const Options&)> get;
  std::string help;
};

std::string nearest_name(const std::string& wrong, const std::vector<std::string>& known);
/// Keywords of a constructor beside those named; refuse_unknown() says what was probably meant.
using NoMoreKeywords = py::KWArgs<py::typing::Never>;
void refuse_unknown(const char* function, const py::kwargs& unknown, const std::vector<std::string>& known);
[[noreturn]] void refuse_value(const std::string& name, const py::handle& value, const char* rule);
/// A function that is called on the way, or None.
py::object function_argument(py::object value, const char* name);
void convert(const py::handle& value, const std::string& name, double& out);
void convert(const py::handle& value, const std::string& name, int& out);
void convert(const py::handle& value, const std::string& name, std::int64_t& out);
void convert(const py::handle& value, const std::string& name, unsigned& out);
void convert(const py::handle& value, const std::string& name, bool& out);
void convert(const py::handle& value, const std::string& name, std::string& out);

/// How annotations spell a type that convert() takes.
template <typename Value>
constexpr const char* annotation() {
  if constexpr (std::is_same_v<Value, bool>)
    return "bool";
  else if constexpr (std::is_integral_v<Value>)
    return "int";
  else if constexpr (std::is_floating_point_v<Value>)
    return "float";
  else {
    static_assert(std::is_same_v<Value, std::string>);
    return "str";
  }
}

template <typename Options, typename Outer, typename Value>
OptionField<Options> option(const char* name, Value Outer::*member, const char* help) {
  return {name, annotation<Value>(), [=](Options& o, const py::handle& v) { convert(v, name, o.*member); },
          [=](const Options& o) { return py::cast(o.*member); }, help};
}

/// A field of a struct inside the options.
template <typename Options, typename Inner, typename Value>
OptionField<Options> option(const char* name, Inner Options::*inner, Value Inner::*member, const char* help) {
  return {name, annotation<Value>(), [=](Options& o, const py::handle& v) { convert(v, name, o.*inner.*member); },
          [=](const Options& o) { return py::cast(o.*inner.*member); }, help};
}

template <typename Options>
std::vector<std::string> option_names(const std::vector<OptionField<Options>>& fields) {
  std::vector<std::string> names;
  for (const auto& field : fields) names.push_back(field.name);
  return names;
}

/// Options from keywords: unknown ones are refused with the nearest known name, then the struct's own check() runs.
template <typename Options>
Options read_options(const std::vector<OptionField<Options>>& fields, const py::kwargs& keywords,
                     const char* function) {
  Options options;
  for (const auto& [key, value] : keywords) {
    const std::string name = py::cast<std::string>(key);
    bool known = false;
    for (const auto& field : fields) {
      if (field.name != name) continue;
      field.set(options, value);
      known = true;
    }
    if (!known) {
      throw InvalidInput(std::string(function) + "(" + name + "=...): unknown keyword" +
                         nearest_name(name, option_names(fields)));
    }
  }
  options.check();
  return options;
}

/// {name: (default, help)}: the source of the docstrings and of the options page.
template <typename Options>
py::dict option_table(const std::vector<OptionField<Options>>& fields) {
  py::dict table;
  const Options defaults;
  for (const auto& field : fields) table[field.name.c_str()] = py::make_tuple(field.get(defaults), field.help);
  return table;
}

/// The docstring's list of keywords with the defaults of the C++ struct; the stubs' signatures are made from it.
template <typename Options>
std::string option_help(const std::vector<OptionField<Options>>& fields) {
  std::string out = "\n\nKeyword options:\n";
  const Options defaults;
  for (const auto& field : fields) {
    out += "    " + field.name + ": " + field.type + " = " + std::string(py::repr(field.get(defaults))) + "  # " +
           field.help + "\n";
  }
  return out;
}

}  // namespace mmgrasp::python
