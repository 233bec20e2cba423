#include <unordered_map>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/reach/capability_map.hpp"
#include "mmgrasp/robot/detail/group_record.hpp"
#include "mmgrasp/robot/detail/robot_record.hpp"
#include "mmgrasp/task/object_regions.hpp"
#include "pickles.hpp"
#include "plain_structs.hpp"
#include "shown.hpp"

// Objects that are data alone pickle, to the last bit; of others `mmgrasp._pickling` says what to do instead.

namespace mmgrasp::python {
namespace {

std::unordered_map<PyObject*, PickleFunctions>& pickles_by_class() {
  static auto* known = new std::unordered_map<PyObject*, PickleFunctions>();  // classes outlive static objects
  return *known;
}

const PickleFunctions* pickle_of(const py::handle& kind) {
  const auto found = pickles_by_class().find(kind.ptr());
  return found == pickles_by_class().end() ? nullptr : &found->second;
}

/// Of all classes that pybind11 makes: those of other modules go on as they did.
py::object reduced(const py::object& self, int protocol) {
  const py::type kind = py::type::of(self);
  const py::module_ helpers = py::module_::import("mmgrasp._pickling");
  if (const PickleFunctions* functions = pickle_of(kind))
    return py::make_tuple(helpers.attr("restored"), py::make_tuple(kind, functions->pack(self)));
  helpers.attr("refuse")(self);
  return py::module_::import("builtins").attr("object").attr("__reduce_ex__")(self, protocol);
}

py::object packed_robot(const py::handle& self) {
  return packed(detail::record_of(py::cast<const Robot&>(self)));
}

py::object made_robot(const py::handle& state) {
  return py::cast(detail::robot_of(Packed<detail::RobotRecord>::to(state)));
}

/// The robot goes as an object of its own: groups of one robot have one afterwards, too.
py::object packed_group(const py::handle& self) {
  return py::make_tuple(self.attr("robot"), packed(detail::record_of(py::cast<const JointGroup&>(self))));
}

py::object made_group(const py::handle& state) {
  const auto values = py::cast<py::tuple>(state);
  return py::cast(detail::group_of(py::cast<const Robot&>(values[0]), Packed<detail::GroupRecord>::to(values[1])));
}

constexpr char kNotOurs[] = "a pickle of another version of mmgrasp, or a damaged one";

constexpr char kMemo[] = "dict[int, object]";
constexpr char kObject[] = "object";
using Memo = Shown<kMemo>;
using AnyObject = Shown<kObject>;

/// Nothing changes such objects: each is its own copy.
template <typename T>
void copies_as_itself(py::module_& m, const char* name) {
  auto kind = declared<T>(m, name);
  kind.def("__copy__", [](const Given<T>& self) { return self; });
  kind.def(
      "__deepcopy__", [](const Given<T>& self, const Memo&) { return self; }, py::arg("memo"));
}

}  // namespace

void set_pickle(const py::module_& m, const char* name, PickleFunctions functions) {
  pickles_by_class()[m.attr(name).ptr()] = functions;
}

void bind_pickle(py::module_& m) {
  bind_plain_pickles(m);
  bind_task_pickles(m);
  plain<WholeBodyTrajectory>(m, "WholeBodyTrajectory");
  set_pickle(m, "Robot", {&packed_robot, &made_robot});
  set_pickle(m, "JointGroup", {&packed_group, &made_group});
  copies_as_itself<Robot>(m, "Robot");
  copies_as_itself<JointGroup>(m, "JointGroup");
  copies_as_itself<MeshShape>(m, "Mesh");
  copies_as_itself<ReachDatabase>(m, "ReachDatabase");
  copies_as_itself<CapabilityMap>(m, "CapabilityMap");
  copies_as_itself<Roadmap>(m, "Roadmap");
  copies_as_itself<ObjectRegions>(m, "ObjectRegions");
  auto world = declared<World>(m, "World");
  world.def("__copy__", [](const World& w) { return World(w); });
  world.def(
      "__deepcopy__", [](const World& w, const Memo&) { return World(w); }, py::arg("memo"));
  m.def(
      "_from_pickle",
      [](const py::type& kind, const AnyObject& state) -> AnyObject {
        const PickleFunctions* functions = pickle_of(kind);
        if (functions == nullptr) throw py::type_error(kNotOurs);
        try {
          return functions->make(state);
        } catch (const py::builtin_exception&) {  // a number or a length of another kind than expected
          throw py::type_error(kNotOurs);
        } catch (const py::error_already_set& error) {
          if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_LookupError) && !error.matches(PyExc_ValueError))
            throw;
          throw py::type_error(kNotOurs);
        } catch (const InvalidInput&) {
          throw py::type_error(kNotOurs);
        }
      },
      py::arg("kind"), py::arg("state"));
  py::object base = py::type::of<Robot>().attr("__mro__").attr("__getitem__")(-2);
  base.attr("__reduce_ex__") =
      py::cpp_function(&reduced, py::name("__reduce_ex__"), py::is_method(base), py::arg("protocol"));
  declared<BaseRegion>(m, "BaseRegion")
      .def(py::init([](std::string tray, const ArrayLike& cells, const BaseGrid& g) {
             BaseRegion known;
             known.tray = std::move(tray);
             known.cells = flags_argument(
                 cells, "cells", {static_cast<py::ssize_t>(g.headings.size()), py::ssize_t{g.ny}, py::ssize_t{g.nx}});
             return known;
           }),
           py::arg("tray"), py::arg("cells"), py::arg("grid"),
           "A region known from elsewhere: (headings, ny, nx) zeros and ones, to be intersected with others.");
}

}  // namespace mmgrasp::python
