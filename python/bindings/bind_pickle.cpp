#include "bindings.hpp"
#include "mmgrasp/task/base_region.hpp"

// Grids and regions travel between processes (mmgrasp.cluster): they pickle, to the last bit.

namespace mmgrasp::python {
namespace {

py::bytes packed(const CellMask& cells) {
  return py::bytes(reinterpret_cast<const char*>(cells.data()), cells.size());
}

CellMask unpacked(const py::handle& state) {
  const auto text = py::cast<std::string>(state);
  return CellMask(text.begin(), text.end());
}

py::tuple grid_state(const BaseGrid& g) {
  return py::make_tuple(Eigen::Vector2d(g.origin), g.resolution, g.nx, g.ny, g.headings);
}

BaseGrid grid_of(const py::tuple& s) {
  return BaseGrid{py::cast<Eigen::Vector2d>(s[0]), py::cast<double>(s[1]), py::cast<int>(s[2]), py::cast<int>(s[3]),
                  py::cast<std::vector<double>>(s[4])};
}

py::tuple explanation_state(const PartExplanation& e) {
  const Rejections& r = e.rejections;
  return py::make_tuple(e.part, e.grasps, e.base_poses_tried, e.base_poses_feasible, r.unreachable, r.limits,
                        r.self_collision, r.scene, r.grasp_filter);
}

PartExplanation explanation_of(const py::tuple& s) {
  const auto count = [&](std::size_t i) { return py::cast<std::size_t>(s[i]); };
  PartExplanation e;
  e.part = py::cast<std::string>(s[0]);
  e.grasps = py::cast<int>(s[1]);
  e.base_poses_tried = count(2);
  e.base_poses_feasible = count(3);
  e.rejections = {count(4), count(5), count(6), count(7), count(8)};
  return e;
}

py::tuple region_state(const BaseRegion& r) {
  py::list parts, explanations;
  for (const PartCells& cells : r.part_cells) {
    py::list windows;
    for (const PartCells::Window& w : cells.windows())
      windows.append(py::make_tuple(w.heading, w.x0, w.y0, w.nx, w.ny, packed(w.flags)));
    parts.append(py::make_tuple(cells.nx(), cells.ny(), cells.size(), windows));
  }
  for (const PartExplanation& e : r.explanations) explanations.append(explanation_state(e));
  return py::make_tuple(r.tray, packed(r.cells), parts, explanations, r.base_poses_in_collision);
}

BaseRegion region_of(const py::tuple& s) {
  BaseRegion r;
  r.tray = py::cast<std::string>(s[0]);
  r.cells = unpacked(s[1]);
  for (const py::handle& cells : s[2]) {
    const auto state = py::cast<py::tuple>(cells);
    std::vector<PartCells::Window> windows;
    for (const py::handle& window : state[3]) {
      const auto w = py::cast<py::tuple>(window);
      const auto number = [&w](std::size_t i) { return py::cast<int>(w[i]); };
      windows.push_back({number(0), number(1), number(2), number(3), number(4), unpacked(w[5])});
    }
    r.part_cells.emplace_back(py::cast<int>(state[0]), py::cast<int>(state[1]), py::cast<std::size_t>(state[2]),
                              std::move(windows));
  }
  for (const py::handle& e : s[3]) r.explanations.push_back(explanation_of(py::cast<py::tuple>(e)));
  r.base_poses_in_collision = py::cast<std::size_t>(s[4]);
  return r;
}

/// No __setstate__: it would need an object that nothing has made yet.
template <class Class, class State, class Made>
void pickles(py::class_<Class>& declared_class, State state, Made made) {
  using Tuple = py::typing::Tuple<py::object, py::ellipsis>;
  declared_class.def_static(
      "_from_state", [made](const Tuple& values) { return made(values); }, py::arg("state"));
  declared_class.def("__reduce__", [state](const py::object& self) {
    const py::object restored = py::module_::import("mmgrasp._pickling").attr("restored");
    const py::object content = state(py::cast<const Class&>(self));
    return Tuple(py::make_tuple(restored, py::make_tuple(py::type::of(self), content)));
  });
}

}  // namespace

void bind_pickle(py::module_& m) {
  auto grid = declared<BaseGrid>(m, "BaseGrid");
  pickles(grid, &grid_state, &grid_of);
  auto explanation = declared<PartExplanation>(m, "PartExplanation");
  pickles(explanation, &explanation_state, &explanation_of);
  auto region = declared<BaseRegion>(m, "BaseRegion");
  pickles(region, &region_state, &region_of);
  region.def(py::init([](std::string tray, const ArrayLike& cells, const BaseGrid& g) {
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
