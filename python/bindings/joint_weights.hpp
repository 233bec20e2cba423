#pragma once

#include <string>

#include "bindings.hpp"
#include "mmgrasp/robot/joint_weights.hpp"

namespace mmgrasp::python {

/// An array with a weight per joint, a dict by joint name, or None.
void convert(const py::handle& value, const std::string& name, JointWeights& out);
py::object weights_object(const JointWeights& weights);

/// The keyword `joint_weights`.
template <typename Options>
OptionField<Options> joint_weights_option(JointWeights Options::*member) {
  return {"joint_weights", "numpy.typing.ArrayLike | collections.abc.Mapping[str, float] | None",
          [=](Options& o, const py::handle& v) { convert(v, "joint_weights", o.*member); },
          [=](const Options& o) { return weights_object(o.*member); },
          "what a motion of each joint costs in the length of a path, (n,) or by joint name (others: 1), each > 0; "
          "None: 1"};
}

}  // namespace mmgrasp::python
