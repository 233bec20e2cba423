// Operations of an assembly: what moves where, how a gripper takes it, and how long its fingers may be.
#include "arrays.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/grasp/assembly_grasps.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

void bind_operation(py::module_& m) {
  py::class_<PlacedMesh>(m, "PlacedMesh", "A part where it is in its subassembly. Closed meshes are solids.")
      .def(py::init([](const Given<std::string>& name, const Given<MeshShape>& mesh, const OptionalArray& pose) {
             PlacedMesh part{taken(name, "name"), taken(mesh, "mesh").mesh, Pose::Identity()};
             if (!pose.is_none()) part.pose = pose_argument(pose, "pose");
             return part;
           }),
           "name"_a, "mesh"_a, "pose"_a = py::none(), "Name for messages, mesh, T_subassembly_mesh (4, 4).")
      .def_readonly("name", &PlacedMesh::name, "For messages.")
      .def_property_readonly(
          "mesh", [](const PlacedMesh& p) { return MeshShape{p.mesh}; }, "As given.")
      .def_property_readonly(
          "pose", [](const PlacedMesh& p) { return p.pose.matrix(); }, "T_subassembly_mesh, (4, 4).")
      .def("__repr__", [](const PlacedMesh& p) { return "PlacedMesh(" + p.name + ")"; });

  using O = AssemblyOperation;
  py::class_<O>(
      m, "AssemblyOperation",
      "One operation of an assembly (P1 5.3.1): a gripper brings the active subassembly to the passive one, lets "
      "go of it and moves back along its approach.\n\n"
      "    AssemblyOperation([PlacedMesh(\"sleeve\", sleeve)], [PlacedMesh(\"shaft\", shaft)],\n"
      "                      [mg.pose([0, 0, 0.1]), mg.pose([0, 0, 0])])")
      .def(
          py::init([](const Given<std::vector<PlacedMesh>>& active, const Given<std::vector<PlacedMesh>>& passive,
                      const ArrayLike& motion, const Given<std::string>& name, const Given<double>& force,
                      const OptionalArray& hole) {
            O operation{taken(active, "active", "PlacedMesh"), taken(passive, "passive", "PlacedMesh"),
                        poses_argument(motion, "motion"), taken(name, "name"), taken(force, "insertion_force")};
            if (!hole.is_none()) operation.hole = vector3_argument(hole, "hole");
            operation.check();
            return operation;
          }),
          "active"_a, "passive"_a, "motion"_a, py::kw_only(), "name"_a = "", "insertion_force"_a = 0.0,
          "hole"_a = py::none(),
          "Parts held, parts that stay (fixture and table too), T_passive_active from before to the end, (m, 4, 4); "
          "name for messages, with what force the hole resists against the last straight line [N], a point on its axis "
          "in the frame of what is held (3,) [m] (None: the centre of mass).")
      .def_readonly("active", &O::active, "Held.")
      .def_readonly("passive", &O::passive, "Stays where it is.")
      .def_property_readonly(
          "motion", [](const O& o) { return to_array(o.motion); },
          "T_passive_active, (m, 4, 4); the last one where the gripper opens.")
      .def_readonly("name", &O::name, "For messages and results.")
      .def_readonly("insertion_force", &O::insertion_force, "With which the hole resists [N].")
      .def_readonly("hole", &O::hole, "A point on the hole's axis (3,) [m]; None: the centre of mass.")
      .def("__repr__", [](const O& o) {
        return "AssemblyOperation(" + o.active.front().name + ", " + std::to_string(o.passive.size()) +
               " passive parts, " + std::to_string(o.motion.size()) + " poses)";
      });
}

void bind_assembly_grasp(py::module_& m) {
  using G = AssemblyGrasp;
  py::class_<G>(
      m, "AssemblyGrasp",
      "How a gripper with straight fingers takes the active subassembly. The tool frame lies in the plane of the "
      "finger tips with z along the approach; the first finger moves along x.\n\n"
      "    AssemblyGrasp(T_active_tool, fingers=3, opening=0.04)")
      .def(py::init([](const ArrayLike& T_active_tool, const Given<int>& fingers, const Given<double>& opening,
                       const Given<double>& width, const Given<double>& thickness, const Given<double>& clearance,
                       const Given<double>& palm_radius, const Given<double>& contact_length,
                       const Given<double>& contact_width) {
             const G grasp{pose_argument(T_active_tool, "T_active_tool"),
                           taken(fingers, "fingers"),
                           taken(opening, "opening"),
                           taken(width, "width"),
                           taken(thickness, "thickness"),
                           taken(clearance, "clearance"),
                           taken(palm_radius, "palm_radius"),
                           taken(contact_length, "contact_length"),
                           taken(contact_width, "contact_width")};
             grasp.check();
             return grasp;
           }),
           "T_active_tool"_a, py::kw_only(), "fingers"_a = G{}.fingers, "opening"_a = G{}.opening,
           "width"_a = G{}.width, "thickness"_a = G{}.thickness, "clearance"_a = G{}.clearance,
           "palm_radius"_a = G{}.palm_radius, "contact_length"_a = G{}.contact_length,
           "contact_width"_a = G{}.contact_width, "Tool frame (4, 4), 2 or 3 fingers, lengths [m].")
      .def_property_readonly(
          "T_active_tool", [](const G& g) { return g.T_active_tool.matrix(); }, "(4, 4)")
      .def_readonly("fingers", &G::fingers, "2: parallel jaws; 3: centric fingers.")
      .def_readonly("opening", &G::opening, "Between the pads, or the diameter that three of them touch [m].")
      .def_readonly("width", &G::width, "Width of a finger, across approach and closing direction [m].")
      .def_readonly("thickness", &G::thickness, "Thickness of a finger, along the closing direction [m].")
      .def_readonly("clearance", &G::clearance, "How far each finger opens to approach and to let go [m].")
      .def_readonly("palm_radius", &G::palm_radius, "Radius of the palm and of all behind it [m].")
      .def_readonly("contact_length", &G::contact_length,
                    "How far a pad overlaps what it holds, along the approach from the tips [m]; 0: not known.")
      .def_readonly("contact_width", &G::contact_width, "The same across the approach [m].")
      .def("__repr__", [](const G& g) {
        return "AssemblyGrasp(" + std::to_string(g.fingers) + " fingers, opening " +
               std::string(py::repr(py::float_(g.opening))) + ")";
      });

  using R = FingerLengthRange;
  py::class_<R>(m, "FingerLengthRange", "Which finger lengths take a part through an operation: L- and L+ of P1.")
      .def_readonly("free", &R::free, "There is such a length.")
      .def_readonly("shortest", &R::shortest, "With which the palm meets nothing [m].")
      .def_readonly("longest", &R::longest,
                    "With which the fingers meet nothing [m]; infinite where nothing limits it.")
      .def_readonly("shortest_by", &R::shortest_by, "What sets shortest: \"<part> at <when>\", or ''.")
      .def_readonly("longest_by", &R::longest_by, "What sets longest or leaves no length at all, or ''.")
      .def("__repr__", [](const R& r) {
        const auto shown = [](double v) { return std::string(py::repr(py::float_(v))); };
        if (!r.free) return "FingerLengthRange(none: " + (r.longest_by.empty() ? r.shortest_by : r.longest_by) + ")";
        return "FingerLengthRange(" + shown(r.shortest) + " to " + shown(r.longest) + " m)";
      });
}

const std::vector<OptionField<AssemblyGraspOptions>>& assembly_grasp_fields() {
  using O = AssemblyGraspOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("facet_angle", &O::facet_angle, "faces of one facet bend no more from its largest [rad]"),
      option<O>("parallel_angle", &O::parallel_angle, "facets between jaws are off parallel by no more [rad]"),
      option<O>("directions", &O::directions, "approaches about the closing axis, or turns of centric fingers"),
      option<O>("min_contact", &O::min_contact, "pads overlap the segment by at least this, along the approach [m]"),
      option<O>("pad_length", &O::pad_length, "of a pad along the approach [m]"),
      option<O>("max_opening", &O::max_opening, "wider segments are left out [m]"),
      option<O>("finger_width", &O::finger_width, "across approach and closing direction [m]"),
      option<O>("finger_thickness", &O::finger_thickness, "along the closing direction [m]"),
      option<O>("clearance", &O::clearance, "by which each finger opens to approach and to let go [m]"),
      option<O>("tip_clearance", &O::tip_clearance, "tips end this short of the far end of what they hold [m]"),
      option<O>("palm_margin", &O::palm_margin, "the palm reaches beyond the open fingers by this [m]")};
  return fields;
}

void bind_candidates(py::module_& m) {
  py::class_<Facet>(m, "Facet", "A nearly plane piece of a surface (P1 5.3.3, planar clustering).")
      .def_readonly("faces", &Facet::faces, "Triangles of the mesh, ascending.")
      .def_readonly("normal", &Facet::normal, "Outwards, weighted by area, (3,).")
      .def_readonly("centre", &Facet::centre, "Centre of its area [m], (3,).")
      .def_readonly("area", &Facet::area, "[m2]")
      .def("__repr__", [](const Facet& f) { return "Facet(" + std::to_string(f.faces.size()) + " faces)"; });
  m.def("_assembly_grasp_option_table", [] { return option_table(assembly_grasp_fields()); });
  m.def(
      "planar_facets",
      [](const Given<MeshShape>& mesh, const std::vector<int>& faces, const Given<double>& angle) {
        const MeshShape shape = taken(mesh, "mesh");
        const double most = taken(angle, "angle");
        return interruptible([&] { return planar_facets(*shape.mesh, faces, most); });
      },
      "mesh"_a, "faces"_a = std::vector<int>{}, py::kw_only(), "angle"_a = 0.1,
      "Nearly plane pieces of a mesh, or of some of its faces (none: all), largest first: each grows from the largest "
      "face left, as long as faces bend no more than `angle` [rad] from it.");
  m.def(
      "jaw_grasps",
      [](const Given<MeshShape>& mesh, const std::vector<int>& faces, const py::kwargs& keywords) {
        const auto options = read_options(assembly_grasp_fields(), keywords, "jaw_grasps");
        const MeshShape shape = taken(mesh, "mesh");
        return interruptible([&] { return jaw_grasps(*shape.mesh, faces, options); });
      },
      "mesh"_a, "faces"_a = std::vector<int>{},
      ("Grasps by two parallel jaws: opposite, nearly parallel facets of a segment (`faces`; none: the whole mesh) "
       "whose "
       "shadows overlap, approached from every direction across the closing axis, at up to three depths (P1 5.3.3)." +
       option_help(assembly_grasp_fields()))
          .c_str());
  m.def(
      "centric_grasps",
      [](const ArrayLike& T_mesh_cylinder, const Given<double>& diameter, const Given<double>& low,
         const Given<double>& high, const py::kwargs& keywords) {
        const auto options = read_options(assembly_grasp_fields(), keywords, "centric_grasps");
        const CylinderFit cylinder{pose_argument(T_mesh_cylinder, "T_mesh_cylinder"), taken(diameter, "diameter"),
                                   taken(low, "low"), taken(high, "high")};
        return centric_grasps(cylinder, options);
      },
      "T_mesh_cylinder"_a, "diameter"_a, "low"_a, "high"_a,
      ("Grasps by three centric fingers along the z axis of a cylinder that ends at `low` and `high` on it [m], from "
       "either end, fingers turned in steps, at up to three depths (P1 5.2.3)." +
       option_help(assembly_grasp_fields()))
          .c_str());
}

}  // namespace

void bind_assembly(py::module_& m) {
  bind_operation(m);
  bind_assembly_grasp(m);
  bind_candidates(m);
  m.def(
      "finger_length_range",
      [](const Given<AssemblyGrasp>& grasp, const Given<AssemblyOperation>& operation, const Given<double>& step) {
        const AssemblyGrasp g = taken(grasp, "grasp");
        const AssemblyOperation o = taken(operation, "operation");
        const double taken_step = taken(step, "step");
        return interruptible([&] { return finger_length_range(g, o, taken_step); });
      },
      "grasp"_a, "operation"_a, py::kw_only(), "step"_a = 0.0005,
      "The finger lengths with which neither fingers nor palm meet the subassemblies: on the approach, along the whole "
      "motion, and while the gripper opens and moves back (P1 5.3.2, 5.3.3). The palm and what carries it count as "
      "endless. Exact for motions along the approach; others are checked every `step` [m] with as much margin.");
}

}  // namespace mmgrasp::python
