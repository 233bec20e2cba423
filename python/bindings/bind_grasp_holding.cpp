// Soft fingers: what they touch, and what they hold against weight and insertion.
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/gripper_design/grasp_holding.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

double limit_of(const std::optional<Given<double>>& value, const char* name) {
  return value ? taken(*value, name) : detail::kInfinity;
}

Eigen::Vector3d given_or_zero(const OptionalArray& value, const char* name) {
  return value.is_none() ? Eigen::Vector3d::Zero() : vector3_argument(value, name);
}

void bind_contact_area(py::module_& m) {
  py::class_<ContactArea>(m, "ContactArea", "Where a soft pad touches: a rectangle along and across the approach.")
      .def_readonly("length", &ContactArea::length, "Along the approach [m].")
      .def_readonly("width", &ContactArea::width, "Across it [m].")
      .def_readonly("torsion_radius", &ContactArea::torsion_radius,
                    "Mean distance from the middle, weighted by pressure: the largest torque about the normal is "
                    "friction times normal force times this [m].")
      .def_property_readonly("area", &ContactArea::area, "[m2]")
      .def("__repr__", [](const ContactArea& c) {
        const auto shown = [](double v) { return std::string(py::repr(py::float_(v))); };
        return "ContactArea(" + shown(c.length) + " x " + shown(c.width) + " m)";
      });
  m.def(
      "flat_contact",
      [](const Given<double>& length, const Given<double>& width) {
        return flat_contact(taken(length, "length"), taken(width, "width"));
      },
      "length"_a, "width"_a, "A flat pad on a flat face, pressed evenly; both sides are positive [m].");
  m.def(
      "line_contact",
      [](const Given<double>& force, const Given<double>& wall_radius, const Given<double>& length,
         const Given<double>& pad_width, const Given<double>& modulus, const std::optional<Given<double>>& pad_radius) {
        return line_contact(taken(force, "force"), taken(wall_radius, "wall_radius"), taken(length, "length"),
                            taken(pad_width, "pad_width"), taken(modulus, "modulus"),
                            limit_of(pad_radius, "pad_radius"));
      },
      "force"_a, "wall_radius"_a, "length"_a, py::kw_only(), "pad_width"_a, "modulus"_a, "pad_radius"_a = py::none(),
      "A pad on a round wall along its axis: Hertz' line contact (Johnson 1985, 4.2), no wider than the pad. Force "
      "[N], "
      "lengths [m], the modulus of both surfaces together [Pa]; `pad_radius`: of a hollow pad, None: a flat one.");
  m.def(
      "soft_finger_torque",
      [](const Given<double>& normal, const Given<double>& friction, const Given<double>& torsion_radius,
         const Given<double>& tangential) {
        return soft_finger_torque(taken(normal, "normal"), taken(friction, "friction"),
                                  taken(torsion_radius, "torsion_radius"), taken(tangential, "tangential"));
      },
      "normal"_a, "friction"_a, "torsion_radius"_a, "tangential"_a = 0.0,
      "The torque about its normal that a soft contact holds beside a tangential force [N m], by the ellipsoid that "
      "stands for the limit surface (Howe and Cutkosky 1996). Forces [N], torsion_radius [m].");
}

void bind_holding(py::module_& m) {
  using F = FingerGrip;
  py::class_<F>(m, "FingerGrip",
                "How fingers press and what their pads are made of.\n\n"
                "    FingerGrip(force=40, friction=0.6, modulus=3e6)")
      .def(
          py::init([](const Given<double>& force, const Given<double>& friction, const Given<double>& modulus,
                      const std::optional<Given<double>>& pad_radius) {
            const F grip{taken(force, "force"), taken(friction, "friction"), taken(modulus, "modulus"),
                         limit_of(pad_radius, "pad_radius")};
            grip.check();
            return grip;
          }),
          py::kw_only(), "force"_a = F{}.force, "friction"_a = F{}.friction, "modulus"_a = F{}.modulus,
          "pad_radius"_a = py::none(),
          "Force of each finger [N], Coulomb's coefficient, plane strain modulus of pad and part together [Pa], radius "
          "of hollow pads [m] (None: flat).")
      .def_readonly("force", &F::force, "Force of each finger [N].")
      .def_readonly("friction", &F::friction, "Coulomb's coefficient between pad and part.")
      .def_readonly("modulus", &F::modulus, "Plane strain modulus of pad and part together [Pa].")
      .def_property_readonly(
          "pad_radius",
          [](const F& f) {
            return OptionalNumber(f.pad_radius < detail::kInfinity ? py::object(py::float_(f.pad_radius)) : py::none());
          },
          "Radius of hollow pads [m]; None: flat.")
      .def("__repr__", [](const F& f) {
        const auto shown = [](double v) { return std::string(py::repr(py::float_(v))); };
        return "FingerGrip(" + shown(f.force) + " N, friction " + shown(f.friction) + ")";
      });
  using H = GraspHolding;
  py::class_<H>(m, "GraspHolding", "What a grasp does about the loads of its operation.")
      .def_readonly("contact", &H::contact, "One pad's.")
      .def_readonly("pad_torque", &H::pad_torque,
                    "Torque about its normal that a pad holds beside the forces it carries; least of all pads [N m].")
      .def_readonly(
          "insertion_moment", &H::insertion_moment,
          "Moment of the insertion's resistance about the middle between the pads [N m]; 0: fingers stand evenly "
          "about the hole's axis.")
      .def_readonly("safety", &H::safety,
                    "The loads may grow at least by this factor before a pad slips; infinite without loads.")
      .def("__repr__",
           [](const H& h) { return "GraspHolding(safety " + std::string(py::repr(py::float_(h.safety))) + ")"; });
  m.def(
      "grasp_holding",
      [](const Given<AssemblyGrasp>& grasp, const Given<FingerGrip>& grip, const OptionalArray& weight,
         const OptionalArray& centre, const OptionalArray& resistance, const OptionalArray& hole) {
        const AssemblyLoad load{given_or_zero(weight, "weight"), given_or_zero(centre, "centre"),
                                given_or_zero(resistance, "resistance"), given_or_zero(hole, "hole")};
        return grasp_holding(taken(grasp, "grasp"), taken(grip, "grip"), load);
      },
      "grasp"_a, "grip"_a, py::kw_only(), "weight"_a = py::none(), "centre"_a = py::none(), "resistance"_a = py::none(),
      "hole"_a = py::none(),
      "Whether soft fingers hold a part against its weight, and against weight and insertion (P1 5.3.5). `weight` [N] "
      "acts at `centre` [m], `resistance` of the insertion [N], against the motion, at `hole` [m], a point on the "
      "hole's "
      "axis; (3,), in the frame of the grasp's pose, None: zero. The grasp must know its contact_length and "
      "contact_width. Loads are shared so that the sum of squares is least, which bounds what can be held from below; "
      "pads slip by the limit surface of soft_finger_torque.");
}

}  // namespace

void bind_grasp_holding(py::module_& m) {
  bind_contact_area(m);
  bind_holding(m);
}

}  // namespace mmgrasp::python
