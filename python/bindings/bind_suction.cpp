#include "bindings.hpp"
#include "mmgrasp/grasp/detail/joined_surface.hpp"
#include "mmgrasp/grasp/sample_suction_grasps.hpp"
#include "mmgrasp/grasp/suction.hpp"
#include "option_bounds.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using SuctionOptions = SuctionSamplerOptions;

const std::vector<OptionField<SuctionOptions>>& sampler_fields() {
  static const std::vector<OptionField<SuctionOptions>> fields{
      option<SuctionOptions>("turns", &SuctionOptions::turns, "turns of the hand about its approach at each place"),
      option<SuctionOptions>("surface_samples", &SuctionOptions::surface_samples, "places drawn on the surface"),
      option<SuctionOptions>("max_grasps", &SuctionOptions::max_grasps,
                             "best kept, spread over approach directions and turns"),
      option<SuctionOptions>("seed", &SuctionOptions::seed, "same seed, same grasps")};
  return fields;
}

const BoundedOptions<SuctionOptions>& sampler_options() {
  static const BoundedOptions<SuctionOptions> options(sampler_fields(), {{"turns", {1, 360, "turns"}},
                                                                         {"surface_samples", {0, 1e5, "places"}},
                                                                         {"max_grasps", {1, 1e6, "grasps"}},
                                                                         {"seed", {0, kMostSeed, ""}}});
  return options;
}

void bind_records(py::module_& m) {
  py::class_<SuctionCup>(m, "SuctionCup",
                         "One suction cup of a hand: its rim is a circle in the plane through the tool frame's origin, "
                         "across the approach.")
      .def(py::init([](const ArrayLike& position, double radius) {
             return SuctionCup{vector3_argument(position, "position"), finite_argument(radius, "radius")};
           }),
           py::arg("position"), py::arg("radius"), "Middle of the rim in the tool frame (3,) and its radius [m].")
      .def_readonly("position", &SuctionCup::position, "Middle of the rim in the tool frame (3,) [m].")
      .def_readonly("radius", &SuctionCup::radius, "Radius of the rim [m].")
      .def("__repr__", [](const SuctionCup& cup) {
        return "SuctionCup(radius=" + std::string(py::repr(py::float_(cup.radius))) + ")";
      });
  const Suction own;
  py::class_<Suction>(m, "Suction",
                      "Suction cups that hold a part together: how far their rims give way, and how hard they pull.")
      .def(py::init([](std::vector<SuctionCup> cups, double max_gap, double vacuum, double friction, double safety) {
             Suction suction{std::move(cups), max_gap, vacuum, friction, safety};
             suction.check();
             return suction;
           }),
           py::arg("cups"), py::kw_only(), py::arg("max_gap") = own.max_gap, py::arg("vacuum") = own.vacuum,
           py::arg("friction") = own.friction, py::arg("safety") = own.safety, "See the properties of the same names.")
      .def_readonly("cups", &Suction::cups, "At least one.")
      .def_readonly("max_gap", &Suction::max_gap,
                    "A cup seals where the part's surface falls back from its rim's plane by no more than this [m].")
      .def_readonly("vacuum", &Suction::vacuum, "Below the pressure of the air [Pa].")
      .def_readonly("friction", &Suction::friction, "Coulomb coefficient of rim and part.")
      .def_readonly("safety", &Suction::safety, "The force is so many times what holding needs.")
      .def_property_readonly("force", &Suction::force, "What all cups pull with: vacuum times area [N].")
      .def("__repr__", [](const Suction& s) { return "Suction(" + std::to_string(s.cups.size()) + " cups)"; });
}

}  // namespace

void bind_suction(py::module_& m) {
  bind_records(m);
  m.def("_suction_option_table", [] { return option_table(sampler_fields()); });
  m.def("_suction_used", [] { return kSuctionUsed; });
  m.def(
      "_centre_of_mass",
      [](const std::vector<LinkShape>& object) { return detail::joined_surface(object).centre_of_mass; },
      py::arg("object"));
  m.def("_suction_option_bounds", [] { return sampler_options().bounds(); });
}

void bind_suction_grasps(py::module_& m) {
  py::class_<SampledSuctionGrasps>(m, "SampledSuctionGrasps", "What sample_suction_grasps found, and what it left out.")
      .def_readonly("grasps", &SampledSuctionGrasps::grasps, "Best first.")
      .def_readonly("unsealed", &SampledSuctionGrasps::unsealed, "Places and turns at which some cup does not seal.")
      .def_readonly("too_heavy", &SampledSuctionGrasps::too_heavy,
                    "Where all seal, but would not hold the mass in every direction.")
      .def_readonly("least_share", &SampledSuctionGrasps::least_share,
                    "Least share of the cups' force that holds the mass in every direction, where all seal; inf: "
                    "nowhere.")
      .def("__repr__", [](const SampledSuctionGrasps& s) {
        return "SampledSuctionGrasps(" + std::to_string(s.grasps.size()) + " grasps)";
      });
  m.def(
      "sample_suction_grasps",
      [](const std::vector<LinkShape>& object, const Hand& hand, double mass, const py::kwargs& options) {
        const SuctionOptions read = sampler_options().read(options, "sample_suction_grasps");
        return interruptible([&] { return sample_suction_grasps(object, hand, mass, read); });
      },
      py::arg("object"), py::arg("hand"), py::arg("mass") = 0.0,
      ("Grasps of a body given as a list of LinkShape by a hand's suction cups: where every cup seals and, with a "
       "`mass` [kg] above 0,\nthe part is held at rest however the hand is turned; best first." +
       option_help(sampler_fields()))
          .c_str());
  m.def(
      "seal_gap",
      [](const std::vector<LinkShape>& object, const ArrayLike& T_object_hand, const ArrayLike& approach,
         const Suction& suction) {
        const Pose T = pose_argument(T_object_hand, "T_object_hand");
        const Eigen::Vector3d axis = vector3_argument(approach, "approach");
        return interruptible([&] { return seal_gap(object, T, axis, suction); });
      },
      py::arg("object"), py::arg("T_object_hand"), py::arg("approach"), py::arg("suction"),
      "How far [m] a body's surface falls back from the planes of the cups' rims at most, with the hand at "
      "T_object_hand (4, 4) and\nthe cups facing along `approach` (3,); inf where a rim or what it encloses reaches "
      "beside the body or over a hole, negative\nwhere the body reaches through a rim's plane.");
  m.def(
      "suction_share",
      [](const Suction& suction, const ArrayLike& approach, double mass, const ArrayLike& centre_of_mass,
         const OptionalArray& pull) {
        const Eigen::Vector3d axis = vector3_argument(approach, "approach");
        const Eigen::Vector3d centre = vector3_argument(centre_of_mass, "centre_of_mass");
        finite_argument(mass, "mass");
        if (pull.is_none()) return suction_share_any_way(suction, axis, mass, centre);
        return suction_share(suction, axis, mass, centre, vector3_argument(pull.cast<ArrayLike>(), "pull"));
      },
      py::arg("suction"), py::arg("approach"), py::arg("mass"), py::arg("centre_of_mass"), py::arg("pull") = py::none(),
      "Share of the cups' force that holding a part takes, safety included: above 1 it comes off. `mass` [kg], "
      "`centre_of_mass` (3,)\nand `approach` (3,) in the tool frame; `pull` (3,): gravity less acceleration there "
      "[m/s^2], None: at rest, however the hand is turned.");
}

}  // namespace mmgrasp::python
