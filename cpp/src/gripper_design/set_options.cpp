#include "gripper_design/set_options.hpp"

namespace mmgrasp::detail {

MinimalGrippersOptions set_options(const PlanGrippersOptions& options) {
  MinimalGrippersOptions out;
  out.shortest_finger = options.shortest_finger;
  out.longest_finger = options.longest_finger;
  out.opening_margin = options.opening_margin;
  out.length_margin = options.length_margin;
  out.finger_width = options.finger_width;
  out.finger_thickness = options.finger_thickness;
  out.change_cost = options.change_cost;
  out.max_nodes = options.max_nodes;
  out.time_limit = options.time_limit;
  return out;
}

}  // namespace mmgrasp::detail
