#include <exception>
#include <system_error>

#include "bindings.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/core/pose.hpp"

namespace mmgrasp::python {
namespace {

/// The Python classes of the exceptions: kept for the life of the process, as the translator may run at any time.
struct ErrorTypes {
  PyObject* error = nullptr;
  PyObject* invalid_input = nullptr;
  PyObject* io_error = nullptr;
};
ErrorTypes error_types;

PyObject* new_error(py::module_& m, const char* name, const py::tuple& bases, const char* doc) {
  const std::string full_name = std::string("mmgrasp.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, bases.ptr(), nullptr);
  if (!type) throw py::error_already_set();
  m.attr(name) = py::reinterpret_borrow<py::object>(type);
  return type;
}

/// The message may hold bytes of a path that are no UTF-8: these are written as escapes.
void raise(PyObject* type, const std::exception& error) {
  const std::string text = error.what();
  const auto size = static_cast<Py_ssize_t>(text.size());
  const auto message = py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(text.data(), size, "backslashreplace"));
  if (message) PyErr_SetObject(type, message.ptr());
}

/// A value whose kind fits but that the conversion itself refused: a whole number beyond 64 bits, an array of one where
/// a number is asked for. pybind11 tells the type in Python and nothing of the argument.
InvalidInput unfit_value(const std::string& told) {
  const std::string begin = "type ", end = " to C++";
  const std::size_t from = told.find(begin), to = told.find(end);
  const bool named = from != std::string::npos && to != std::string::npos && from + begin.size() < to;
  const std::string type = named ? told.substr(from + begin.size(), to - from - begin.size()) : "another type";
  return InvalidInput("an argument of " + type +
                      ": its value cannot be taken: a number that is too large, or an object that is no single number");
}

void bind_errors(py::module_& m) {
  error_types.error =
      new_error(m, "Error", py::make_tuple(py::handle(PyExc_Exception)), "Base of all errors of mmgrasp.");
  const py::handle error(error_types.error);
  error_types.invalid_input =
      new_error(m, "InvalidInput", py::make_tuple(error, py::handle(PyExc_ValueError)),
                "An argument or a file breaks a rule. The message names the field, the value and the rule.");
  error_types.io_error = new_error(m, "IoError", py::make_tuple(error, py::handle(PyExc_OSError)),
                                   "A file cannot be read or written. The message names it.");
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InvalidInput& e) {
      raise(error_types.invalid_input, e);
    } catch (const IoError& e) {
      raise(error_types.io_error, e);
    } catch (const Error& e) {
      raise(error_types.error, e);
    } catch (const py::cast_error& e) {
      raise(error_types.invalid_input, unfit_value(e.what()));
    } catch (const std::system_error& e) {
      if (e.code() != std::errc::resource_unavailable_try_again) throw;  // of a thread that could not be started
      PyErr_SetString(PyExc_MemoryError, "the system gives no more threads, or no memory for their stacks");
    }
  });
}

void bind_outcomes(py::module_& m) {
  py::native_enum<Outcome>(m, "Outcome", "enum.Enum",
                           "How a query ended. \"No solution\" is a value, not an exception.")
      .value("solved", Outcome::solved, "The answer is there and passed its check.")
      .value("approximate", Outcome::approximate,
             "The best that was found; misses its tolerance or bound. Never a path in collision.")
      .value("infeasible", Outcome::infeasible, "Proven: there is no answer.")
      .value("not_found", Outcome::not_found,
             "The method came to its end without an answer (samples, a roadmap, a local optimum): no proof.")
      .value("timeout", Outcome::timeout, "The budget (samples, iterations or clock) ended first: no proof either.")
      .value("stopped", Outcome::stopped, "The caller ended it.")
      .value("invalid_start", Outcome::invalid_start,
             "The start violates limits or is in collision, or no such start was found.")
      .value("invalid_goal", Outcome::invalid_goal, "No goal given or found is inside limits and collision-free.")
      .finalize();
  py::native_enum<Rejection>(m, "Rejection", "enum.Enum", "Why one candidate was rejected.")
      .value("none", Rejection::none, "It was not rejected.")
      .value("unreachable", Rejection::unreachable, "No arm configuration reaches the pose.")
      .value("limits", Rejection::limits, "Reached only outside joint limits.")
      .value("self_collision", Rejection::self_collision, "Robot hits robot or what it holds.")
      .value("scene", Rejection::scene, "Robot (or what it holds) hits the scene.")
      .value("grasp_filter", Rejection::grasp_filter, "Rejected before inverse kinematics.")
      .finalize();
  py::class_<Rejections>(m, "Rejections", "How many candidates fell at which filter.")
      .def_readonly("unreachable", &Rejections::unreachable, "No arm configuration reaches the pose.")
      .def_readonly("limits", &Rejections::limits, "Reached only outside joint limits.")
      .def_readonly("self_collision", &Rejections::self_collision, "Reached, but robot hits robot or what it holds.")
      .def_readonly("scene", &Rejections::scene, "Reached, but the robot, or what is attached to it, hits the scene.")
      .def_readonly("grasp_filter", &Rejections::grasp_filter, "Rejected before inverse kinematics.")
      .def_property_readonly("total", &Rejections::total, "Over all filters.")
      .def(
          "to_dict", [](const Rejections& r) { return to_dict(r); },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const Rejections& r) { return "Rejections(" + r.summary() + ")"; });
}

void bind_poses(py::module_& m) {
  m.def(
      "pose",
      [](const ArrayLike& xyz, const OptionalArray& rpy, const OptionalArray& quat_xyzw) {
        if (!rpy.is_none() && !quat_xyzw.is_none()) {
          throw InvalidInput("pose(rpy=..., quat_xyzw=...): give one of the two");
        }
        const Eigen::Vector3d position = vector3_argument(xyz, "xyz");
        if (!quat_xyzw.is_none()) {
          return to_array(pose_from_xyz_quat(position, vector_argument(quat_xyzw, "quat_xyzw", 4)));
        }
        const Eigen::Vector3d angles = rpy.is_none() ? Eigen::Vector3d::Zero() : vector3_argument(rpy, "rpy");
        return to_array(pose_from_xyz_rpy(position, angles));
      },
      py::arg("xyz"), py::arg("rpy") = py::none(), py::arg("quat_xyzw") = py::none(),
      "A (4, 4) pose from a position [m] and roll-pitch-yaw (URDF's convention) [rad] or a quaternion (x, y, z, w).");
  m.def(
      "quat_xyzw_from_rotation",
      [](const ArrayLike& R) {
        const Eigen::MatrixXd rotation = matrix_argument(R, "R", 3);
        if (rotation.rows() != 3) throw InvalidInput("R: must be (3, 3)");
        Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
        T.topLeftCorner<3, 3>() = rotation;
        return quat_xyzw_from_rotation(checked_pose(T, "R").linear());
      },
      py::arg("R"), "Quaternion (x, y, z, w) of a (3, 3) rotation.");
  m.def(
      "pose_to_xyz_quat",
      [](const ArrayLike& T) {
        const Pose pose = pose_argument(T, "T");
        return py::make_tuple(Eigen::Vector3d(pose.translation()), quat_xyzw_from_rotation(pose.linear()));
      },
      py::arg("T"), "Position (3,) and quaternion (x, y, z, w) of a (4, 4) pose.");
  m.def(
      "pose_to_xyz_rpy",
      [](const ArrayLike& T) {
        const Pose pose = pose_argument(T, "T");
        return py::make_tuple(Eigen::Vector3d(pose.translation()), rpy_from_rotation(pose.linear()));
      },
      py::arg("T"), "Position (3,) and roll-pitch-yaw (3,) of a (4, 4) pose.");
}

}  // namespace

py::dict to_dict(const Rejections& r) {
  using namespace py::literals;
  return py::dict("unreachable"_a = r.unreachable, "limits"_a = r.limits, "self_collision"_a = r.self_collision,
                  "scene"_a = r.scene, "grasp_filter"_a = r.grasp_filter);
}

std::string path_argument(const py::handle& value, const std::string& name) {
  PyObject* bytes = nullptr;
  if (!PyUnicode_FSConverter(value.ptr(), &bytes)) {
    PyErr_Clear();
    refuse_value(name, value, "a path (str or os.PathLike)");
  }
  return py::reinterpret_steal<py::bytes>(bytes);
}

void bind_core(py::module_& m) {
  bind_errors(m);
  bind_outcomes(m);
  bind_poses(m);
}

}  // namespace mmgrasp::python
