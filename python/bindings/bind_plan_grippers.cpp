// From meshes and an order to grippers, in one call.
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/gripper_design/plan_grippers.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<PlanGrippersOptions>>& plan_grippers_fields() {
  using O = PlanGrippersOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("finger_width", &O::finger_width, "across approach and closing direction [m]"),
      option<O>("finger_thickness", &O::finger_thickness, "along the closing direction [m]"),
      option<O>("clearance", &O::clearance, "how far each finger opens to approach and to let go [m]"),
      option<O>("shortest_finger", &O::shortest_finger, "no finger is shorter [m]"),
      option<O>("longest_finger", &O::longest_finger, "no finger is longer [m]"),
      option<O>("opening_margin", &O::opening_margin, "stroke kept free beyond the part at either end [m]"),
      option<O>("length_margin", &O::length_margin, "kept from either limit of the finger length [m]"),
      option<O>("min_contact", &O::min_contact, "pads overlap a segment by at least this, along the approach [m]"),
      option<O>("tip_clearance", &O::tip_clearance, "tips end this short of the far end of the segment [m]"),
      option<O>("directions", &O::directions, "approaches about the closing axis, or turns of centric fingers"),
      option<O>("max_overlap", &O::max_overlap, "parts may stand in each other by this [m]"),
      option<O>("change_cost", &O::change_cost, "of changing the gripper between two operations"),
      option<O>("max_nodes", &O::max_nodes, "of the search for fewest changes"),
      option<O>("time_limit", &O::time_limit, "the search for the least set ends after this, on the clock [s]"),
      option<O>("max_rehearsals", &O::max_rehearsals, "most sets that are rehearsed, each without what met something"),
      option<O>("threads", &O::threads, "0: all")};
  return fields;
}

constexpr char kBoxes[] = "collections.abc.Sequence[tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike]]";

std::vector<KeepOffBox> boxes_argument(const py::object& value) {
  std::vector<KeepOffBox> out;
  if (!py::isinstance<py::sequence>(value)) refuse_value("boxes", value, "a list of pairs (pose, size)");
  for (const py::handle& item : value) {
    if (!py::isinstance<py::sequence>(item) || py::len(item) != 2)
      refuse_value("boxes", item, "pairs of a pose (4, 4) and a size (3,)");
    const py::sequence pair = py::reinterpret_borrow<py::sequence>(item);
    KeepOffBox box{pose_argument(ArrayLike(pair[0]), "boxes"), vector3_argument(OptionalArray(pair[1]), "boxes")};
    box.check();
    out.push_back(box);
  }
  return out;
}

void bind_keep_off(py::module_& m) {
  py::class_<KeepOff>(m, "KeepOff",
                      "The surface of a part that no finger may touch.\n\n"
                      "    KeepOff(\"pulley\", segments=[2], boxes=[(mg.pose([0, 0, 0.02]), [0.07, 0.07, 0.004])])")
      .def(py::init([](const Given<std::string>& part, const Given<std::vector<int>>& segments,
                       const Shown<kBoxes>& boxes, const Given<std::vector<std::string>>& names,
                       const Given<std::string>& source) {
             return KeepOff{taken(part, "part"), taken(segments, "segments", "whole numbers"), boxes_argument(boxes),
                            taken(names, "names", "texts"), taken(source, "source")};
           }),
           "part"_a, py::kw_only(), "segments"_a = py::list(), "boxes"_a = py::list(), "names"_a = py::list(),
           "source"_a = "",
           "Name of the part; numbers of segments that segment_mesh gives it by default, or their names by "
           "segment_names (\"cylinder_1\", \"pulley/cylinder_1\"); boxes in its mesh's frame: pairs of T_mesh_box (4, "
           "4) "
           "of the middle, and size (3,) [m]; who asks for it, with which messages about it begin.")
      .def_readonly("part", &KeepOff::part, "The part's name.")
      .def_readonly("segments", &KeepOff::segments, "Numbers of segments.")
      .def_readonly("names", &KeepOff::names, "Names of segments.")
      .def_readonly("source", &KeepOff::source, "Who asks for it.")
      .def_property_readonly(
          "boxes",
          [](const KeepOff& k) {
            std::vector<std::pair<Eigen::Matrix4d, Eigen::Vector3d>> out;
            for (const KeepOffBox& b : k.boxes) out.emplace_back(b.T_mesh_box.matrix(), b.size);
            return out;
          },
          "Pairs of T_mesh_box (4, 4) and size (3,) [m].")
      .def("__repr__", [](const KeepOff& k) {
        return "KeepOff(" + k.part + ", " + std::to_string(k.segments.size() + k.names.size()) + " segments, " +
               std::to_string(k.boxes.size()) + " boxes)";
      });
}

void bind_plan_result(py::module_& m) {
  using S = SegmentedPart;
  py::class_<S>(m, "SegmentedPart", "A part cut into segments, each with the primitive that stands for it.")
      .def_readonly("segmentation", &S::segmentation, "Its segments.")
      .def_readonly("primitives", &S::primitives, "One per segment.")
      .def("__repr__",
           [](const S& s) { return "SegmentedPart(" + std::to_string(s.primitives.size()) + " segments)"; });
  using F = SegmentFate;
  py::class_<F>(m, "SegmentFate", "What became of one segment of a part in one operation.")
      .def_readonly("step", &F::step, "The operation's name.")
      .def_readonly("part", &F::part, "The part's name.")
      .def_readonly("segment", &F::segment, "Its number.")
      .def_readonly("name", &F::name, "Its name, as segment_names gives it: cylinder_1.")
      .def_readonly("kind", &F::kind, "Its primitive: cylinder, box, cone or sphere.")
      .def_readonly("fingers", &F::fingers, "2, 3, or 0: no gripper suits its primitive.")
      .def_readonly("tried", &F::tried, "Grasps of it.")
      .def_readonly("free", &F::free, "How many of those have some finger length.")
      .def_readonly("refused", &F::refused, "Why it cannot be held, or what most of its grasps fell by; '' when held.")
      .def_readonly("requirements", &F::requirements, "Numbers of the plan's requirements.")
      .def("__repr__", [](const F& f) {
        return "SegmentFate(" + f.step + ", " + f.part + "/" + f.name + ": " +
               (f.refused.empty() ? "held" : f.refused) + ")";
      });
  using G = RefusedGrasp;
  py::class_<G>(m, "RefusedGrasp", "A grasp that the rehearsal of its operation refused.")
      .def_readonly("requirement", &G::requirement, "Its number in the plan.")
      .def_readonly("met", &G::met, "What it met with the gripper chosen for it then.")
      .def("__repr__",
           [](const G& g) { return "RefusedGrasp(requirement " + std::to_string(g.requirement) + ": " + g.met + ")"; });
  using R = PlanGrippersResult;
  py::class_<R>(m, "PlanGrippersResult", "The grippers of an assembly, and how they were come by.")
      .def_readonly(
          "outcome", &R::outcome,
          "`solved`: each operation has a gripper that was rehearsed, and the set is proven to be the least for the "
          "grasps that were not left_out; `infeasible`: an operation has no grasp to try, or its parts stand in each "
          "other (missing), or no drive takes it (set); `not_found`: no grasp that was tried goes through an "
          "operation, or a rehearsal refuses all of them (pads that slip, too), or refused one of each of "
          "max_rehearsals sets; `stopped`; else as the set's.")
      .def_readonly("parts", &R::parts, "The parts that are moved, by name.")
      .def_readonly("fates", &R::fates, "Every segment of what is moved, in every operation.")
      .def_readonly("requirements", &R::requirements, "One per grasp kept; `part` is the operation's name.")
      .def_readonly("grasps", &R::grasps, "One per requirement, in the frame of the active subassembly.")
      .def_readonly("holdings", &R::holdings,
                    "One per requirement, of those chosen with their gripper's real pads; empty where nothing is asked "
                    "of holding.")
      .def_readonly("missing", &R::missing, "Operations that cannot be done, each with the reasons.")
      .def_readonly("help", &R::help, "Single changes each of which gives an operation its grasp: tried.")
      .def_readonly("set", &R::set,
                    "The least set; None when an operation has no grasp; the last one that was rehearsed where none "
                    "goes through.")
      .def_readonly("met", &R::met, "What each operation's rehearsal with the set met, '' nothing; empty without one.")
      .def_readonly("left_out", &R::left_out,
                    "Grasps that a rehearsal refused, in that order. They were left out of the choice of the sets that "
                    "followed, with whatever gripper: the last set is the least for the others.")
      .def_readonly("rehearsals", &R::rehearsals, "So many sets were rehearsed.")
      .def("__repr__", [](const R& r) {
        return std::string("PlanGrippersResult(") + to_string(r.outcome) + ", " +
               std::to_string(r.set ? r.set->grippers.size() : 0) + " grippers)";
      });
}

constexpr char kHolding[] = "HoldingRequirement | None";

}  // namespace

void bind_plan_grippers(py::module_& m) {
  bind_keep_off(m);
  bind_plan_result(m);
  m.def("_plan_grippers_option_table", [] { return option_table(plan_grippers_fields()); });
  m.def(
      "plan_grippers",
      [](const Given<std::vector<AssemblyOperation>>& operations, const Given<std::vector<GripperActuator>>& actuators,
         const Given<std::vector<KeepOff>>& keep_off, const Shown<kHolding>& holding, const Progress& progress,
         const py::kwargs& keywords) {
        PlanGrippersOptions options = read_options(plan_grippers_fields(), keywords, "plan_grippers");
        if (!holding.is_none()) {
          if (!py::isinstance<HoldingRequirement>(holding)) refuse_value("holding", holding, "a HoldingRequirement");
          options.holding = py::cast<HoldingRequirement>(holding);
        }
        const auto order = taken(operations, "operations", "AssemblyOperation");
        const auto drives = taken(actuators, "actuators", "GripperActuator");
        const auto not_touched = taken(keep_off, "keep_off", "KeepOff");
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return plan_grippers(order, drives, not_touched, options, monitor); });
      },
      "operations"_a, "actuators"_a, py::kw_only(), "keep_off"_a = py::list(), "holding"_a = py::none(),
      "progress"_a = py::none(),
      ("The least set of grippers that puts an assembly together (P1 chapter 5), from meshes and an order: segments, "
       "primitives (boxes for two jaws, cylinders for three centric fingers), grasps that meet nothing over the whole "
       "operation with some finger length, the least set, and every operation gone through again with the gripper "
       "itself by the collision checker; where that meets something, the set is chosen again without the grasp. Of "
       "several segments and depths that no more grippers could take, the one is "
       "taken on which the insertion bears most evenly, then the one held most safely (both with `holding`), then the "
       "one touched on most surface." +
       option_help(plan_grippers_fields()))
          .c_str());
  m.def(
      "assembly_grasps",
      [](const Given<PlacedMesh>& part, const Given<MeshSegment>& segment, const Given<FittedPrimitive>& primitive,
         const Given<std::vector<GripperActuator>>& actuators, const py::kwargs& keywords) {
        const auto options = read_options(plan_grippers_fields(), keywords, "assembly_grasps");
        const auto drives = taken(actuators, "actuators", "GripperActuator");
        const PlacedMesh placed = taken(part, "part");
        const MeshSegment cut = taken(segment, "segment");
        const FittedPrimitive fitted = taken(primitive, "primitive");
        return interruptible([&] { return assembly_grasps(placed, cut, fitted, drives, options); });
      },
      "part"_a, "segment"_a, "primitive"_a, "actuators"_a,
      ("The grasps that plan_grippers tries of a segment, in the frame of the active subassembly; the palm is as wide "
       "as that of the widest gripper that may take it." +
       option_help(plan_grippers_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
