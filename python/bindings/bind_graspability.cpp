#include "bindings.hpp"
#include "mmgrasp/grasp/graspability.hpp"
#include "mmgrasp/grasp/random_placement.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kMaskImages[] = "dict[str, numpy.typing.NDArray[numpy.uint8]]";
using MaskImages = Shown<kMaskImages>;
constexpr char kCounts[] = "mmgrasp.records.GraspabilityCounts";
using CountsDict = Shown<kCounts>;

using namespace py::literals;

const std::vector<OptionField<GraspabilityOptions>>& graspability_fields() {
  using O = GraspabilityOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("margin", &O::margin, "kept free around the hand [m]"),
      option<O>("orientations", &O::orientations, "closing directions over half a turn"),
      option<O>("openings", &O::openings, "openings tried: max_opening and equal parts of it"),
      option<O>("layer_step", &O::layer_step, "between the heights at which fingertips are tried [m]"),
      option<O>("lowest", &O::lowest, "height of the lowest fingertips above the map's frame [m]"),
      option<O>("insertion", &O::insertion, "how far a part must rise above the fingertips to count as held [m]"),
      option<O>("smoothing", &O::smoothing, "radius over which graspability is averaged [m]"),
      option<O>("min_contact", &O::min_contact, "share of the pads' width that must meet the part"),
      option<O>("min_distance", &O::min_distance, "between returned grasps of about one direction [m]"),
      option<O>("max_grasps", &O::max_grasps, "best kept"),
      option<O>("threads", &O::threads, "0: all")};
  return fields;
}

const std::vector<OptionField<PlacementOptions>>& placement_fields() {
  using O = PlacementOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("draws", &O::draws, "random places tried for each part"),
      option<O>("stack", &O::stack, "a part without a place on the floor may lie on others"),
      option<O>("clearance", &O::clearance, "air left between bodies [m]"),
      option<O>("seed", &O::seed, "same seed, same places")};
  return fields;
}

void bind_evaluation(py::module_& m) {
  py::class_<Graspability>(m, "Graspability", "Grasps, best first, and what became of the other places checked.")
      .def_readonly("grasps", &Graspability::grasps, "Best first.")
      .def_property_readonly(
          "counts",
          [](const Graspability& g) -> CountsDict {
            return py::dict("tried"_a = g.counts.tried, "too_wide"_a = g.counts.too_wide, "poor"_a = g.counts.poor,
                            "collision"_a = g.counts.collision, "near_better"_a = g.counts.near_better);
          },
          "Places checked (tried) and rejected: too_wide, poor, collision, near_better.")
      .def("__repr__",
           [](const Graspability& g) { return "Graspability(" + std::to_string(g.grasps.size()) + " grasps)"; });
  m.def(
      "evaluate_graspability",
      [](const HeightMap& map, const Hand& gripper, const std::optional<DepthImage>& image, const py::kwargs& options) {
        const GraspabilityOptions read = read_options(graspability_fields(), options, "evaluate_graspability");
        return LongCall(py::none()).run([&](const Monitor& monitor) {
          Graspability found = evaluate_graspability(map, gripper, read, monitor);
          if (image) find_pixels(*image, found.grasps);
          return found;
        });
      },
      py::arg("map"), py::arg("gripper"), py::kw_only(), py::arg("image") = py::none(),
      ("Fast graspability evaluation (P1 3.7.2): contact and collision masks of the hand convolved with a height map "
       "over\nclosing directions, openings and heights; grasps at the local maxima, straight along -z of the map. "
       "With the\n`image` that the map was made of each grasp gets its pixel." +
       option_help(graspability_fields()))
          .c_str());
  m.def(
      "graspability_map",
      [](const HeightMap& map, const Hand& gripper, double angle, double opening, double tip_height,
         const py::kwargs& options) {
        const GraspabilityOptions read = read_options(graspability_fields(), options, "graspability_map");
        const auto values =
            interruptible([&] { return graspability_map(map, gripper, angle, opening, tip_height, read); });
        py::array_t<float> out({map.ny, map.nx});
        std::copy(values.begin(), values.end(), out.mutable_data());
        return out;
      },
      py::arg("map"), py::arg("gripper"), py::arg("angle"), py::arg("opening"), py::arg("tip_height"),
      ("(ny, nx) smoothed graspability in [0, 1] of one closing direction, opening and height of the fingertips." +
       option_help(graspability_fields()))
          .c_str());
  m.def(
      "hand_masks",
      [](const Hand& gripper, double opening, double angle, double resolution,
         const py::kwargs& options) -> MaskImages {
        const GraspabilityOptions read = read_options(graspability_fields(), options, "hand_masks");
        const HandMasks masks =
            interruptible([&] { return make_hand_masks(gripper, opening, angle, resolution, read.margin); });
        py::dict out;
        for (const auto& [name, mask] :
             {std::pair{"contact", &masks.contact}, {"fingers", &masks.fingers}, {"palm", &masks.palm}}) {
          py::array_t<std::uint8_t> image({mask->width(), mask->width()});
          std::copy(mask->cells.begin(), mask->cells.end(), image.mutable_data());
          out[name] = image;
        }
        return out;
      },
      py::arg("gripper"), py::arg("opening"), py::arg("angle"), py::arg("resolution"),
      ("The masks `contact`, `fingers` and `palm` as images of zeros and ones with the hand in the middle." +
       option_help(graspability_fields()))
          .c_str());
}

void bind_placement(py::module_& m) {
  py::class_<RestingPose>(m, "RestingPose", "How a part may lie on a level floor.")
      .def_property_readonly(
          "T_floor_part", [](const RestingPose& r) { return to_array(r.T_floor_part); },
          "Pose (4, 4): centre of mass above the origin, lowest point at height 0.")
      .def_readonly("probability", &RestingPose::probability, "All of a part's sum to 1.")
      .def("__repr__", [](const RestingPose& r) {
        return "RestingPose(" + std::string(py::repr(py::float_(r.probability))) + ")";
      });
  m.def(
      "resting_poses",
      [](const std::vector<LinkShape>& part) { return interruptible([&] { return resting_poses(part); }); },
      py::arg("part"), "Faces of a part's convex hull on which it does not tip over, most probable first.");
  py::class_<PlacedPart>(m, "PlacedPart", "A part lying in a tray.")
      .def_property_readonly(
          "T_tray_part", [](const PlacedPart& p) { return to_array(p.T_tray_part); },
          "Pose of the part in the tray's frame (4, 4).")
      .def_readonly("resting_pose", &PlacedPart::resting_pose, "Index into resting_poses(part).")
      .def_readonly("on_floor", &PlacedPart::on_floor, "False: it lies on others.")
      .def("__repr__", [](const PlacedPart& p) { return "PlacedPart(at " + text(p.T_tray_part.translation()) + ")"; });
  py::class_<RandomPlacement>(m, "RandomPlacement", "Parts lying in a tray at random.")
      .def_readonly("parts", &RandomPlacement::parts, "The parts in the order in which they were placed.")
      .def_readonly("not_placed", &RandomPlacement::not_placed, "Parts for which no place was found.")
      .def("__repr__",
           [](const RandomPlacement& p) { return "RandomPlacement(" + std::to_string(p.parts.size()) + " parts)"; });
  m.def(
      "random_placement",
      [](const std::vector<LinkShape>& part, const ArrayLike& tray_size, int count, double fill, double wall,
         const py::kwargs& options) {
        PlacementOptions read = read_options(placement_fields(), options, "random_placement");
        require(fill >= 0 && fill <= 1, "fill", fill, "must be in [0, 1]");
        require(count >= 0, "count", count, "must be zero or positive");
        read.count = static_cast<int>(std::lround(fill * count));
        const Eigen::Vector3d size = vector3_argument(tray_size, "tray_size");
        return LongCall(py::none()).run([&](const Monitor& monitor) {
          return random_placement(part, size, wall, read, monitor);
        });
      },
      py::arg("part"), py::arg("tray_size"), py::kw_only(), py::arg("count") = PlacementOptions{}.count,
      py::arg("fill") = 1.0, py::arg("wall") = 0.005,
      ("Alike parts lying in a tray at random (P1 3.5.2), let down one after another without touching; `fill` is the "
       "share\nof `count` that is there. The tray's frame is the middle of its floor, `tray_size` are outer lengths." +
       option_help(placement_fields()))
          .c_str());
  m.def(
      "tray_shapes",
      [](const ArrayLike& size, double wall) { return tray_shapes(vector3_argument(size, "size"), wall); },
      py::arg("size"), py::arg("wall") = 0.005, "Floor and four walls of a tray (outer lengths) in its frame.");
}

}  // namespace

void bind_graspability(py::module_& m) {
  m.def("_graspability_option_table", [] { return option_table(graspability_fields()); });
  bind_evaluation(m);
  bind_placement(m);
}

}  // namespace mmgrasp::python
