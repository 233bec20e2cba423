// Checks of one operation: its load and what a grasp does about it, parts that stand in each other, the rehearsal.
#include "arrays.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/gripper_design/operation_load.hpp"
#include "mmgrasp/gripper_design/operation_overlap.hpp"
#include "mmgrasp/gripper_design/rehearse_operation.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

std::string shown(double value) {
  return py::cast<std::string>(py::repr(py::float_(value)));
}

void bind_load(py::module_& m) {
  using H = HoldingRequirement;
  py::class_<H>(m, "HoldingRequirement",
                "Grasps are to hold the weight of their parts and the resistance of holes.\n\n"
                "    HoldingRequirement(FingerGrip(force=40), density=2700, least_safety=1.5)")
      .def(py::init([](const Given<FingerGrip>& grip, const Given<double>& density, const Given<double>& safety) {
             const H out{taken(grip, "grip"), taken(density, "density"), taken(safety, "least_safety")};
             out.check();
             return out;
           }),
           "grip"_a, py::kw_only(), "density"_a = H{}.density, "least_safety"_a = H{}.least_safety,
           "How fingers press, density of all parts [kg/m3], the least factor by which loads may grow.")
      .def_readonly("grip", &H::grip, "How fingers press.")
      .def_readonly("density", &H::density, "All parts have this density [kg/m3].")
      .def_readonly("least_safety", &H::least_safety,
                    "Grasps that hold less than this many times the load are refused.")
      .def("__repr__", [](const H& h) { return "HoldingRequirement(least_safety " + shown(h.least_safety) + ")"; });
  using L = OperationLoad;
  py::class_<L>(m, "OperationLoad", "Weight and insertion of one operation, in the frame of its active subassembly.")
      .def_readonly("grip", &L::grip, "How fingers press.")
      .def_readonly("mass", &L::mass, "The active parts weigh this [kg].")
      .def_readonly("weights", &L::weights, "One (3,) per pose of the motion: gravity turns with it [N].")
      .def_property_readonly(
          "centre", [](const L& l) { return Eigen::Vector3d(l.centre); }, "Centre of mass [m], (3,).")
      .def_property_readonly(
          "resistance", [](const L& l) { return Eigen::Vector3d(l.resistance); },
          "The hole pushes with this, at the end [N], (3,).")
      .def_property_readonly(
          "hole", [](const L& l) { return Eigen::Vector3d(l.hole); }, "A point on its axis [m], (3,).")
      .def("__repr__", [](const L& l) { return "OperationLoad(" + shown(l.mass) + " kg)"; });
  using D = HeldLoad;
  py::class_<D>(m, "HeldLoad", "What a grasp does about the load of its operation.")
      .def_readonly("safety", &D::safety,
                    "The loads may grow at least by this factor before a pad slips, on the way and at its end.")
      .def_readonly("insertion_moment", &D::insertion_moment,
                    "The resistance has this moment about the middle between the pads [N m].")
      .def_readonly("pad_torque", &D::pad_torque,
                    "About its normal, that a pad holds beside the forces it carries at the end [N m].")
      .def_readonly("contact_area", &D::contact_area, "One pad touches this much [m2].")
      .def("__repr__", [](const D& d) { return "HeldLoad(safety " + shown(d.safety) + ")"; });
  m.def(
      "operation_load",
      [](const Given<AssemblyOperation>& operation, const Given<HoldingRequirement>& requirement) {
        return operation_load(taken(operation, "operation"), taken(requirement, "requirement"));
      },
      "operation"_a, "requirement"_a,
      "The load of an operation; gravity acts along -z of the passive subassembly. InvalidInput for an active part "
      "whose mesh is not closed: it has no volume.");
  m.def(
      "held_load",
      [](const Given<AssemblyGrasp>& grasp, const Given<OperationLoad>& load) {
        return held_load(taken(grasp, "grasp"), taken(load, "load"));
      },
      "grasp"_a, "load"_a,
      "What a grasp, in the frame of the active subassembly, does about a load: the least safety over motion and end, "
      "the rest at the end (see grasp_holding).");
}

void bind_overlap(py::module_& m) {
  using O = OperationOverlap;
  py::class_<O>(m, "OperationOverlap",
                "How deep the active and the passive parts of an operation stand in each other, where it is deepest.")
      .def_readonly("depth", &O::depth, "A point of one part's surface lies this deep in the other [m]; 0: nowhere.")
      .def_readonly("active", &O::active, "The moved part; '' where depth is 0.")
      .def_readonly("passive", &O::passive, "The other one.")
      .def_readonly("before_end", &O::before_end,
                    "The way of the moved parts' middle that is left when it happens [m].")
      .def("__repr__", [](const O& o) {
        return o.depth == 0 ? std::string("OperationOverlap(none)")
                            : "OperationOverlap(" + o.active + " " + shown(o.depth) + " m in " + o.passive + ")";
      });
  m.def(
      "operation_overlap",
      [](const Given<AssemblyOperation>& operation, const Given<double>& allowed, const Progress& progress) {
        const AssemblyOperation given = taken(operation, "operation");
        const double most = taken(allowed, "allowed");
        return LongCall(progress).run([&](const Monitor& monitor) { return operation_overlap(given, most, monitor); });
      },
      "operation"_a, py::kw_only(), "allowed"_a = 0.0, "progress"_a = py::none(),
      "The deepest overlap at the end of an operation or, if that is at most `allowed` [m], along its motion (every 2 "
      "mm and 0.05 rad, from the end back to the first look that is deeper). Judged at corners and points drawn over "
      "the surfaces, so that what it tells is there; what is thinner than their distance may be missed.");
}

}  // namespace

void bind_operation_checks(py::module_& m) {
  bind_load(m);
  bind_overlap(m);
  m.def(
      "free_gripper",
      [](const Given<Gripper>& gripper) {
        const Gripper g = taken(gripper, "gripper");
        return interruptible([&] { return free_gripper(g); });
      },
      "gripper"_a,
      "A gripper, read from its own files, on six joints that carry its base anywhere: x, y, z [m], then yaw, pitch, "
      "roll [rad]. The fingers' joint is \"finger_1_joint\".");
  m.def(
      "rehearse_operation",
      [](const Given<Gripper>& gripper, const Given<AssemblyGrasp>& grasp, const Given<AssemblyOperation>& operation) {
        const Gripper g = taken(gripper, "gripper");
        const AssemblyGrasp held = taken(grasp, "grasp");
        const AssemblyOperation o = taken(operation, "operation");
        return interruptible([&] { return rehearse_operation(g, held, o); });
      },
      "gripper"_a, "grasp"_a, "operation"_a,
      "What a gripper meets first when it goes through an operation, told by the collision checker: while it "
      "approaches "
      "from 0.1 m away, grasps, moves, and lets go and moves back as far. '' when nothing.");
}

}  // namespace mmgrasp::python
