#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/grasp/eigengrasp.hpp"
#include "mmgrasp/grasp/line_grasp.hpp"
#include "mmgrasp/grasp/next_view.hpp"
#include "mmgrasp/grasp/surface_draws.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"
#include "option_bounds.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

/// Synthesis with the draws of (4.1) that rate what it returns.
struct SynthesisCall {
  SynthesisOptions search;
  SurfaceDrawOptions draws;
  void check() const {
    search.check();
    draws.check();
  }
};

const std::vector<OptionField<SynthesisCall>>& synthesis_fields() {
  using C = SynthesisCall;
  using O = SynthesisOptions;
  using S = SuccessOptions;
  using P = ContactPatchOptions;
  const auto search = [](const char* name, auto O::*member, const char* help) {
    return option<C>(name, &C::search, member, help);
  };
  const auto success = [](const char* name, double S::*member, const char* help) {
    return OptionField<C>{name, "float", [=](C& c, const py::handle& v) { convert(v, name, c.search.success.*member); },
                          [=](const C& c) { return py::cast(c.search.success.*member); }, help};
  };
  const auto patch = [](const char* name, auto P::*member, const char* help) {
    using Value = std::decay_t<decltype(std::declval<P>().*member)>;
    return OptionField<C>{name, annotation<Value>(),
                          [=](C& c, const py::handle& v) { convert(v, name, c.search.patch.*member); },
                          [=](const C& c) { return py::cast(c.search.patch.*member); }, help};
  };
  static const std::vector<OptionField<C>> fields{
      search("samples", &O::samples, "grasps evaluated, a third of them around the best of the others"),
      search("refined", &O::refined, "grasps around which the second search goes on"),
      search("shift", &O::shift, "farthest that the second search shifts a grasp [m]"),
      search("max_tilt", &O::max_tilt, "of the approach against straight down [rad]"),
      search("table_tolerance", &O::table_tolerance,
             "what the map has up to this, or to `sigmas` of its own, above the table is the table [m]"),
      search("sigmas", &O::sigmas, "standard deviations of the surface kept free around the hand"),
      search("margin", &O::margin, "kept free beside them, and above the table [m]"),
      search("approach_distance", &O::approach_distance, "straight way in that must be free [m]"),
      search("min_distance", &O::min_distance, "between returned grasps that close along about one axis [m]"),
      search("max_grasps", &O::max_grasps, "best kept"),
      search("threads", &O::threads, "0: all"),
      search("seed", &O::seed, "same seed, same grasps"),
      success("friction", &S::friction, "Coulomb coefficient; P3's theta is 2 atan(friction)"),
      success("angle_weight", &S::angle_weight, "w_1 of (4.9); the four sum to 1"),
      success("placement_weight", &S::placement_weight, "w_2: of the pads' distances from the surface"),
      success("centring_weight", &S::centring_weight, "w_3: of the contact line's distance from the object's middle"),
      success("certainty_weight", &S::certainty_weight, "w_4: of the surface's standard deviation"),
      success("placement_scale", &S::placement_scale, "sigma_h^2 of (4.6) [m]"),
      success("max_sigma", &S::max_sigma, "surfaces less certain are not touched [m]"),
      patch("rays", &P::rays, "along each side of a pad"),
      patch("min_hits", &P::min_hits, "share of a pad's rays that must meet the surface"),
      patch("min_inliers", &P::min_inliers, "share of the hits that must lie in one plane"),
      patch("plane_tolerance", &P::plane_tolerance, "farthest that an inlier lies from the plane [m]"),
      option<C>("correlation_length", &C::draws, &SurfaceDrawOptions::correlation_length,
                "over which the error of the surface changes, for `surface_draws` [m]")};
  return fields;
}

const BoundedOptions<SynthesisCall>& synthesis_options() {
  const Bounds length{0, 10, "m"}, some_length{1e-9, 10, "m"}, share{0, 1, ""}, some_share{1e-9, 1, ""};
  static const BoundedOptions<SynthesisCall> options(synthesis_fields(), {{"samples", {1, 1e6, "grasps"}},
                                                                          {"refined", {1, 1e6, "grasps"}},
                                                                          {"shift", length},
                                                                          {"max_tilt", {0, 3.2, "rad"}},
                                                                          {"table_tolerance", length},
                                                                          {"sigmas", {0, 100, "standard deviations"}},
                                                                          {"margin", length},
                                                                          {"approach_distance", length},
                                                                          {"min_distance", length},
                                                                          {"max_grasps", {1, 1e6, "grasps"}},
                                                                          {"threads", {0, 1024, "(0: all)"}},
                                                                          {"seed", {0, kMostSeed, ""}},
                                                                          {"friction", {0.001, 10, ""}},
                                                                          {"angle_weight", share},
                                                                          {"placement_weight", share},
                                                                          {"centring_weight", share},
                                                                          {"certainty_weight", share},
                                                                          {"placement_scale", some_length},
                                                                          {"max_sigma", some_length},
                                                                          {"rays", {2, 50, "rays"}},
                                                                          {"min_hits", some_share},
                                                                          {"min_inliers", some_share},
                                                                          {"plane_tolerance", some_length},
                                                                          {"correlation_length", some_length}});
  return options;
}

void bind_success(py::module_& m) {
  using S = GraspSuccess;
  py::class_<S>(m, "GraspSuccess", "Share of each criterion in a grasp's success (P3 4.5 to 4.9), in [0, 1].")
      .def_readonly("angle", &S::angle, "P_1: the pads face their patches.")
      .def_readonly("placement", &S::placement, "P_2: the pads are as far from the surface as wanted.")
      .def_readonly("centring", &S::centring, "P_3: the contact line passes by the object's middle.")
      .def_readonly("certainty", &S::certainty, "P_4: the surface is certain where it is touched.")
      .def_readonly("weighted", &S::weighted, "(4.9) as printed.")
      .def_readonly("force_closure", &S::force_closure, "The contact line lies in both friction cones.")
      .def_readonly("probability", &S::probability,
                    "`weighted`; 0 without force closure or where the angle or certainty is 0.")
      .def(
          "to_dict",
          [](const S& s) {
            return py::dict("angle"_a = s.angle, "placement"_a = s.placement, "centring"_a = s.centring,
                            "certainty"_a = s.certainty, "weighted"_a = s.weighted, "force_closure"_a = s.force_closure,
                            "probability"_a = s.probability);
          },
          "All of it by name.")
      .def("__repr__",
           [](const S& s) { return "GraspSuccess(" + std::string(py::repr(py::float_(s.probability))) + ")"; });
  using P = ContactPatch;
  py::class_<P>(m, "ContactPatch", "What a finger's pad meets if it moves on along its normal, in the world.")
      .def_readonly("point", &P::point, "Middle of the patch [m].")
      .def_readonly("normal", &P::normal, "Away from the object.")
      .def_readonly("pad_normal", &P::pad_normal, "The way the pad pushes.")
      .def_readonly("distance", &P::distance, "From the pad, on average [m].")
      .def_readonly("nearest", &P::nearest, "From the pad to what it touches first [m].")
      .def_readonly("sigma", &P::sigma, "Standard deviation of the surface, on average [m].")
      .def_readonly("hits", &P::hits, "Share of the pad's rays that meet the surface.")
      .def_readonly("inliers", &P::inliers, "Share of the hits that lie in the plane.")
      .def("__repr__", [](const P& p) { return "ContactPatch(at " + text(p.point) + ")"; });
  using D = DrawnSuccess;
  py::class_<D>(m, "DrawnSuccess", "The whole probability (4.1) by drawing surfaces from the map.")
      .def_readonly("probability", &D::probability, "Mean success over the drawn surfaces.")
      .def_readonly("standard_error", &D::standard_error, "Standard error of that mean.")
      .def_readonly("holds", &D::holds, "Share of the surfaces on which the grasp has force closure.")
      .def("__repr__",
           [](const D& d) { return "DrawnSuccess(" + std::string(py::repr(py::float_(d.probability))) + ")"; });
  using R = GraspRating;
  py::class_<R>(m, "GraspRating", "How a grasp of synthesize_grasps was rated.")
      .def_readonly("success", &R::success, "Share of each criterion.")
      .def_readonly("patches", &R::patches, "One a finger.")
      .def_readonly("pretouch_opening", &R::pretouch_opening, "Between the pads before they close [m].")
      .def_readonly("pretouch_posture", &R::pretouch_posture, "The same of hands with several joint groups.")
      .def_readonly("drawn", &R::drawn, "The whole probability (4.1); None unless `surface_draws` was given.")
      .def_property_readonly(
          "q",
          [](const R& r) -> std::optional<Eigen::VectorXd> { return r.q.size() ? std::optional(r.q) : std::nullopt; },
          "The arm's configuration before closing; None without an arm.")
      .def("__repr__",
           [](const R& r) { return "GraspRating(" + std::string(py::repr(py::float_(r.success.probability))) + ")"; });
}

constexpr char kCounts[] = "mmgrasp.records.SynthesisCounts";
using CountsDict = Shown<kCounts>;

CountsDict counts_dict(const SynthesisCounts& c) {
  return py::dict("drawn"_a = c.drawn, "no_opposite"_a = c.no_opposite, "too_wide"_a = c.too_wide,
                  "too_thin"_a = c.too_thin, "tilted"_a = c.tilted, "evaluated"_a = c.evaluated, "missed"_a = c.missed,
                  "uneven"_a = c.uneven, "slipping"_a = c.slipping, "uncertain"_a = c.uncertain,
                  "collision"_a = c.collision, "table"_a = c.table, "arm"_a = c.arm, "near_better"_a = c.near_better);
}

void bind_line_grasp(py::module_& m) {
  using L = LineGrasp;
  py::class_<L>(
      m, "LineGrasp",
      "P3's grasp in one dimension (4.4.2, figures 4.5 and 4.6): a parallel gripper on a line, and an object whose "
      "place is uncertain.")
      .def(py::init([](double width, double max_opening) {
             const L made{width, max_opening};
             made.check();
             return made;
           }),
           "width"_a = L{}.width, "max_opening"_a = L{}.max_opening,
           "The object's width, and the gripper's largest opening [m].")
      .def_readonly("width", &L::width, "The object's width [m].")
      .def_readonly("max_opening", &L::max_opening, "The gripper's largest opening [m].")
      .def("success", &L::success, "opening"_a, "position"_a, "object"_a,
           "P(S | x, G) of (4.3) and (4.4) for an object at a known place [m].")
      .def("probability", &L::probability, "opening"_a, "position"_a, "mean"_a, "sigma"_a,
           "P(S) of (4.1) for an object at N(mean, sigma^2), in closed form.")
      .def("__repr__",
           [](const L& l) { return "LineGrasp(width=" + std::string(py::repr(py::float_(l.width))) + ")"; });
}

void bind_result(py::module_& m) {
  using G = GraspSynthesis;
  py::class_<G>(m, "GraspSynthesis", "Grasps of an unknown part, most probable first, and why others were left out.")
      .def_readonly("outcome", &G::outcome, "solved, not_found or stopped.")
      .def_readonly("grasps", &G::grasps, "Most probable first; T_object_hand is the pose in the world.")
      .def_readonly("ratings", &G::ratings, "Ratings of the grasps, in the same order.")
      .def_property_readonly(
          "counts", [](const G& g) -> CountsDict { return counts_dict(g.counts); },
          "Surface points drawn and grasps evaluated, by what became of them.")
      .def_readonly("arm", &G::arm, "Why the arm did not reach grasps.")
      .def_property_readonly(
          "object_centre", [](const G& g) { return g.object.centre; },
          "Middle of the box fitted to the map's points [m].")
      .def_property_readonly(
          "object_longest", [](const G& g) { return g.object.longest; }, "Its longest side [m].")
      .def_readonly("opens", &G::opens, "Largest opening of the hand [m].")
      .def_readonly("median_too_wide", &G::median_too_wide,
                    "Median distance of opposite walls that are farther apart than that [m]; 0: none.")
      .def("summary", &G::summary, "One sentence: how many grasps, or what most of those tried failed on.")
      .def("__repr__", [](const G& g) { return "GraspSynthesis(" + g.summary() + ")"; });
}

std::optional<Eigen::AlignedBox3d> box_argument(const OptionalArray& value) {
  if (value.is_none()) return {};
  const Eigen::MatrixXd rows = matrix_argument(value, "object", 3);
  require(rows.rows() == 2, "object", std::to_string(rows.rows()) + " rows", "must be two, least and largest corner");
  return Eigen::AlignedBox3d(rows.row(0).transpose(), rows.row(1).transpose());
}

/// Reach of an arm from the middle of its limits unless told; none without an arm.
ArmReach reach_argument(const JointGroup* arm, const World* world, const OptionalArray& arm_seed) {
  require(arm != nullptr || world == nullptr, "world", "given", "goes with an arm");
  if (arm == nullptr) return {};
  const Eigen::VectorXd seed = arm_seed.is_none() ? Eigen::VectorXd((arm->sample_lower() + arm->sample_upper()) / 2)
                                                  : vector_argument(arm_seed, "arm_seed", arm->size());
  return make_arm_reach(world ? with_sampled_pairs(*arm) : *arm, seed, world);
}

const std::vector<OptionField<NextViewOptions>>& next_view_fields() {
  using O = NextViewOptions;
  using S = SynthesisOptions;
  const auto search = [](const char* name, auto S::*member, const char* help) {
    return option<O>(name, &O::synthesis, member, help);
  };
  static const std::vector<OptionField<O>> fields{
      option<O>("candidates", &O::candidates, "camera poses on the sphere around the object"),
      option<O>("distance", &O::distance, "of the camera from the middle of the object [m]"),
      option<O>("min_elevation", &O::min_elevation, "lowest camera above the horizontal through the middle [rad]"),
      option<O>("max_elevation", &O::max_elevation, "highest [rad]"),
      option<O>("draws", &O::draws, "frames imagined of each pose, each with noise of its own"),
      option<O>("max_width", &O::max_width, "imagined frames have no more columns [pixels]"),
      option<O>("threads", &O::threads, "0: all"),
      option<O>("seed", &O::seed, "same seed, same view"),
      search("samples", &S::samples, "grasps evaluated in each imagined map"),
      search("max_tilt", &S::max_tilt, "of the approach against straight down [rad]"),
      search("sigmas", &S::sigmas, "standard deviations of the surface kept free around the hand"),
      search("margin", &S::margin, "kept free beside them, and above the table [m]")};
  return fields;
}

void bind_next_view(py::module_& m) {
  using C = ViewCandidate;
  py::class_<C>(m, "ViewCandidate", "A camera pose and what is expected of it.")
      .def_property_readonly(
          "T_world_camera", [](const C& c) { return Eigen::Matrix4d(c.T_world_camera.matrix()); }, "(4, 4)")
      .def_readonly("probability", &C::probability, "Best grasp's, once the frame is in the map.")
      .def_readonly("certain", &C::certain, "How much surface would be certain, in shares of the candidate with most.")
      .def_readonly("unseen", &C::unseen, "Share of the object's pixels that would show what the map does not know.")
      .def_readonly("q", &C::q, "The arm's configuration; empty without an arm.")
      .def("__repr__", [](const C& c) { return "ViewCandidate(probability " + std::to_string(c.probability) + ")"; });
  using V = NextView;
  py::class_<V>(m, "NextView", "Where to look next.")
      .def_readonly("outcome", &V::outcome, "solved, not_found (the arm reaches no pose) or stopped.")
      .def_readonly("probability_now", &V::probability_now, "Best grasp's in the map as it is; 0: there is none.")
      .def_readonly("candidates", &V::candidates, "Those within reach, the best first.")
      .def_readonly("arm", &V::arm, "Why the arm did not reach others.")
      .def("__repr__",
           [](const V& v) { return "NextView(" + std::to_string(v.candidates.size()) + " poses within reach)"; });
  m.def(
      "next_view",
      [](const ProbabilisticSdf& map, const Hand& hand, const DepthCamera& camera, const std::optional<double>& table,
         const OptionalArray& object, const Robot* robot, const JointGroup* arm, const World* world,
         const OptionalArray& arm_seed, const OptionalArray& pose_covariance, const Progress& progress,
         const py::kwargs& options) {
        NextViewOptions chosen = read_options(next_view_fields(), options, "next_view");
        chosen.synthesis.table = table;
        chosen.synthesis.object = box_argument(object);
        if (!pose_covariance.is_none()) {
          const Eigen::MatrixXd C = matrix_argument(pose_covariance, "pose_covariance", 6);
          require(C.rows() == 6, "pose_covariance", static_cast<double>(C.rows()), "must have 6 rows");
          chosen.uncertainty.pose_covariance = C;
        }
        const ArmReach reach = reach_argument(arm, world, arm_seed);
        return LongCall(progress).run([&](const Monitor& monitor) {
          const auto model = robot ? make_hand_model(hand, *robot) : make_hand_model(hand);
          return next_view(map, *model, camera, chosen, monitor, reach);
        });
      },
      "map"_a, "hand"_a, "camera"_a, py::kw_only(), "table"_a = py::none(), "object"_a = py::none(),
      "robot"_a = py::none(), "arm"_a = py::none(), "world"_a = py::none(), "arm_seed"_a = py::none(),
      "pose_covariance"_a = py::none(), "progress"_a = py::none(),
      ("The reachable camera pose after which the best grasp of a part is expected to be most probable.\n\nPoses lie "
       "on "
       "a sphere around the object. From each a frame is imagined (the map's surface, and behind it the hull of\nwhat "
       "was seen), integrated into a copy of the map, and grasps are searched for there. `camera` is the one that "
       "will\n"
       "look, `pose_covariance` (6, 6) that of its pose; `arm` is a group whose tip is the camera, other arguments are "
       "as in\nsynthesize_grasps(). Raises InvalidInput for a map without a surface." +
       option_help(next_view_fields()))
          .c_str());
}

}  // namespace

void bind_synthesis(py::module_& m) {
  m.def(
      "eigengrasp_hand",
      [](const Robot& robot, const std::string& tool_link,
         const std::vector<std::pair<std::string, std::vector<std::string>>>& groups, const ArrayLike& open,
         const ArrayLike& closed, const ArrayLike& approach, const std::string& name, double clearance) {
        std::vector<EigengraspGroup> made;
        Eigen::Index count = 0;
        for (const auto& [group, joints] : groups) {
          made.push_back({group, joints});
          count += static_cast<Eigen::Index>(joints.size());
        }
        return eigengrasp_hand(robot, tool_link, made,
                               {name, vector_argument(open, "open", count), vector_argument(closed, "closed", count)},
                               vector3_argument(approach, "approach"), clearance);
      },
      "robot"_a, "tool_link"_a, "groups"_a, py::kw_only(), "open"_a, "closed"_a, "approach"_a = py::make_tuple(0, 0, 1),
      "name"_a = "type", "clearance"_a = 0.01,
      "A robot hand set up for one type of grasp (P3 4.6.1, Algorithm 3): `groups` are (name, joints) pairs, `open` "
      "and "
      "`closed`\nthe values of all their joints in that order. Groups whose values agree keep them. "
      "`clearance` "
      "is kept free on each side of a part while\nmoving in [m]; the links of the pads are its finger links. Raises "
      "InvalidInput on "
      "unknown joints,\nvalues outside limits, and when no two fingertips close on each other.");
  m.def(
      "_closing_line",
      [](const Hand& hand, const Robot& robot, double share) {
        require(share >= 0 && share <= 1, "share", share, "must be in [0, 1]");
        const auto model = make_hand_model(hand, robot);
        const std::vector<FingerPad> pads = model->pads(std::vector<double>(model->groups(), share));
        const ClosingLine line = closing_line(pads);
        double slant = 0;
        for (const FingerPad& pad : pads)
          slant = std::max(slant, std::acos(std::min(1.0, std::abs(pad.T_hand_pad.linear().col(2).dot(line.axis)))));
        return std::tuple{line.middle, line.opening, slant};
      },
      "hand"_a, "robot"_a, "share"_a,
      "Where the pads of a hand of many joints, open by `share` in [0, 1], would meet, in its tool frame (3,) [m], how "
      "far apart\nthey are (negative: they have passed each other) [m], and the steepest angle of a pad's push to the "
      "line on which they close [rad].");
  m.def("_synthesis_option_table", [] { return option_table(synthesis_fields()); });
  m.def("_synthesis_option_bounds", [] { return synthesis_options().bounds(); });
  bind_success(m);
  bind_line_grasp(m);
  bind_result(m);
  bind_next_view(m);
  m.def(
      "synthesize_grasps",
      [](const ProbabilisticSdf& map, const Hand& hand, const std::optional<double>& table, const OptionalArray& object,
         const Robot* robot, const JointGroup* arm, const World* world, const OptionalArray& arm_seed,
         int surface_draws, const Progress& progress, const py::kwargs& options) {
        SynthesisCall call = synthesis_options().read(options, "synthesize_grasps");
        call.search.table = table;
        call.search.object = box_argument(object);
        require(surface_draws >= 0, "surface_draws", surface_draws, "must be zero or positive");
        const ArmReach reach = reach_argument(arm, world, arm_seed);
        return LongCall(progress).run([&](const Monitor& monitor) {
          const auto model = robot ? make_hand_model(hand, *robot) : make_hand_model(hand);
          GraspSynthesis found = synthesize_grasps(map, *model, call.search, monitor, reach);
          if (surface_draws > 0) {
            call.draws.draws = surface_draws;
            draw_success(map, *model, call.draws, call.search, found);
          }
          return found;
        });
      },
      "map"_a, "hand"_a, py::kw_only(), "table"_a = py::none(), "object"_a = py::none(), "robot"_a = py::none(),
      "arm"_a = py::none(), "world"_a = py::none(), "arm_seed"_a = py::none(), "surface_draws"_a = 0,
      "progress"_a = py::none(),
      ("Grasps of an unknown part in a ProbabilisticSdf, most probable by P3's model (4.9) first.\n\n`table` is the "
       "height of the level table that it stands on [m], `object` a box (2, 3) that holds it, least and largest\n"
       "corner [m]; without them all of the map is the part. `robot` has the joints and bodies of a hand "
       "of\neigengrasp_hand, which needs it; without it "
       "the hand is two pads and its boxes. With `arm`, a group whose tip is the hand's tool link, "
       "grasps "
       "are\nleft out that it does not reach, with `world` without collisions, by inverse kinematics from `arm_seed` "
       "(the "
       "middle\nof the limits). `surface_draws` > 0 rates what is returned by (4.1) too. Raises InvalidInput for a map "
       "without a surface and for a hand of several groups of joints without `robot`." +
       option_help(synthesis_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
