#include "bindings.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace mmgrasp::python;
  m.doc() = "The C++ library behind mmgrasp. Import names from mmgrasp itself.";
  m.attr("__version__") = MMGRASP_VERSION;
  bind_core(m);
  bind_geometry(m);
  bind_optim(m);
  bind_robot(m);
  bind_collision(m);
  bind_reach(m);
  bind_grasp(m);
  bind_plan(m);
  bind_task(m);
  bind_verify(m);
}
