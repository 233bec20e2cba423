#include "joint_weights.hpp"

namespace mmgrasp::python {

void convert(const py::handle& value, const std::string& name, JointWeights& out) {
  out = {};
  if (value.is_none()) return;
  if (PyMapping_Check(value.ptr()) == 0 || !py::hasattr(value, "keys")) {
    out.values = vector_argument(value, name);
    if (out.values.size() == 0) refuse_value(name, value, "one number per joint, a dict by joint name, or None");
    return;
  }
  for (const auto& [key, weight] : py::dict(py::reinterpret_borrow<py::object>(value))) {
    const std::string joint = py::str(key);
    convert(weight, name + "['" + joint + "']", out.by_name[joint]);
  }
}

py::object weights_object(const JointWeights& weights) {
  if (weights.values.size() > 0) return py::cast(weights.values).attr("tolist")();
  if (!weights.by_name.empty()) return py::cast(weights.by_name);
  return py::none();
}

}  // namespace mmgrasp::python
