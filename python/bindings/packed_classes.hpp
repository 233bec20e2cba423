#pragma once

#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/part_cells.hpp"
#include "mmgrasp/trajopt/whole_body_trajectory.hpp"
#include "packed.hpp"

namespace mmgrasp::python {

// Classes with members of their own that lie inside plain structs.

template <>
struct Packed<TrayId> {
  static pybind11::object from(TrayId id) { return pybind11::int_(static_cast<int>(id)); }
  static TrayId to(const pybind11::handle& state) { return TrayId(pybind11::cast<int>(state)); }
};

template <>
struct Packed<PartCells::Window> {
  static pybind11::object from(const PartCells::Window& w) {
    return pybind11::make_tuple(w.heading, w.x0, w.y0, w.nx, w.ny, packed(w.flags));
  }
  static PartCells::Window to(const pybind11::handle& state) {
    const auto w = pybind11::cast<pybind11::tuple>(state);
    const auto number = [&w](std::size_t i) { return pybind11::cast<int>(w[i]); };
    return {number(0), number(1), number(2), number(3), number(4), Packed<CellMask>::to(w[5])};
  }
};

template <>
struct Packed<PartCells> {
  static pybind11::object from(const PartCells& cells) {
    return pybind11::make_tuple(cells.nx(), cells.ny(), cells.size(), packed(cells.windows()));
  }
  static PartCells to(const pybind11::handle& state) {
    const auto values = pybind11::cast<pybind11::tuple>(state);
    return PartCells(pybind11::cast<int>(values[0]), pybind11::cast<int>(values[1]),
                     pybind11::cast<std::size_t>(values[2]), Packed<std::vector<PartCells::Window>>::to(values[3]));
  }
};

template <>
struct Packed<WholeBodyTrajectory> {
  static pybind11::object from(const WholeBodyTrajectory& t) {
    return pybind11::make_tuple(pybind11::cast(t.group()), packed(t.times()), packed(t.positions()), packed(t.drive()));
  }
  static WholeBodyTrajectory to(const pybind11::handle& state) {
    const auto values = pybind11::cast<pybind11::tuple>(state);
    using Rows = std::vector<Eigen::VectorXd>;
    return {pybind11::cast<JointGroup>(values[0]), Packed<std::vector<double>>::to(values[1]),
            Packed<Rows>::to(values[2]), Packed<Rows>::to(values[3])};
  }
};

}  // namespace mmgrasp::python
