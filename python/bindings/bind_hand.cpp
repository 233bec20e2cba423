#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::python {
namespace {

using Names = std::vector<std::string>;
using Shares = std::map<std::string, double>;

ClosingKind kind_argument(const std::string& name) {
  for (const ClosingKind kind : {ClosingKind::parallel, ClosingKind::angular, ClosingKind::adaptive})
    if (name == to_string(kind)) return kind;
  throw InvalidInput("kind = '" + name + "': must be 'parallel', 'angular' or 'adaptive'" +
                     nearest_name(name, {"parallel", "angular", "adaptive"}));
}

void bind_hand_joint(py::module_& m) {
  py::class_<HandJoint>(m, "HandJoint",
                        "A driven joint of a hand: how far it goes between closed and open [rad] or [m]. Joints of one "
                        "group move together.")
      .def(py::init([](std::string name, double closed, double open, std::string group) {
             HandJoint joint{std::move(name), closed, open, std::move(group)};
             joint.check("joint '" + joint.name + "'");
             return joint;
           }),
           py::arg("name"), py::arg("closed"), py::arg("open"), py::arg("group") = HandJoint{}.group,
           "See the properties of the same names.")
      .def_readonly("name", &HandJoint::name, "The robot's joint.")
      .def_readonly("closed", &HandJoint::closed, "Value while the fingers are closed.")
      .def_readonly("open", &HandJoint::open, "Value while they are open.")
      .def_readonly("group", &HandJoint::group, "Joints of one group move together.")
      .def("__repr__", [](const HandJoint& j) { return "HandJoint('" + j.name + "')"; });
}

void bind_hand_body(py::module_& m) {
  const HandBody own;
  py::class_<HandBody>(m, "HandBody", "Boxes around the fingers and the palm of a hand [m].")
      .def(py::init([](double finger_thickness, double finger_length, double palm_length, double palm_width) {
             const HandBody body{finger_thickness, finger_length, palm_length, palm_width};
             body.check();
             return body;
           }),
           py::kw_only(), py::arg("finger_thickness") = own.finger_thickness,
           py::arg("finger_length") = own.finger_length, py::arg("palm_length") = own.palm_length,
           py::arg("palm_width") = own.palm_width, "Sizes [m], > 0; see the properties of the same names.")
      .def_readonly("finger_thickness", &HandBody::finger_thickness, "Size of a finger along the closing axis.")
      .def_readonly("finger_length", &HandBody::finger_length, "From the finger tips back to the palm.")
      .def_readonly("palm_length", &HandBody::palm_length, "Size of the palm along the closing axis.")
      .def_readonly("palm_width", &HandBody::palm_width, "Size of the palm across it.")
      .def("__repr__", [](const HandBody& b) {
        return "HandBody(fingers " + std::string(py::repr(py::float_(b.finger_length))) + " m long)";
      });
}

Hand read_hand(const Robot& robot, const std::string& tool_link, const std::string& group,
               const std::optional<ArrayLike>& approach, const std::optional<ArrayLike>& closing, double clearance,
               int postures) {
  HandReading reading;
  reading.group = group;
  if (approach) reading.approach = vector3_argument(*approach, "approach");
  if (closing) reading.closing = vector3_argument(*closing, "closing");
  reading.clearance = clearance;
  reading.postures = postures;
  return interruptible([&] { return Hand::from_robot(robot, tool_link, reading); });
}

}  // namespace

void bind_hand(py::module_& m) {
  bind_hand_joint(m);
  bind_hand_body(m);
  const Hand own;
  const HandReading reading;
  py::class_<Hand>(
      m, "Hand",
      "The hand at the end of an arm: tool frame, approach and closing axis, and how its joints follow from "
      "the opening.\nThe tool frame's origin (tool centre point) lies midway between the pads' centres; a "
      "parallel gripper has one group\nof joints, linear in the opening.")
      .def(py::init([](const std::string& tool_link, const ArrayLike& approach, const ArrayLike& closing,
                       double max_opening, double finger_depth, double finger_width, double clearance,
                       std::vector<HandJoint> joints, Names finger_links, const std::string& kind, double min_opening,
                       std::vector<double> openings, Shares preshape, const std::optional<HandBody>& body,
                       double payload) {
             Hand hand;
             hand.tool_link = tool_link;
             hand.approach = vector3_argument(approach, "approach");
             hand.closing = vector3_argument(closing, "closing");
             hand.kind = kind_argument(kind);
             hand.min_opening = min_opening;
             hand.max_opening = max_opening;
             hand.finger_depth = finger_depth;
             hand.finger_width = finger_width;
             hand.clearance = clearance;
             hand.joints = std::move(joints);
             hand.openings = std::move(openings);
             hand.preshape = std::move(preshape);
             hand.finger_links = std::move(finger_links);
             if (body) hand.body = *body;
             hand.payload = payload;
             hand.check();
             return hand;
           }),
           py::arg("tool_link"), py::kw_only(), py::arg("approach"), py::arg("closing"), py::arg("max_opening"),
           py::arg("finger_depth"), py::arg("finger_width"), py::arg("clearance") = own.clearance,
           py::arg("joints") = std::vector<HandJoint>{}, py::arg("finger_links") = Names{},
           py::arg("kind") = to_string(own.kind), py::arg("min_opening") = own.min_opening,
           py::arg("openings") = std::vector<double>{}, py::arg("preshape") = Shares{}, py::arg("body") = py::none(),
           py::arg("payload") = own.payload,
           "A hand by its numbers, each described at the property of its name; `body` None: fingers of 12 cm before a "
           "palm "
           "of 13 x 6.5 cm.")
      .def_static(
          "from_robot", &read_hand, py::arg("robot"), py::arg("tool_link"), py::kw_only(), py::arg("group") = "",
          py::arg("approach") = py::none(), py::arg("closing") = py::none(), py::arg("clearance") = reading.clearance,
          py::arg("postures") = reading.postures,
          "A hand read from a robot that was loaded with its meshes: axes, ends of the joints, openings and body "
          "are measured\nby forward kinematics between the collision shapes of the finger tips. `group` is an "
          "SRDF end effector or group; ''\ntakes every joint below the tool link's body.")
      .def_static(
          "of_cups",
          [](const std::string& tool_link, const ArrayLike& approach, const Suction& suction, const Names& cup_links,
             double payload) {
            Hand hand = Hand::of_cups(tool_link, vector3_argument(approach, "approach"), suction, cup_links);
            hand.payload = payload;
            hand.check();
            return hand;
          },
          py::arg("tool_link"), py::kw_only(), py::arg("approach"), py::arg("suction"), py::arg("cup_links") = Names{},
          py::arg("payload") = own.payload,
          "A hand of suction cups that face along `approach` (3,) of the tool frame; `cup_links` may touch the "
          "attached "
          "part.")
      .def(
          "with_payload",
          [](Hand hand, double payload) {
            hand.payload = payload;
            hand.check();
            return hand;
          },
          py::arg("payload"), "The same hand with another payload [kg], > 0; inf: none is stated.")
      .def(
          "with_finger_depth",
          [](Hand hand, double finger_depth) {
            hand.finger_depth = finger_depth;
            hand.check_fingers();
            return hand;
          },
          py::arg("finger_depth"), "The same hand with pads of another length along the approach [m], > 0.")
      .def_readonly("tool_link", &Hand::tool_link, "Link whose frame is the tool frame.")
      .def_readonly("approach", &Hand::approach, "Unit axis of the tool frame along which the hand moves in.")
      .def_readonly("closing", &Hand::closing, "Unit axis of the tool frame along which the pads close.")
      .def_property_readonly(
          "kind", [](const Hand& h) { return to_string(h.kind); }, "'parallel', 'angular' or 'adaptive'.")
      .def_readonly("min_opening", &Hand::min_opening, "Thinnest part that is held [m].")
      .def_readonly("max_opening", &Hand::max_opening, "Widest part that fits [m].")
      .def_readonly("finger_depth", &Hand::finger_depth, "Pad length along the approach axis [m].")
      .def_readonly("finger_width", &Hand::finger_width, "Pad size across approach and closing [m].")
      .def_readonly("clearance", &Hand::clearance, "Kept free on each side of the part while moving in [m].")
      .def_readonly("joints", &Hand::joints, "The driven joints with their values closed and open.")
      .def_readonly("openings", &Hand::openings, "Openings at equal steps of the joints [m]; empty: linear in them.")
      .def_readonly("preshape", &Hand::preshape, "Groups that the opening does not move, and how far open they stay.")
      .def_readonly("finger_links", &Hand::finger_links, "Links that may touch the attached part.")
      .def_readonly("body", &Hand::body, "Boxes around fingers and palm.")
      .def_readonly("suction", &Hand::suction, "Cups in place of fingers; None: the hand has fingers.")
      .def_readonly("payload", &Hand::payload, "Heaviest part that hand and arm may carry [kg].")
      .def_property_readonly("groups", &Hand::groups, "Names of the joint groups.")
      .def("joint_values", py::overload_cast<double>(&Hand::joint_values, py::const_), py::arg("opening"),
           "Joint values at an opening [m].")
      .def("joint_values", py::overload_cast<const Grasp&>(&Hand::joint_values, py::const_), py::arg("grasp"),
           "Joint values while holding: those of the grasp's posture if it has one, else of its opening.")
      .def("posture_values", py::overload_cast<const std::vector<double>&>(&Hand::joint_values, py::const_),
           py::arg("posture"), "Joint values of a posture: for each of `groups` how far it is open, in [0, 1].")
      .def("share_open", &Hand::share_open, py::arg("opening"),
           "How far open the fingers are at an opening, in [0, 1].")
      .def("opening_at", &Hand::opening_at, py::arg("share_open"), "The opening at which they are so far open [m].")
      .def("pregrasp_opening", &Hand::pregrasp_opening, py::arg("width"),
           "Opening while moving in on a part of this width: with clearance on both sides, at most max_opening [m].")
      .def("shapes", &Hand::shapes, py::arg("opening"), "Left and right finger and palm as boxes in the tool frame.")
      .def("__repr__", [](const Hand& h) {
        if (h.suction)
          return "Hand('" + h.tool_link + "', " + std::to_string(h.suction->cups.size()) + " suction cups)";
        return "Hand('" + h.tool_link + "', opens " + std::string(py::repr(py::float_(h.max_opening))) + " m)";
      });
}

}  // namespace mmgrasp::python
