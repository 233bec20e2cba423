#include <map>
#include <string_view>

#include "bindings.hpp"
#include "mmgrasp/collision/detail/named_bodies.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/packages.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "mmgrasp/robot/robot_source.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kPackageFolders[] = "collections.abc.Mapping[str, str | os.PathLike[str]] | None";
using PackageFolders = Shown<kPackageFolders>;
constexpr char kRobotReport[] = "mmgrasp.records.RobotReport";
using RobotReportDict = Shown<kRobotReport>;
constexpr char kJointRows[] = "list[mmgrasp.records.JointRow]";
using JointRows = Shown<kJointRows>;
constexpr char kGroupRows[] = "dict[str, mmgrasp.records.GroupRow]";
using GroupRows = Shown<kGroupRows>;
constexpr char kEndEffectorRows[] = "list[mmgrasp.records.EndEffectorRow]";
using EndEffectorRows = Shown<kEndEffectorRows>;
constexpr char kLinkPairs[] = "list[tuple[str, str, str]]";
using LinkPairs = Shown<kLinkPairs>;
constexpr char kXacroArguments[] = "collections.abc.Mapping[str, typing.Any] | None";
using XacroArguments = Shown<kXacroArguments>;
constexpr char kBaseLimitsDict[] = "collections.abc.Mapping[str, float | None] | None";
using BaseLimitsDict = Shown<kBaseLimitsDict>;

using namespace py::literals;

const std::vector<OptionField<BaseLimits>>& base_limit_fields() {
  static const std::vector<OptionField<BaseLimits>> fields{
      option<BaseLimits>("linear_velocity", &BaseLimits::linear_velocity, "[m/s]"),
      option<BaseLimits>("angular_velocity", &BaseLimits::angular_velocity, "[rad/s]"),
      option<BaseLimits>("linear_acceleration", &BaseLimits::linear_acceleration, "[m/s^2]"),
      option<BaseLimits>("angular_acceleration", &BaseLimits::angular_acceleration, "[rad/s^2]"),
      option<BaseLimits>("workspace", &BaseLimits::workspace, "x and y lie in [-workspace, workspace] [m]"),
      {"wheel_velocity", "float | None",
       [](BaseLimits& limits, const py::handle& value) {
         limits.wheel_velocity = detail::kInfinity;
         if (!value.is_none() && !value.equal(py::float_(limits.wheel_velocity)))
           convert(value, "wheel_velocity", limits.wheel_velocity);
       },
       [](const BaseLimits& limits) -> py::object { return py::float_(limits.wheel_velocity); },
       "of the rims of a diff-drive's or Mecanum wheels [m/s]; None or infinite: no limit"},
      option<BaseLimits>("wheel_separation", &BaseLimits::wheel_separation, "between left and right wheels [m]"),
      option<BaseLimits>("wheelbase", &BaseLimits::wheelbase,
                         "between front and rear wheels [m] of an omni base with four Mecanum wheels; 0: it has none")};
  return fields;
}

BaseLimits base_limits_argument(const py::object& value) {
  if (value.is_none()) return {};
  if (!py::isinstance<py::dict>(value)) refuse_value("base_limits", value, "a dict");
  return read_options(base_limit_fields(), py::kwargs(py::reinterpret_borrow<py::object>(value)), "base_limits");
}

std::map<std::string, std::string> package_argument(const py::object& value) {
  std::map<std::string, std::string> out;
  if (value.is_none()) return out;
  if (!py::isinstance<py::dict>(value)) refuse_value("package_dirs", value, "a dict from package name to folder");
  for (const auto& [key, folder] : py::cast<py::dict>(value)) {
    std::string package;
    convert(key, "package_dirs", package);
    out[package] = path_argument(folder, "package_dirs");
  }
  return out;
}

bool is_xacro(const std::string& path) {
  constexpr std::string_view kEnding = ".xacro";
  return path.size() >= kEnding.size() && path.compare(path.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
}

/// A robot of which at least one file is xacro: that one is expanded in Python, the other read as it is.
Robot load_expanded(const std::string& urdf_path, const std::string& srdf_path, const py::object& xacro_args,
                    const RobotOptions& options) {
  const py::module_ xacro = py::module_::import("mmgrasp.scenario.xacro_file");
  const auto text = [&](const std::string& path) {
    return py::cast<std::string>(xacro.attr("read_or_expand")(path, options.package_dirs, xacro_args));
  };
  const auto origin = [](const std::string& path) { return path + (is_xacro(path) ? " (expanded)" : ""); };
  const std::string urdf = text(urdf_path), srdf = srdf_path.empty() ? "" : text(srdf_path);
  return interruptible([&] { return Robot::from_strings(urdf, srdf, options, origin(urdf_path), origin(srdf_path)); });
}

RobotOptions robot_options(const py::object& package_dirs, const std::string& base, const py::object& base_limits,
                           bool load_meshes, bool allow_missing_meshes, double mesh_tolerance) {
  RobotOptions options;
  options.base = base_kind_from_string(base);
  options.base_limits = base_limits_argument(base_limits);
  options.package_dirs = package_argument(package_dirs);
  options.load_meshes = load_meshes;
  options.allow_missing_meshes = allow_missing_meshes;
  options.mesh_tolerance = mesh_tolerance;
  return options;
}

const char* reason_name(DisabledReason reason) {
  switch (reason) {
    case DisabledReason::adjacent:
      return "adjacent";
    case DisabledReason::never:
      return "never";
    case DisabledReason::always:
      return "always";
    case DisabledReason::user:
      return "user";
    case DisabledReason::default_:
      return "default";
  }
  return "user";
}

DisabledReason reason_from_name(const std::string& name) {
  for (DisabledReason reason : {DisabledReason::adjacent, DisabledReason::never, DisabledReason::always,
                                DisabledReason::user, DisabledReason::default_}) {
    if (name == reason_name(reason)) return reason;
  }
  throw InvalidInput("reason = '" + name + "': must be adjacent, never, always, user or default");
}

RobotReportDict report_dict(const RobotReport& report) {
  py::list meshes;
  for (const MeshReport& mesh : report.meshes) {
    meshes.append(py::dict("path"_a = mesh.path, "vertices_read"_a = mesh.vertices_read,
                           "vertices_merged"_a = mesh.vertices_merged,
                           "degenerate_triangles"_a = mesh.degenerate_triangles, "triangles"_a = mesh.triangles,
                           "closed"_a = mesh.closed, "convex"_a = mesh.convex, "chosen"_a = mesh.chosen,
                           "triangles_saved"_a = mesh.triangles_saved, "deviation"_a = mesh.deviation));
  }
  return py::dict("warnings"_a = report.warnings, "meshes"_a = meshes, "missing"_a = report.missing);
}

py::dict joint_dict(const Robot& robot, const Joint& joint) {
  py::object mimic = py::none();
  if (joint.mimic_joint >= 0) mimic = py::cast(robot.joints()[joint.mimic_joint].name);
  return py::dict("name"_a = joint.name, "type"_a = to_string(joint.type),
                  "parent"_a = robot.links()[joint.parent_link].name, "child"_a = robot.links()[joint.child_link].name,
                  "lower"_a = joint.lower, "upper"_a = joint.upper, "velocity"_a = joint.velocity, "mimic"_a = mimic);
}

std::vector<std::string> movable_joints(const Robot& robot) {
  std::vector<std::string> names;
  for (const Joint& joint : robot.joints()) {
    if (joint.value_index >= 0) names.push_back(joint.name);
  }
  return names;
}

std::string text_argument(const OptionalText& value, const char* name) {
  std::string text;
  convert(value, name, text);
  return text;
}

JointGroup make_group(const Robot& robot, const OptionalText& name, const OptionalText& tip,
                      const OptionalText& base_link, bool with_base) {
  const std::string tip_name = tip.is_none() ? "" : text_argument(tip, "tip");
  if (base_link.is_none()) {
    if (name.is_none()) throw InvalidInput("group(): give the name of an SRDF group, or base_link and tip");
    return robot.group(text_argument(name, "name"), tip_name, with_base);
  }
  if (!name.is_none()) throw InvalidInput("group(): give a group name or base_link, not both");
  if (tip.is_none()) throw InvalidInput("group(base_link=...): tip is missing");
  return robot.chain(text_argument(base_link, "base_link"), tip_name, with_base);
}

constexpr char kUrdfRows[] = "list[mmgrasp.records.UrdfRow]";
using UrdfRows = Shown<kUrdfRows>;
constexpr char kAddedLinkRows[] = "list[mmgrasp.records.AddedLinkRow]";
using AddedLinkRows = Shown<kAddedLinkRows>;

UrdfRows urdf_dicts(const RobotSource& source) {
  py::list out;
  for (const UrdfSource& u : source.urdfs) {
    out.append(py::dict("urdf"_a = u.urdf, "origin"_a = u.origin, "prefix"_a = u.prefix,
                        "parent_link"_a = u.parent_link, "T"_a = to_array(u.T_parent_root),
                        "mesh_files"_a = u.mesh_files));
  }
  return out;
}

AddedLinkRows added_link_dicts(const RobotSource& source) {
  py::list out;
  for (const AddedLink& link : source.added_links) {
    out.append(py::dict("name"_a = link.name, "parent_link"_a = link.parent_link, "T"_a = to_array(link.T_parent_link),
                        "shapes"_a = link.shapes));
  }
  return out;
}

void bind_robot_source(py::module_& m) {
  py::class_<RobotSource>(m, "RobotSource",
                          "What a robot was made of, unread: its URDFs as they were given, for those who read them by\n"
                          "other means than Robot does (verify).")
      .def(py::init([](const std::string& base, const BaseLimitsDict& base_limits, const std::string& srdf) {
             RobotSource source;
             source.base = base_kind_from_string(base);
             source.base_limits = base_limits_argument(base_limits);
             source.srdf = srdf;
             return source;
           }),
           py::arg("base") = "fixed", py::kw_only(), py::arg("base_limits") = py::none(), py::arg("srdf") = "",
           "Empty; add_urdf() adds what it was made of.")
      .def(
          "add_urdf",
          [](RobotSource& source, const std::string& urdf, const std::string& origin, const std::string& prefix,
             const std::string& parent_link, const OptionalArray& T,
             const std::map<std::string, std::string>& mesh_files) {
            source.urdfs.push_back({urdf, origin, prefix, parent_link, pose_argument(T, "T"), mesh_files});
          },
          py::arg("urdf"), py::kw_only(), py::arg("origin") = "<string>", py::arg("prefix") = "",
          py::arg("parent_link") = "", py::arg("T") = py::none(),
          py::arg("mesh_files") = std::map<std::string, std::string>{},
          "A URDF's text. Every name in it gets the prefix; its root link hangs at T on `parent_link` (empty: it is "
          "the\n"
          "robot's root). `mesh_files` maps the URDF's mesh filenames to files; an empty one leaves the mesh out.")
      .def(
          "add_link",
          [](RobotSource& source, const std::string& name, const std::string& parent_link, const OptionalArray& T,
             const std::vector<LinkShape>& shapes) {
            source.added_links.push_back({name, parent_link, pose_argument(T, "T"), shapes});
          },
          py::arg("name"), py::arg("parent_link"), py::arg("T") = py::none(),
          py::arg("shapes") = std::vector<LinkShape>{}, "A fixed link that comes from no URDF.")
      .def_property_readonly("urdfs", &urdf_dicts, "As dicts with the arguments of add_urdf.")
      .def_property_readonly("added_links", &added_link_dicts, "As dicts with the arguments of add_link.");
}

void bind_robot_class(py::module_& m) {
  auto robot = declared<Robot>(m, "Robot");
  robot
      .def_static(
          "load",
          [](const PathLike& urdf, const OptionalPath& srdf, const PackageFolders& package_dirs,
             const std::string& base, const BaseLimitsDict& base_limits, bool load_meshes, bool allow_missing_meshes,
             double mesh_tolerance, const XacroArguments& xacro_args) {
            const RobotOptions options =
                robot_options(package_dirs, base, base_limits, load_meshes, allow_missing_meshes, mesh_tolerance);
            const std::string urdf_path = path_argument(urdf, "urdf");
            const std::string srdf_path = srdf.is_none() ? "" : path_argument(srdf, "srdf");
            if (is_xacro(urdf_path) || is_xacro(srdf_path))
              return load_expanded(urdf_path, srdf_path, xacro_args, options);
            if (!xacro_args.is_none()) refuse_value("xacro_args", xacro_args, "None unless a file is called .xacro");
            return interruptible([&] { return Robot::load(urdf_path, srdf_path, options); });
          },
          py::arg("urdf"), py::arg("srdf") = py::none(), py::arg("package_dirs") = py::none(),
          py::arg("base") = "fixed", py::kw_only(), py::arg("base_limits") = py::none(), py::arg("load_meshes") = true,
          py::arg("allow_missing_meshes") = false, py::arg("mesh_tolerance") = 0.0, py::arg("xacro_args") = py::none(),
          "Reads a URDF and, if given, its SRDF. `base` is fixed, diff_drive or omni; `package_dirs` maps the names\n"
          "in package://NAME/... to folders. Files called .xacro are expanded first (needs the package xacro; macros\n"
          "are programs: expand only files you trust) with the arguments `xacro_args` (a dict). A box, hull, sphere "
          "or\n"
          "cylinder that contains a collision mesh and sticks out at most `mesh_tolerance` [m] replaces it; 0: only\n"
          "what is the same solid. Raises IoError or InvalidInput naming file, element, value and rule.")
      .def_static(
          "from_strings",
          [](const std::string& urdf, const std::string& srdf, const PackageFolders& package_dirs,
             const std::string& base, const BaseLimitsDict& base_limits, bool load_meshes, bool allow_missing_meshes,
             double mesh_tolerance, const std::string& origin) {
            const RobotOptions options =
                robot_options(package_dirs, base, base_limits, load_meshes, allow_missing_meshes, mesh_tolerance);
            return interruptible([&] { return Robot::from_strings(urdf, srdf, options, origin); });
          },
          py::arg("urdf"), py::arg("srdf") = "", py::arg("package_dirs") = py::none(), py::arg("base") = "fixed",
          py::kw_only(), py::arg("base_limits") = py::none(), py::arg("load_meshes") = true,
          py::arg("allow_missing_meshes") = false, py::arg("mesh_tolerance") = 0.0, py::arg("origin") = "<string>",
          "The same from the texts of URDF and SRDF; `origin` names the source in messages.")
      .def_property_readonly("name", &Robot::name, "As the URDF says.")
      .def_property_readonly(
          "base", [](const Robot& r) { return to_string(r.base()); }, "fixed, diff_drive or omni.")
      .def_property_readonly(
          "base_limits",
          [](const Robot& r) -> NamedFloats {
            py::dict out;
            for (const auto& field : base_limit_fields()) {
              out[field.name.c_str()] = field.get(r.base_limits());
            }
            return out;
          },
          "Speed and acceleration limits of the base, its workspace and its wheels, by keyword of `load`'s "
          "base_limits.")
      .def(
          "velocity_scale",
          [](const Robot& r, const ArrayLike& platform_velocity) {
            return velocity_scale(r.base(), r.base_limits(), vector3_argument(platform_velocity, "platform_velocity"));
          },
          py::arg("platform_velocity"),
          "Largest factor in [0, 1] that keeps a platform velocity (v_x, v_y, omega) inside the base's limits: speed,\n"
          "turning, wheels. 0 for what this base cannot do at all (sideways, or fixed).")
      .def_property_readonly(
          "links",
          [](const Robot& r) {
            std::vector<std::string> names;
            for (const Link& link : r.links()) names.push_back(link.name);
            return names;
          },
          "Names, root first.")
      .def_property_readonly(
          "joints", [](const Robot& r) { return movable_joints(r); },
          "Names of the movable joints that follow no other.")
      .def_property_readonly(
          "joint_table",
          [](const Robot& r) -> JointRows {
            py::list out;
            for (const Joint& joint : r.joints()) out.append(joint_dict(r, joint));
            return out;
          },
          "Every joint as a dict.")
      .def_property_readonly(
          "report", [](const Robot& r) { return report_dict(r.report()); }, "What loading found.")
      .def_property_readonly(
          "groups",
          [](const Robot& r) -> GroupRows {
            py::dict out;
            for (const GroupDescription& g : r.groups()) {
              out[g.name.c_str()] =
                  py::dict("joints"_a = g.joints, "base_link"_a = g.base_link, "tip_link"_a = g.tip_link);
            }
            return out;
          },
          "SRDF groups: name to joints, base_link, tip_link.")
      .def_property_readonly(
          "group_links",
          [](const Robot& r) {
            std::map<std::string, std::vector<std::string>> links;
            for (const GroupDescription& group : r.groups()) links[group.name] = detail::links_of(r, group);
            return links;
          },
          "SRDF group to its links: those that its joints, fixed ones too, and the joints that mimic them carry.")
      .def_property_readonly(
          "group_states", &Robot::group_states,
          "SRDF states: group, state, joint to value. Joints with several values appear as joint/x, joint/y, ...")
      .def_property_readonly(
          "end_effectors",
          [](const Robot& r) -> EndEffectorRows {
            py::list out;
            for (const EndEffectorDescription& e : r.end_effectors()) {
              out.append(py::dict("name"_a = e.name, "group"_a = e.group, "parent_link"_a = e.parent_link));
            }
            return out;
          },
          "SRDF end effectors: name, group and parent_link.")
      .def_property_readonly("passive_joints", &Robot::passive_joints,
                             "Joints that nothing drives (SRDF passive_joint): in no group.")
      .def_property_readonly("has_srdf", &Robot::has_srdf, "An SRDF was given.")
      .def_property_readonly(
          "source", [](const Robot& r) { return source_of(r); }, "The URDFs and links that it was made of.")
      .def_property_readonly("hash", &Robot::hash, "Content hash: kinematics, shapes, limits, disabled pairs.")
      .def(
          "collisions",
          [](const Robot& r, const std::string& link) { return r.links()[r.link_index(link)].collisions; },
          py::arg("link"), "Collision shapes of a link (list of LinkShape).")
      .def(
          "link_poses",
          [](const Robot& r, const std::map<std::string, double>& joints,
             const OptionalArray& T_world_root) -> NamedPoses {
            const Poses poses = r.link_poses(r.values(joints), pose_argument(T_world_root, "T_world_root"));
            py::dict out;
            for (std::size_t i = 0; i < poses.size(); ++i) out[r.links()[i].name.c_str()] = to_array(poses[i]);
            return out;
          },
          py::arg("joints") = std::map<std::string, double>{}, py::arg("T_world_root") = py::none(),
          "Pose (4, 4) of every link, other joints at their default values.")
      .def(
          "values", [](const Robot& r, const std::map<std::string, double>& joints) { return r.values(joints); },
          py::arg("joints") = std::map<std::string, double>{},
          "Full value vector (for with_reference) with the named joints set.");
  robot
      .def("group", &make_group, py::arg("name") = py::none(), py::arg("tip") = py::none(), py::kw_only(),
           py::arg("base_link") = py::none(), py::arg("with_base") = false,
           "An SRDF group by name, its tip moved to any link its last joint carries; or the chain base_link to tip.\n"
           "`with_base` puts the virtual joints x, y, theta first.")
      .def(
          "mount",
          [](const Robot& r, const Robot& other, const std::string& parent_link, const OptionalArray& T,
             const std::string& prefix) { return r.mount(other, parent_link, pose_argument(T, "T"), prefix); },
          py::arg("other"), py::arg("parent_link"), py::arg("T") = py::none(), py::arg("prefix") = "",
          "This robot with `other` put on one of its links; the names of `other` get the prefix, SRDFs are merged.")
      .def(
          "with_link",
          [](const Robot& r, const std::string& name, const std::string& parent_link, const OptionalArray& T,
             const std::vector<LinkShape>& shapes) {
            return r.with_link(name, parent_link, pose_argument(T, "T"), shapes);
          },
          py::arg("name"), py::arg("parent_link"), py::arg("T") = py::none(),
          py::arg("shapes") = std::vector<LinkShape>{}, "This robot with one more fixed link.")
      .def_property_readonly(
          "disabled_pairs",
          [](const Robot& r) -> LinkPairs {
            py::list out;
            for (const auto& [pair, reason] : r.disabled_pairs()) {
              out.append(py::make_tuple(r.links()[pair.first].name, r.links()[pair.second].name, reason_name(reason)));
            }
            return out;
          },
          "Link pairs that need no collision check: (a, b, reason).")
      .def(
          "with_disabled_pairs",
          [](const Robot& r, const std::vector<std::tuple<std::string, std::string, std::string>>& pairs) {
            std::map<std::pair<int, int>, DisabledReason> out;
            for (const auto& [a, b, reason] : pairs) {
              const int i = r.link_index(a), j = r.link_index(b);
              out[{std::min(i, j), std::max(i, j)}] = reason_from_name(reason);
            }
            return r.with_disabled_pairs(std::move(out));
          },
          py::arg("pairs"),
          "This robot with these pairs (link, link, reason) left out of collision checks instead of its own; reason is "
          "adjacent,\nnever, always, user or default. Raises InvalidInput on an unknown link or reason.")
      .def("to_urdf", &Robot::to_urdf, "The whole robot as one URDF, without visuals; mesh files by absolute path.")
      .def("to_srdf", &Robot::to_srdf,
           "Groups, states, end effectors, passive and virtual joints and the disabled pairs with their reasons as one "
           "SRDF.\n"
           "For a robot without an SRDF: with_sampled_pairs(robot).to_srdf() writes the computed pairs.")
      .def("__repr__", [](const Robot& r) {
        return "Robot('" + r.name() + "', " + std::to_string(r.links().size()) + " links, " +
               std::to_string(movable_joints(r).size()) + " movable joints, base " + to_string(r.base()) + ")";
      });
}

void bind_base_motion(py::module_& m) {
  m.def(
      "find_package",
      [](const std::string& name, const PathLike& folder, const PackageFolders& package_dirs) {
        return find_package(name, path_argument(folder, "folder"), package_argument(package_dirs));
      },
      py::arg("name"), py::arg("folder"), py::arg("package_dirs") = py::none(),
      "Folder of the ROS package that a file in `folder` means by package://NAME or $(find NAME); empty if none.");
  m.def(
      "platform_velocity",
      [](double theta, const ArrayLike& joint_velocity) {
        return platform_velocity(theta, vector3_argument(joint_velocity, "joint_velocity"));
      },
      py::arg("theta"), py::arg("joint_velocity"),
      "Velocity command (v_x, v_y, omega) in the platform's own frame for velocities of the virtual joints x, y, "
      "theta\n"
      "standing at heading theta (P3 3.12) [m/s, rad/s].");
  m.def(
      "platform_velocity",
      [](double left, double right, double wheel_separation) {
        return platform_velocity(WheelSpeeds{left, right}, wheel_separation);
      },
      py::kw_only(), py::arg("left"), py::arg("right"), py::arg("wheel_separation"),
      "The same of a diff-drive whose wheel rims move at `left` and `right` [m/s]: v = (left + right) / 2,\n"
      "omega = (right - left) / wheel_separation (P1 4.11).");
  m.def(
      "joint_velocity",
      [](double theta, const ArrayLike& platform_velocity) {
        return joint_velocity(theta, vector3_argument(platform_velocity, "platform_velocity"));
      },
      py::arg("theta"), py::arg("platform_velocity"),
      "Velocities of the virtual joints x, y, theta for a platform velocity: the inverse of platform_velocity().");
  m.def(
      "wheel_speeds",
      [](double v, double omega, double wheel_separation) {
        const WheelSpeeds wheels = wheel_speeds(v, omega, wheel_separation);
        return py::make_tuple(wheels.left, wheels.right);
      },
      py::arg("v"), py::arg("omega"), py::arg("wheel_separation"),
      "Rim speeds (left, right) of a diff-drive's wheels [m/s].");
}

}  // namespace

void bind_robot(py::module_& m) {
  bind_robot_source(m);
  bind_robot_class(m);
  bind_base_motion(m);
  bind_group(m);
}

}  // namespace mmgrasp::python
