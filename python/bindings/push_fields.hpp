#pragma once

#include "bindings.hpp"
#include "mmgrasp/grasp/push_grasp.hpp"

namespace mmgrasp::python {

/// Keywords of push_grasp.
const std::vector<OptionField<PushGraspProblem>>& push_fields();

/// A ClosingOutcome as a dict of plain numbers.
py::dict outcome_dict(const ClosingOutcome& outcome);

}  // namespace mmgrasp::python
