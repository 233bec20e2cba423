#include "batch.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/detail/edge_steps.hpp"
#include "mmgrasp/collision/detail/placed_bodies.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/limits.hpp"
#include "plan_arguments.hpp"
#include "same_robot.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<CheckerOptions>>& checker_fields() {
  using O = CheckerOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("padding", &O::padding,
                "links are padded by at least this against the scene, whatever the world's padding [m]"),
      option<O>("check_self", &O::check_self, "robot (and what it holds) against itself"),
      option<O>("check_scene", &O::check_scene, "robot (and what it holds) against the scene"),
      option<O>("attached_only", &O::attached_only, "only what it holds, against the robot and the scene")};
  return fields;
}

const std::vector<OptionField<EdgeOptions>>& edge_fields() {
  using O = EdgeOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("joint_step", &O::joint_step, "no joint moves more than this between two checks [rad or m]"),
      option<O>("workspace_step", &O::workspace_step, "no point moves more than this between two checks [m]"),
      option<O>("continuous", &O::continuous, "conservative advancement instead of steps"),
      option<O>("tolerance", &O::tolerance, "continuous only: gaps below this count as contact [m]")};
  return fields;
}

void bind_answers(py::module_& m) {
  py::class_<Contact>(m, "Contact", "Two bodies that touch.")
      .def_readonly("a", &Contact::a, "A robot link or an attached object.")
      .def_readonly("b", &Contact::b, "A robot link, an attached object or an object of the scene.")
      .def_readonly("with_scene", &Contact::with_scene, "`b` is an object of the scene.")
      .def_readonly("by_padding", &Contact::by_padding, "The bodies stay apart: only their padding meets.")
      .def(
          "to_dict",
          [](const Contact& c) {
            return py::dict("a"_a = c.a, "b"_a = c.b, "with_scene"_a = c.with_scene, "by_padding"_a = c.by_padding);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const Contact& c) {
        return "Contact('" + c.a + "', '" + c.b + (c.by_padding ? "', by padding)" : "')");
      });
  py::class_<DistanceResult>(m, "DistanceResult", "The smallest distance and where it is.")
      .def_readonly("value", &DistanceResult::value,
                    "[m]; negative: depth, exact for convex bodies (see docs/methods/collision.md for others).")
      .def_readonly("a", &DistanceResult::a, "One body of the closest pair: a robot link or an attached object.")
      .def_readonly("b", &DistanceResult::b,
                    "The other body: a robot link, an attached object or an object of the scene.")
      .def_readonly("point_a", &DistanceResult::point_a, "(3,) in the world frame.")
      .def_readonly("point_b", &DistanceResult::point_b, "The closest point on `b` (3,) in the world frame [m].")
      .def_readonly("with_scene", &DistanceResult::with_scene, "`b` is an object of the scene.")
      .def_property_readonly(
          "gradient",
          [](const DistanceResult& d) -> MaybeFloats {
            return d.gradient.size() > 0 ? py::cast(d.gradient) : py::none();
          },
          "d value / d q, (n,); None unless it was asked for.")
      .def(
          "to_dict",
          [](const DistanceResult& d) {
            py::dict out("value"_a = d.value, "a"_a = d.a, "b"_a = d.b, "with_scene"_a = d.with_scene,
                         "point_a"_a = py::cast(d.point_a).attr("tolist")(),
                         "point_b"_a = py::cast(d.point_b).attr("tolist")());
            if (d.gradient.size() > 0) out["gradient"] = py::cast(d.gradient).attr("tolist")();
            return out;
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__float__", [](const DistanceResult& d) { return d.value; })
      .def("__repr__", [](const DistanceResult& d) {
        return "DistanceResult(" + std::string(py::repr(py::float_(d.value))) + " m between '" + d.a + "' and '" + d.b +
               "')";
      });
  py::class_<EdgeResult>(m, "EdgeResult",
                         "Whether a straight joint-space edge is free, and where it is refused if not.")
      .def_readonly("free", &EdgeResult::free, "The whole edge is free.")
      .def_readonly("fraction", &EdgeResult::fraction,
                    "Where along the edge the first refused check was, in [0, 1]; 1 when free.")
      .def_readonly("contact", &EdgeResult::contact, "What touches there; None when limits refuse it or all is free.")
      .def_readonly("checks", &EdgeResult::checks, "Configurations checked.")
      .def("__bool__", [](const EdgeResult& r) { return r.free; })
      .def(
          "to_dict",
          [](const EdgeResult& r) {
            return py::dict("free"_a = r.free, "fraction"_a = r.fraction,
                            "contact"_a = r.contact ? py::cast(*r.contact).attr("to_dict")() : py::none(),
                            "checks"_a = r.checks);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const EdgeResult& r) {
        if (r.free) return std::string("EdgeResult(free)");
        const std::string why = r.contact ? describe(*r.contact) : std::string("joint limits");
        return "EdgeResult(refused at " + std::string(py::repr(py::float_(r.fraction))) + ": " + why + ")";
      });
}

Eigen::VectorXd configuration(const CollisionChecker& checker, const ArrayLike& q, const char* name) {
  return vector_argument(q, name, checker.group().size());
}

/// Edges of so many checks or more are looked at without the interpreter's lock.
constexpr double kLongEdge = 200;

/// A clone looks at a long edge, as other threads may ask the checker meanwhile.
template <typename Work>
auto along_edge(CollisionChecker& checker, double pieces, const Work& work) {
  if (pieces < kLongEdge) return work(checker);
  CollisionChecker own = checker.clone();
  return interruptible([&] { return work(own); });
}

EdgeResult check_edge_of(CollisionChecker& c, const ArrayLike& from, const ArrayLike& to, const py::kwargs& options) {
  const Eigen::VectorXd q0 = configuration(c, from, "q0"), q1 = configuration(c, to, "q1"), delta = q1 - q0;
  const EdgeOptions read = read_options(edge_fields(), options, "check_edge");
  const double step = detail::edge_step(delta, motion_bounds(c), read.joint_step, read.workspace_step);
  const double pieces = read.continuous ? kLongEdge : detail::edge_pieces(delta.lpNorm<Eigen::Infinity>(), step);
  return along_edge(c, pieces, [&](CollisionChecker& checker) { return check_edge(checker, q0, q1, read); });
}

bool edge_is_free_of(CollisionChecker& c, const ArrayLike& from, const ArrayLike& to, const Given<double>& given_step) {
  const double step = taken(given_step, "joint_step");
  if (!(step > 0)) throw InvalidInput("joint_step = " + std::to_string(step) + ": must be > 0");
  const Eigen::VectorXd q0 = configuration(c, from, "q0"), q1 = configuration(c, to, "q1");
  const double pieces = detail::edge_pieces((q1 - q0).lpNorm<Eigen::Infinity>(), step);
  return along_edge(c, pieces, [&](CollisionChecker& checker) { return checker.edge_is_free(q0, q1, step); });
}

py::array_t<bool> are_free_of_rows(const CollisionChecker& c, const ArrayLike& Q, int threads) {
  const auto rows = batch_argument(Q, "Q", c.group().size());
  const CollisionChecker own = c.clone();
  py::array_t<bool> out(rows.shape(0));
  bool* to = out.mutable_data();
  in_pieces(rows.shape(0), [&](Eigen::Index first, Eigen::Index count) {
    const std::vector<char> free = are_free(own, columns_of(rows, first, count), threads);
    std::copy(free.begin(), free.end(), to + first);
  });
  return out;
}

void bind_checker(py::module_& m) {
  m.def("_checker_option_table", [] { return option_table(checker_fields()); });
  m.def("_edge_option_table", [] { return option_table(edge_fields()); });
  py::class_<CollisionChecker>(
      m, "CollisionChecker",
      "Collision questions about one group in a snapshot of the world: later changes of the world are not seen.\n"
      "\n"
      "    checker = mg.CollisionChecker(robot, world, arm)\n"
      "    if checker.is_free(q) and checker.edge_is_free(q, q_goal):\n"
      "        print(checker.distance(q).value)\n"
      "\n"
      "Pairs of links are sampled (and cached) when no SRDF says which never touch.")
      .def(
          py::init([](const Given<Robot>& robot, const Given<World>& world, const Given<JointGroup>& given_group,
                      const py::kwargs& options) {
            const JointGroup& group = taken(given_group, "group");
            check_same_robot(taken(robot, "robot"), group);
            const World scene = taken(world, "world");  // a snapshot: other threads may change the world meanwhile
            const CheckerOptions read = read_options(checker_fields(), options, "CollisionChecker");
            const JointGroup paired = with_sampled_pairs(group);
            return interruptible([&] { return CollisionChecker(paired, scene, read); });
          }),
          py::arg("robot"), py::arg("world"), py::arg("group"),
          ("For configurations of `group` of `robot` in `world` as it is now." + option_help(checker_fields())).c_str())
      .def_property_readonly("group", &CollisionChecker::group, "The group whose configurations it checks.")
      .def(
          "is_free", [](CollisionChecker& c, const ArrayLike& q) { return c.is_free(configuration(c, q, "q")); },
          py::arg("q"), "Inside limits and without any contact.")
      .def(
          "rejection", [](CollisionChecker& c, const ArrayLike& q) { return c.rejection(configuration(c, q, "q")); },
          py::arg("q"), "The first cause found (limits, self_collision, scene), or Rejection.none.")
      .def(
          "contacts", [](CollisionChecker& c, const ArrayLike& q) { return c.contacts(configuration(c, q, "q")); },
          py::arg("q"), "Every touching pair; limits are not checked.")
      .def(
          "first_contact",
          [](CollisionChecker& c, const ArrayLike& q) { return c.first_contact(configuration(c, q, "q")); },
          py::arg("q"), "One touching pair, self before scene, or None; limits are not checked.")
      .def(
          "distance",
          [](CollisionChecker& c, const ArrayLike& q, bool gradient) {
            const Eigen::VectorXd values = configuration(c, q, "q");
            return gradient ? c.distance_and_gradient(values) : c.distance(values);
          },
          py::arg("q"), py::arg("gradient") = false,
          "Smallest signed distance over all checked pairs, padding not subtracted; with `gradient` also d value / d "
          "q.\n"
          "Infinite when there is no pair.")
      .def(
          "distances",
          [](CollisionChecker& c, const ArrayLike& q, const Given<double>& within) {
            return c.distances(configuration(c, q, "q"), taken(within, "within"));
          },
          py::arg("q"), py::arg("within"),
          "Every pair of bodies nearer than `within` [m], nearest first, each with its gradient.")
      .def("are_free", &are_free_of_rows, py::arg("Q"), py::arg("threads") = 0,
           "is_free of each row of Q (m, n), as (m,) booleans; 0 threads: all.")
      .def("check_edge", &check_edge_of, py::arg("q0"), py::arg("q1"),
           ("The straight joint-space edge with what refuses it: in steps, or by conservative advancement." +
            option_help(edge_fields()))
               .c_str())
      .def_property_readonly(
          "motion_bounds", [](const CollisionChecker& c) { return motion_bounds(c); },
          "(n,) bounds on how far any point moves when a joint moves by one unit [m/rad or m/m].")
      .def("clone", &CollisionChecker::clone, "The same checker with scratch of its own, for another thread.")
      .def("edge_is_free", &edge_is_free_of, py::arg("q0"), py::arg("q1"), py::arg("joint_step") = 0.02,
           "The straight joint-space edge, checked so finely that no joint moves more than `joint_step` [rad or m].")
      .def("__repr__", [](const CollisionChecker& c) {
        return "CollisionChecker('" + c.group().robot().name() + "', group '" + c.group().name() + "', " +
               std::to_string(c.world().objects().size()) + " objects)";
      });
}

using PlacedBodies = mmgrasp::detail::PlacedBodies;

PlacedBodies placed_bodies(const std::vector<LinkShape>& shapes, const ArrayLike& T_world_body) {
  return {shapes, shapes.empty() ? Poses{} : poses_argument(T_world_body, "T_world_body")};
}

void bind_placed_bodies(py::module_& m) {
  py::class_<PlacedBodies>(m, "_PlacedBodies", "Shapes where they are at one time, one T_world_body (4, 4) a shape.")
      .def(py::init(&placed_bodies), "shapes"_a, "T_world_body"_a)
      .def(
          "distance",
          [](const PlacedBodies& own, const PlacedBodies& other, double within) {
            require_not_negative(within, "within", "m");
            return own.distance(other, within);
          },
          "other"_a, "within"_a);
}

}  // namespace

void bind_collision(py::module_& m) {
  bind_world(m);
  bind_answers(m);
  bind_checker(m);
  bind_placed_bodies(m);
  bind_disabled_pairs(m);
}

}  // namespace mmgrasp::python
