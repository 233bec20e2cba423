// Frames of beams: sections, materials, members, and how a held frame bends.
#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/structure/beam_frame.hpp"
#include "mmgrasp/structure/supported_frame.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

constexpr char kHeld[] =
    "mmgrasp._core.Grasp | mmgrasp._core.BeamSupport | "
    "collections.abc.Sequence[mmgrasp._core.Grasp | mmgrasp._core.BeamSupport]";
using Held = Shown<kHeld>;

BeamSupport one_support(const py::handle& value, const std::string& name) {
  if (py::isinstance<BeamSupport>(value)) return py::cast<BeamSupport>(value);
  if (py::isinstance<Grasp>(value)) return beam_support(py::cast<const Grasp&>(value));
  refuse_value(name, value, "a Grasp of a pipe or a BeamSupport");
}

std::vector<BeamSupport> supports_argument(const py::handle& value, const char* name) {
  if (!py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value)) return {one_support(value, name)};
  std::vector<BeamSupport> supports;
  for (const py::handle item : py::reinterpret_borrow<py::sequence>(value)) {
    supports.push_back(one_support(item, std::string(name) + "[" + std::to_string(supports.size()) + "]"));
  }
  return supports;
}

BeamMaterial make_beam_material(const Given<double>& density, const Given<double>& E, const Given<double>& G,
                                const Given<double>& limit) {
  const BeamMaterial material{taken(density, "density"), taken(E, "youngs_modulus"), taken(G, "shear_modulus"),
                              taken(limit, "stress_limit")};
  material.check();
  return material;
}

BeamMember make_beam_member(int first, int second, const Given<BeamSection>& section,
                            const Given<BeamMaterial>& material, const OptionalArray& y_towards) {
  BeamMember member;
  member.nodes = {first, second};
  member.section = taken(section, "section");
  member.material = taken(material, "material");
  if (!y_towards.is_none()) member.y_towards = vector3_argument(y_towards, "y_towards");
  return member;
}

BeamFrame make_beam_frame(const ArrayLike& nodes, const Given<std::vector<BeamMember>>& members,
                          const Given<std::vector<NodeLoad>>& loads) {
  BeamFrame frame;
  for (const Eigen::VectorXd& node : rows_argument(nodes, "nodes", 3)) frame.nodes.emplace_back(node);
  frame.members = taken(members, "members", "BeamMember");
  frame.loads = taken(loads, "loads", "NodeLoad");
  frame.check();
  return frame;
}

NodeLoad make_node_load(const Given<int>& node, const Given<double>& mass, const ArrayLike& force,
                        const ArrayLike& moment) {
  NodeLoad load;
  load.node = taken(node, "node");
  load.mass = taken(mass, "mass");
  load.force = vector3_argument(force, "force");
  load.moment = vector3_argument(moment, "moment");
  return load;
}

void bind_beam_parts(py::module_& m) {
  py::class_<BeamMaterial>(m, "BeamMaterial", "What a beam is made of.")
      .def(py::init(&make_beam_material), "density"_a, "youngs_modulus"_a, "shear_modulus"_a, "stress_limit"_a = 0.0,
           "[kg/m3], [Pa], [Pa], and the von Mises stress it may bear [Pa] (0: no limit is given).")
      .def_readonly("density", &BeamMaterial::density, "[kg/m3]")
      .def_readonly("youngs_modulus", &BeamMaterial::youngs_modulus, "[Pa]")
      .def_readonly("shear_modulus", &BeamMaterial::shear_modulus, "[Pa]")
      .def_readonly("stress_limit", &BeamMaterial::stress_limit, "[Pa]; 0: none is given.");
  m.def("copper", &copper, "The copper of P2 table 3.4, which gives no stress limit.");
  py::class_<BeamSection>(m, "BeamSection",
                          "Cross section of a beam along x: see round_section and rectangular_section.")
      .def(py::init([](const Given<double>& area, const Given<double>& iy, const Given<double>& iz,
                       const Given<double>& torsion) {
             BeamSection section;
             section.area = taken(area, "area");
             section.iy = taken(iy, "iy");
             section.iz = taken(iz, "iz");
             section.torsion = taken(torsion, "torsion");
             section.check();
             return section;
           }),
           "area"_a, "iy"_a, "iz"_a, "torsion"_a,
           "Any section by its area [m2], second moments about y and z and torsion constant [m4]; no stress is known.")
      .def_readonly("area", &BeamSection::area, "[m2]")
      .def_readonly("iy", &BeamSection::iy, "Second moment about y, for bending in z [m4].")
      .def_readonly("iz", &BeamSection::iz, "Second moment about z, for bending in y [m4].")
      .def_readonly("torsion", &BeamSection::torsion, "Torsion constant J [m4].");
  m.def(
      "round_section",
      [](const Given<double>& outer, const Given<double>& inner) {
        return round_section(taken(outer, "outer_diameter"), taken(inner, "inner_diameter"));
      },
      "outer_diameter"_a, "inner_diameter"_a = 0.0, "Tube by its diameters [m]; without an inner one a bar.");
  m.def(
      "rectangular_section",
      [](const Given<double>& y, const Given<double>& z, const Given<double>& wall) {
        return rectangular_section(taken(y, "y_length"), taken(z, "z_length"), taken(wall, "wall"));
      },
      "y_length"_a, "z_length"_a, "wall"_a = 0.0,
      "Rectangle by its outer lengths and its wall [m]; without a wall a bar. Torsion of tubes by Bredt (thin walls).");
  py::class_<BeamMember>(m, "BeamMember", "A straight beam welded to its two nodes.")
      .def(py::init([](const Given<int>& first, const Given<int>& second, const Given<BeamSection>& section,
                       const Given<BeamMaterial>& material, const OptionalArray& y_towards) {
             return make_beam_member(taken(first, "first"), taken(second, "second"), section, material, y_towards);
           }),
           "first"_a, "second"_a, "section"_a, "material"_a, "y_towards"_a = py::none(),
           "Nodes by index from 0; `y_towards`: the section's y is this direction turned across the member (None: the\n"
           "object's z, or its x for members along z).")
      .def_property_readonly(
          "nodes", [](const BeamMember& b) { return py::make_tuple(b.nodes[0], b.nodes[1]); }, "First and second node.")
      .def_readonly("section", &BeamMember::section, "Its cross section.")
      .def_readonly("material", &BeamMember::material, "What it is made of.");
  py::class_<NodeLoad>(m, "NodeLoad", "What hangs on a node: a mass (valve, flange), a force, a moment.")
      .def(py::init(&make_node_load), "node"_a, "mass"_a = 0.0, "force"_a = py::make_tuple(0.0, 0.0, 0.0),
           "moment"_a = py::make_tuple(0.0, 0.0, 0.0),
           "The mass's weight turns with gravity [kg]; force [N] and moment [N m] stay in the object's frame.")
      .def_readonly("node", &NodeLoad::node, "Index of the node.")
      .def_readonly("mass", &NodeLoad::mass, "[kg]")
      .def_property_readonly(
          "force", [](const NodeLoad& l) { return l.force; }, "Force in the object's frame [N].")
      .def_property_readonly(
          "moment", [](const NodeLoad& l) { return l.moment; }, "Moment in the object's frame [N m].");
  py::class_<BeamSupport>(m, "BeamSupport", "Where a frame is held: a hand, a fixture.")
      .def(py::init(
               [](const Given<int>& member, const Given<double>& distance, const Given<std::array<bool, 6>>& fixed) {
                 BeamSupport support;
                 support.member = taken(member, "member");
                 support.distance = taken(distance, "distance");
                 try {
                   support.fixed = py::cast<std::array<bool, 6>>(fixed);
                 } catch (const py::cast_error&) {
                   refuse_value("fixed", fixed, "six booleans");
                 }
                 return support;
               }),
           "member"_a, "distance"_a, "fixed"_a = py::make_tuple(true, true, true, true, true, true),
           "Distance along the member [m]; which of displacement in x, y, z and rotation about them (object's frame)\n"
           "are hindered: all, a clamp.")
      .def_readonly("member", &BeamSupport::member, "Index of the member.")
      .def_readonly("distance", &BeamSupport::distance, "From the member's first node [m].")
      .def_property_readonly(
          "fixed", [](const BeamSupport& s) { return std::vector<bool>(s.fixed.begin(), s.fixed.end()); },
          "Displacement in x, y, z, rotation about x, y, z.");
}

void bind_beam_results(py::module_& m) {
  py::class_<BeamExtreme>(m, "BeamExtreme", "A place on a frame and a value there.")
      .def_readonly("value", &BeamExtreme::value, "[m], [Pa] or a ratio.")
      .def_readonly("member", &BeamExtreme::member, "Index of the member.")
      .def_readonly("distance", &BeamExtreme::distance, "From the member's first node [m].")
      .def("__repr__", [](const BeamExtreme& e) {
        return "BeamExtreme(" + text(Eigen::VectorXd::Constant(1, e.value)) + " at " + std::to_string(e.distance) +
               " m on member " + std::to_string(e.member) + ")";
      });
  py::class_<BeamState>(m, "BeamState", "How a held frame bends under one load; all in the object's frame.")
      .def_property_readonly(
          "nodes", [](const BeamState& s) -> Eigen::MatrixXd { return s.nodes.transpose(); },
          "(n, 6) displacement [m] and rotation [rad] of each node.")
      .def_property_readonly(
          "reactions", [](const BeamState& s) -> Eigen::MatrixXd { return s.reactions.transpose(); },
          "(supports, 6) force [N] and moment [N m] of each support on the frame.")
      .def_readonly("displacement", &BeamState::displacement, "The largest anywhere along the members [m].")
      .def_readonly("stress", &BeamState::stress, "Largest von Mises stress [Pa]; None where sections are not known.")
      .def_readonly("over_limit", &BeamState::over_limit,
                    "Largest stress over its material's limit: above 1 it yields. None without a limit.");
}

void bind_supported_frame(py::module_& m) {
  py::class_<SupportedFrame>(m, "SupportedFrame", "A frame held at some places, factorised once for all orientations.")
      .def(py::init([](const Given<BeamFrame>& frame, const Held& held) {
             return SupportedFrame(taken(frame, "frame"), supports_argument(held, "supports"));
           }),
           "frame"_a, "supports"_a, "Clamped by grasps of a pipe, or held as supports say.")
      .def(
          "state", [](const SupportedFrame& f, const ArrayLike& g) { return f.state(vector3_argument(g, "gravity")); },
          "gravity"_a, "Under gravity given in the object's frame [m/s2].")
      .def(
          "largest_displacement",
          [](const SupportedFrame& f, const ArrayLike& g) {
            return f.largest_displacement(vector3_argument(g, "gravity"));
          },
          "gravity"_a, "The displacement of state() alone: quicker.")
      .def(
          "displacement",
          [](const SupportedFrame& f, const ArrayLike& g, const Given<int>& member, const Given<double>& distance) {
            return f.displacement(vector3_argument(g, "gravity"), taken(member, "member"), taken(distance, "distance"));
          },
          "gravity"_a, "member"_a, "distance"_a, "(3,) of a point on a member, in the object's frame [m].")
      .def(
          "section_forces",
          [](const SupportedFrame& f, const ArrayLike& g, const Given<int>& member, const Given<double>& distance) {
            return f.section_forces(vector3_argument(g, "gravity"), taken(member, "member"),
                                    taken(distance, "distance"));
          },
          "gravity"_a, "member"_a, "distance"_a,
          "(6,) N, Vy, Vz [N], torque, My, Mz [N m] in the member's frame at a cut.");
}

}  // namespace

void bind_beam_frame(py::module_& m) {
  bind_beam_parts(m);
  bind_beam_results(m);
  py::class_<BeamFrame>(
      m, "BeamFrame",
      "Straight Euler-Bernoulli beams welded at nodes, in the object's frame (P2 3.2.3.3.2).\n"
      "\n"
      "    pipe = mg.grasping.Pipe([[0, 0, 0], [0.4, 0, 0], [0.4, 0.3, 0]], [[0, 1], [1, 2]], 0.028)\n"
      "    frame = mg.grasping.beam_frame(pipe, inner_diameter=0.026, material=mg.grasping.copper())\n"
      "    state = frame.deflection(pipe.grasp(0, 0.2, 0.0), np.eye(4))")
      .def(py::init(&make_beam_frame), "nodes"_a, "members"_a, "loads"_a = py::list(),
           "(n, 3) nodes [m], BeamMembers, and NodeLoads. See beam_frame for a Pipe.")
      .def_property_readonly(
          "nodes", [](const BeamFrame& f) { return rows_to_array(f.nodes); }, "(n, 3) in the object's frame [m].")
      .def_readonly("members", &BeamFrame::members, "The beams.")
      .def_readonly("loads", &BeamFrame::loads, "What hangs on nodes.")
      .def_property_readonly("mass", &BeamFrame::mass, "Mass of members and loads [kg].")
      .def_property_readonly("centre_of_mass", &BeamFrame::centre_of_mass, "[m]")
      .def(
          "split",
          [](const BeamFrame& f, const Given<int>& member, const Given<double>& distance) {
            return f.split(taken(member, "member"), taken(distance, "distance"));
          },
          "member"_a, "distance"_a, "The same frame with one node more; it bends as before.")
      .def("stiffness", &BeamFrame::stiffness, "(6n, 6n) of the free frame, node by node, in the object's frame.")
      .def(
          "deflection",
          [](const BeamFrame& f, const Held& grasp, const ArrayLike& T_world_object, const Given<double>& gravity) {
            const Pose T = pose_argument(T_world_object, "T_world_object");
            return SupportedFrame(f, supports_argument(grasp, "grasp"))
                .state(gravity_in_object(T, taken(gravity, "gravity")));
          },
          "grasp"_a, "T_world_object"_a, py::kw_only(), "gravity"_a = kGravity,
          "How it bends when it is held there in this pose: by one grasp of a pipe, or by several, or by supports.")
      .def("__repr__", [](const BeamFrame& f) {
        return "BeamFrame(" + std::to_string(f.members.size()) + " members, " + std::to_string(f.nodes.size()) +
               " nodes)";
      });
  bind_supported_frame(m);
  m.def(
      "beam_frame",
      [](const Given<Pipe>& pipe, const Given<double>& inner, const Given<BeamMaterial>& material) {
        return beam_frame(taken(pipe, "pipe"), taken(inner, "inner_diameter"), taken(material, "material"));
      },
      "pipe"_a, "inner_diameter"_a, "material"_a, "A pipe as a frame: member i is section i, a tube [m].");
}

}  // namespace mmgrasp::python
