#include "options.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "mmgrasp/core/limits.hpp"

namespace mmgrasp::python {
namespace {

constexpr std::size_t kLongest = 200;  // Characters of a value in a message.

// Keywords of earlier versions by what they are called now.
const std::multimap<std::string, std::string> kRenamed = {{"attempt_time_limit", "solve_time_limit"},
                                                          {"attempts", "draws"},
                                                          {"attempts", "seeds"},
                                                          {"choices", "grasp_assignments"},
                                                          {"edge_step", "joint_step"},
                                                          {"free", "free_axes"},
                                                          {"gap", "clearance"},
                                                          {"held_only", "attached_only"},
                                                          {"improved", "on_solution"},
                                                          {"look_out", "constraint_distance"},
                                                          {"max_joint_step", "jump_threshold"},
                                                          {"max_samples", "max_iterations"},
                                                          {"scene", "world"},
                                                          {"stands", "goal_configurations"},
                                                          {"tool_cone", "orientation_constraint"}};

}  // namespace

std::string nearest_name(const std::string& wrong, const std::vector<std::string>& known) {
  // These are arguments of their own and not among the options.
  const bool argument = wrong == "improved" || wrong == "tool_cone" || wrong == "scene";
  const auto [first, last] = kRenamed.equal_range(wrong);
  for (auto renamed = first; renamed != last; ++renamed)
    if (argument || std::find(known.begin(), known.end(), renamed->second) != known.end())
      return "; it is called " + renamed->second + " now";
  const py::list matches = py::module_::import("difflib").attr("get_close_matches")(wrong, known, 1, 0.5);
  if (!matches.empty()) return "; did you mean " + py::cast<std::string>(matches[0]) + "?";
  std::string all = "; known are ";
  for (std::size_t i = 0; i < known.size(); ++i) all += (i ? ", " : "") + known[i];
  return all;
}

void refuse_unknown(const char* function, const py::kwargs& unknown, const std::vector<std::string>& known) {
  for (const auto& [key, value] : unknown) {
    const std::string name = py::cast<std::string>(key);
    throw InvalidInput(std::string(function) + "(" + name + "=...): unknown keyword" + nearest_name(name, known));
  }
}

void refuse_value(const std::string& name, const py::handle& value, const char* rule) {
  const py::object given = py::repr(value);
  const bool whole = py::len(given) <= kLongest;
  const auto shown = py::cast<std::string>(whole ? given : py::object(given[py::slice(0, kLongest, 1)]));
  throw InvalidInput(name + " = " + shown + (whole ? "" : "...") + ": must be " + rule);
}

py::object function_argument(py::object value, const char* name) {
  if (!value.is_none() && PyCallable_Check(value.ptr()) == 0) refuse_value(name, value, "a function, or None");
  return value;
}

namespace {

/// True and False, of NumPy's kind as well: they are numbers to Python.
bool is_truth_value(const py::handle& value) {
  const std::string_view kind = Py_TYPE(value.ptr())->tp_name;
  return PyBool_Check(value.ptr()) || kind == "numpy.bool" || kind == "numpy.bool_";
}

}  // namespace

void convert(const py::handle& value, const std::string& name, double& out) {
  if (is_truth_value(value) ||
      !(PyFloat_Check(value.ptr()) || PyIndex_Check(value.ptr()) || PyObject_HasAttrString(value.ptr(), "__float__"))) {
    refuse_value(name, value, "a number");
  }
  out = py::cast<double>(value);
  if (!std::isfinite(out)) refuse_value(name, value, "finite");
  require_number(out, name, "", kLargestNumber);
}

void convert(const py::handle& value, const std::string& name, std::int64_t& out) {
  const bool whole =
      PyFloat_Check(value.ptr()) && std::floor(PyFloat_AS_DOUBLE(value.ptr())) == PyFloat_AS_DOUBLE(value.ptr());
  if (is_truth_value(value) || !(whole || PyIndex_Check(value.ptr()))) refuse_value(name, value, "a whole number");
  const double number = py::cast<double>(value);
  if (!(std::abs(number) < 9e15)) refuse_value(name, value, "a whole number below 9e15");
  out = whole ? static_cast<std::int64_t>(number)
              : py::cast<std::int64_t>(py::int_(py::reinterpret_borrow<py::object>(value)));
}

void convert(const py::handle& value, const std::string& name, int& out) {
  std::int64_t wide = 0;
  convert(value, name, wide);
  if (wide < INT32_MIN || wide > INT32_MAX) refuse_value(name, value, "a 32-bit whole number");
  out = static_cast<int>(wide);
}

void convert(const py::handle& value, const std::string& name, unsigned& out) {
  std::int64_t wide = 0;
  convert(value, name, wide);
  if (wide < 0 || wide > UINT32_MAX) refuse_value(name, value, "a whole number in [0, 4294967295]");
  out = static_cast<unsigned>(wide);
}

void convert(const py::handle& value, const std::string& name, bool& out) {
  if (!PyBool_Check(value.ptr())) refuse_value(name, value, "True or False");
  out = py::cast<bool>(value);
}

void convert(const py::handle& value, const std::string& name, std::string& out) {
  if (!PyUnicode_Check(value.ptr())) refuse_value(name, value, "a string");
  out = py::cast<std::string>(value);
}

}  // namespace mmgrasp::python
