#include "arrays.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/sample_grasps.hpp"
#include "option_bounds.hpp"

namespace mmgrasp::python {

void bind_suction(py::module_& m);
void bind_suction_grasps(py::module_& m);

namespace {

using namespace py::literals;

OptionField<GraspSamplerOptions> approach_direction_option() {
  using O = GraspSamplerOptions;
  const auto set = [](O& options, const py::handle& value) {
    options.approach_direction.reset();
    if (!value.is_none()) options.approach_direction = vector3_argument(value, "approach_direction");
  };
  const auto get = [](const O& options) -> py::object {
    if (!options.approach_direction) return py::none();
    const Eigen::Vector3d& v = *options.approach_direction;
    return py::make_tuple(v[0], v[1], v[2]);
  };
  return {"approach_direction", "numpy.typing.ArrayLike | None", set, get,
          "of every grasp: a unit vector in the object's frame; None: from all around"};
}

const std::vector<OptionField<GraspSamplerOptions>>& sampler_fields() {
  using O = GraspSamplerOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("approaches", &O::approaches, "approach directions around each closing axis"),
      option<O>("positions", &O::positions, "pad positions along each free direction"),
      option<O>("mesh_samples", &O::mesh_samples,
                "surface points tried on a mesh, eight times as many where few pairs fit the hand"),
      option<O>("max_grasps", &O::max_grasps, "best kept, spread over approach directions"),
      option<O>("friction", &O::friction, "Coulomb coefficient"),
      option<O>("standoff", &O::standoff, "how far the tool frame stays outside the object's middle [m]"),
      approach_direction_option(),
      option<O>("seed", &O::seed, "same seed, same grasps")};
  return fields;
}

const BoundedOptions<GraspSamplerOptions>& sampler_options() {
  static const BoundedOptions<GraspSamplerOptions> options(sampler_fields(), {{"approaches", {1, 360, "directions"}},
                                                                              {"positions", {1, 100, "places"}},
                                                                              {"mesh_samples", {1, 100000, "points"}},
                                                                              {"max_grasps", {1, 1e6, "grasps"}},
                                                                              {"friction", {0.001, 10, ""}},
                                                                              {"standoff", {-10, 10, "m"}},
                                                                              {"seed", {0, kMostSeed, ""}}});
  return options;
}

/// The provenance as a dict that names its sampler; None: the grasp was given.
py::object provenance_dict(const GraspProvenance& provenance) {
  if (const auto* p = std::get_if<ContactPairProvenance>(&provenance)) {
    return py::dict("sampler"_a = "contact_pairs", "pair"_a = p->pair, "approach"_a = p->approach,
                    "flipped"_a = p->flipped, "tips_flush"_a = p->tips_flush);
  }
  if (const auto* p = std::get_if<PipeProvenance>(&provenance)) {
    return py::dict("sampler"_a = "pipe", "section"_a = p->section, "length"_a = p->length, "angle"_a = p->angle,
                    "flipped"_a = p->flipped);
  }
  if (const auto* p = std::get_if<HeightMapProvenance>(&provenance)) {
    return py::dict("sampler"_a = "height_map", "angle"_a = p->angle, "height"_a = p->height,
                    "cell"_a = py::make_tuple(p->ix, p->iy), "pixel"_a = py::make_tuple(p->pixel.x(), p->pixel.y()));
  }
  return py::none();
}

void bind_provenance(py::module_& m) {
  using C = ContactPairProvenance;
  using P = PipeProvenance;
  using H = HeightMapProvenance;
  py::class_<C>(m, "ContactPairProvenance",
                "Provenance of sample_grasps: two opposed contacts and a direction of approach.")
      .def_readonly("pair", &C::pair, "Index among the object's contact pairs, those that are too wide included.")
      .def_readonly("approach", &C::approach, "Index among the approach directions around the closing axis.")
      .def_readonly("flipped", &C::flipped, "The hand is turned by half a turn about the approach.")
      .def_readonly(
          "tips_flush", &C::tips_flush,
          "The tips of the pads are flush with the object's far face: where it is thinner than they are long.")
      .def("__repr__", [](const C& p) { return "ContactPairProvenance(pair=" + std::to_string(p.pair) + ")"; });
  py::class_<P>(m, "PipeProvenance",
                "Provenance of Pipe.grasp and Pipe.sample_grasps: P2's four variables (P2 3.2.3.1).")
      .def_readonly("section", &P::section, "Index of the pipe's section.")
      .def_readonly("length", &P::length, "From the section's first node to the tool frame [m].")
      .def_readonly("angle", &P::angle, "From the section's y axis to the approach about its x axis [rad].")
      .def_readonly("flipped", &P::flipped, "The hand is turned by half a turn about the approach.")
      .def("__repr__", [](const P& p) {
        return "PipeProvenance(section=" + std::to_string(p.section) +
               ", length=" + std::string(py::repr(py::float_(p.length))) +
               ", angle=" + std::string(py::repr(py::float_(p.angle))) + ", flipped=" + (p.flipped ? "True" : "False") +
               ")";
      });
  py::class_<H>(m, "HeightMapProvenance",
                "Provenance of evaluate_graspability: a place of a height map and of a depth image.")
      .def_readonly("angle", &H::angle, "Direction of the closing axis in the map's frame, in [0, pi) [rad].")
      .def_readonly("height", &H::height, "Height of the finger tips above the map's frame [m].")
      .def_property_readonly(
          "cell", [](const H& p) { return py::make_tuple(p.ix, p.iy); }, "(ix, iy) of the height map.")
      .def_readonly("pixel", &H::pixel, "(u, v) in the depth image; (-1, -1) without one.")
      .def("__repr__", [](const H& p) {
        return "HeightMapProvenance(cell=(" + std::to_string(p.ix) + ", " + std::to_string(p.iy) + "))";
      });
}

void bind_record(py::module_& m) {
  py::class_<Grasp>(
      m, "Grasp",
      "One way to hold an object: where the hand stands, how far it is open, what it costs and how good it is.\n"
      "\n"
      "    grasp = mg.Grasp(mg.pose([0, 0, 0.05], rpy=[0, np.pi / 2, 0]), opening=0.04)\n"
      "    T_world_hand = T_world_object @ grasp.T_object_hand")
      .def(
          py::init([](const ArrayLike& T_object_hand, const Given<double>& opening, const Given<double>& cost,
                      const Given<double>& quality, const ArrayLike& posture) {
            Grasp grasp;
            grasp.T_object_hand = pose_argument(T_object_hand, "T_object_hand");
            grasp.opening = taken(opening, "opening");
            grasp.cost = taken(cost, "cost");
            grasp.quality = taken(quality, "quality");
            grasp.posture = list_argument(posture, "posture");
            return grasp;
          }),
          "T_object_hand"_a, "opening"_a = 0.0, py::kw_only(), "cost"_a = 0.0, "quality"_a = 1.0,
          "posture"_a = py::tuple(),
          "Pose of the hand's tool frame in the object's frame (4, 4); distance between the fingers while holding [m]; "
          "cost that\nplanners add to their path's length; quality in [0, 1]; for a hand with several joint groups how "
          "far each is open, in [0, 1].")
      .def_property_readonly(
          "T_object_hand", [](const Grasp& g) { return to_array(g.T_object_hand); },
          "Pose of the hand's tool frame in the object's frame; in the world where no object is known.")
      .def_readonly("opening", &Grasp::opening, "Distance between the fingers while holding [m].")
      .def_readonly("cost", &Grasp::cost, "Added by planners to their path's length.")
      .def_readonly("quality", &Grasp::quality, "Larger is better, in [0, 1].")
      .def_property_readonly(
          "quality_factors",
          [](const Grasp& g) {
            std::map<std::string, std::pair<double, double>> factors;
            for (const QualityFactor& one : g.quality_factors) factors[one.name] = {one.value, one.weight};
            return factors;
          },
          "What the quality is the product of, by name: (value, weight) of the factor 1 - weight + weight * value.")
      .def_readonly("posture", &Grasp::posture, "How far each joint group of the hand is open; []: as `opening` says.")
      .def_property_readonly(
          "provenance", [](const Grasp& g) { return g.provenance; },
          "Which sampler it came from, with which numbers; None: it was given.")
      .def(
          "to_dict",
          [](const Grasp& g) {
            py::dict factors;
            for (const QualityFactor& one : g.quality_factors) factors[py::str(one.name)] = one.value;
            return py::dict("T_object_hand"_a = to_array(g.T_object_hand).attr("tolist")(), "opening"_a = g.opening,
                            "cost"_a = g.cost, "quality"_a = g.quality, "quality_factors"_a = factors,
                            "posture"_a = g.posture, "provenance"_a = provenance_dict(g.provenance));
          },
          "All of it as numbers, strings, lists and dicts; factors of the quality by their values.")
      .def("__repr__", [](const Grasp& g) {
        return "Grasp(at " + text(g.T_object_hand.translation()) +
               ", opening=" + std::string(py::repr(py::float_(g.opening))) +
               ", quality=" + std::string(py::repr(py::float_(g.quality))) + ")";
      });
}

}  // namespace

void bind_grasp(py::module_& m) {
  m.def("_grasp_option_table", [] { return option_table(sampler_fields()); });
  m.def("_straight_approach", [] { return kStraightApproach; });
  m.def("_grasp_option_bounds", [] { return sampler_options().bounds(); });
  bind_provenance(m);
  bind_record(m);
  bind_suction(m);
  bind_hand(m);
  bind_suction_grasps(m);
  m.def(
      "_sample_grasps",
      [](const std::vector<LinkShape>& object, const Hand& gripper, const Progress& progress,
         const py::kwargs& options) {
        const GraspSamplerOptions read = sampler_options().read(options, "sample_grasps");
        SampledGrasps sampled = LongCall(progress).run([&](const Monitor& monitor) {
          monitor.report("grasps", 0);
          return sample_grasps(object, gripper, read);
        });
        return py::make_tuple(std::move(sampled.grasps), sampled.too_wide);
      },
      py::arg("object"), py::arg("gripper"), py::kw_only(), py::arg("progress") = py::none(),
      ("(grasps, too_wide): as sample_grasps, with the number dropped as too wide." + option_help(sampler_fields()))
          .c_str());
  m.def(
      "sample_grasps",
      [](const std::vector<LinkShape>& object, const Hand& gripper, const py::kwargs& options) {
        const GraspSamplerOptions read = sampler_options().read(options, "sample_grasps");
        return interruptible([&] { return sample_grasps(object, gripper, read).grasps; });
      },
      py::arg("object"), py::arg("gripper"),
      ("Antipodal grasps of a body given as a list of LinkShape (P1 3.4.1), best first." +
       option_help(sampler_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
