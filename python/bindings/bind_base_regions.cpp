#include "bindings.hpp"
#include "ids.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/object_regions.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kMaskList[] = "list[numpy.typing.NDArray[numpy.uint8]]";
using MaskList = Shown<kMaskList>;

using namespace py::literals;

py::array_t<std::uint8_t> mask_array(const BaseGrid& grid, const CellMask& cells) {
  py::array_t<std::uint8_t> out({static_cast<py::ssize_t>(grid.headings.size()), static_cast<py::ssize_t>(grid.ny),
                                 static_cast<py::ssize_t>(grid.nx)});
  if (static_cast<std::size_t>(out.size()) != cells.size()) throw InvalidInput("cells: belong to another grid");
  std::copy(cells.begin(), cells.end(), out.mutable_data());
  return out;
}

CellMask mask_argument(const BaseGrid& grid, const ArrayLike& cells) {
  const auto flags = flags_argument(
      cells, "cells", {static_cast<py::ssize_t>(grid.headings.size()), py::ssize_t{grid.ny}, py::ssize_t{grid.nx}});
  return CellMask(flags.begin(), flags.end());
}

void bind_region_classes(py::module_& m) {
  py::class_<BaseGrid>(m, "BaseGrid", "Square cells over the floor, one layer for each heading.")
      .def(py::init([](const ArrayLike& origin, double resolution, int nx, int ny, const ArrayLike& headings) {
             const BaseGrid grid{vector2_argument(origin, "origin"), resolution, nx, ny,
                                 list_argument(headings, "headings")};
             require_length(resolution, "resolution");
             if (nx <= 0 || ny <= 0) throw InvalidInput("BaseGrid: nx and ny must be > 0");
             if (grid.headings.empty()) throw InvalidInput("headings has shape (0,): must hold at least one [rad]");
             return grid;
           }),
           py::arg("origin"), py::arg("resolution"), py::arg("nx"), py::arg("ny"),
           py::arg("headings") = py::make_tuple(0.0),
           "`origin` (2,) is the lower corner of cell (0, 0) [m], `resolution` the edge of a cell [m], nx and ny "
           "the\ncells along x and y, `headings` one layer each [rad], distinct.")
      .def_readonly("origin", &BaseGrid::origin, "Lower corner of cell (0, 0) [m].")
      .def_readonly("resolution", &BaseGrid::resolution, "Edge of a cell [m].")
      .def_readonly("nx", &BaseGrid::nx, "Cells along x.")
      .def_readonly("ny", &BaseGrid::ny, "Cells along y.")
      .def_readonly("headings", &BaseGrid::headings, "Heading of each layer [rad].")
      .def(
          "centre",
          [](const BaseGrid& g, int heading, int ix, int iy) {
            const auto check = [](const char* name, int value, int count) {
              require(value >= 0 && value < count, name, std::to_string(value),
                      "must be in [0, " + std::to_string(count) + ")");
            };
            check("heading", heading, static_cast<int>(g.headings.size()));
            check("ix", ix, g.nx);
            check("iy", iy, g.ny);
            return g.centre(heading, ix, iy);
          },
          py::arg("heading"), py::arg("ix"), py::arg("iy"), "x, y, theta of a cell's middle.")
      .def("__repr__", [](const BaseGrid& g) {
        return "BaseGrid(" + std::to_string(g.nx) + " x " + std::to_string(g.ny) + " cells, " +
               std::to_string(g.headings.size()) + " headings)";
      });
  py::class_<PartExplanation>(m, "PartExplanation",
                              "What became of the candidates for one part over all base poses tried.")
      .def_readonly("part", &PartExplanation::part, "Name of the part.")
      .def_readonly("grasps", &PartExplanation::grasps, "Candidates.")
      .def_readonly("base_poses_tried", &PartExplanation::base_poses_tried,
                    "Base poses tried, without those where the robot at home touches the scene.")
      .def_readonly("base_poses_feasible", &PartExplanation::base_poses_feasible,
                    "Base poses from which the part has a collision-free grasp.")
      .def_readonly("rejections", &PartExplanation::rejections,
                    "Pairs of grasp and base pose by the cause that turned them down.")
      .def(
          "to_dict",
          [](const PartExplanation& e) {
            return py::dict("part"_a = e.part, "grasps"_a = e.grasps, "base_poses_tried"_a = e.base_poses_tried,
                            "base_poses_feasible"_a = e.base_poses_feasible, "rejections"_a = to_dict(e.rejections));
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const PartExplanation& e) {
        return "PartExplanation('" + e.part + "', feasible at " + std::to_string(e.base_poses_feasible) + " of " +
               std::to_string(e.base_poses_tried) + " base poses, rejected: " + e.rejections.summary() + ")";
      });
  py::class_<BaseRegion>(m, "BaseRegion", "Base poses from which every target part of a tray can be grasped.")
      .def_readonly("tray", &BaseRegion::tray, "Name of the tray.")
      .def(
          "cells", [](const BaseRegion& r, const BaseGrid& grid) { return mask_array(grid, r.cells); }, py::arg("grid"),
          "(headings, ny, nx) array of 0 and 1.")
      .def(
          "part_cells",
          [](const BaseRegion& r, const BaseGrid& grid) -> MaskList {
            py::list out;
            for (const PartCells& cells : r.part_cells) out.append(mask_array(grid, cells.mask()));
            return out;
          },
          py::arg("grid"), "The same for each target part alone.")
      .def_readonly("explanations", &BaseRegion::explanations, "One PartExplanation for each target part.")
      .def_readonly("base_poses_in_collision", &BaseRegion::base_poses_in_collision,
                    "Base poses left out because the robot at home touches the scene there.")
      .def_property_readonly("count", &BaseRegion::count, "Number of cells.")
      .def("__repr__",
           [](const BaseRegion& r) { return "BaseRegion('" + r.tray + "', " + std::to_string(r.count()) + " cells)"; });
  m.def("make_base_grid", &make_base_grid, py::arg("problem"), py::arg("database"),
        "The grid that covers all base poses from which any tray could be reached.");
  m.def(
      "compute_base_regions",
      [](const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
         const Progress& progress) {
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return compute_base_regions(problem, database, grid, monitor); });
      },
      py::arg("problem"), py::arg("database"), py::arg("grid"), py::kw_only(), py::arg("progress") = py::none(),
      "P1 Algorithm 2 with exact inverse kinematics: one region for each tray with target parts.");
  m.def(
      "share_headings",
      [](const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
         const std::vector<BaseRegion>& regions, const Progress& progress) {
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return share_headings(problem, database, grid, regions, monitor); });
      },
      py::arg("problem"), py::arg("database"), py::arg("grid"), py::arg("regions"), py::kw_only(),
      py::arg("progress") = py::none(),
      "The regions of compute_base_regions, and besides where trays that list no headings can be served at another "
      "tray's\n"
      "heading, in the cells where that one is served: trays that face each other get stops in common.");
  m.def(
      "inscribed_circle",
      [](const BaseGrid& grid, const ArrayLike& cells, int heading) {
        if (heading < 0 || heading >= static_cast<int>(grid.headings.size())) {
          throw InvalidInput("heading = " + std::to_string(heading) + ": must be a layer of the grid");
        }
        const CellMask mask = mask_argument(grid, cells);
        const InscribedCircle circle = interruptible([&] { return inscribed_circle(grid, mask, heading); });
        return py::make_tuple(Eigen::Vector2d(circle.centre), circle.radius);
      },
      py::arg("grid"), py::arg("cells"), py::arg("heading") = 0,
      "Centre (2,) and radius [m] of the largest disc inside the union of cells of one layer.");
}

void bind_object_regions(py::module_& m) {
  py::class_<ObjectRegions>(
      m, "ObjectRegions",
      "The region of every target part alone, kept and updated when parts leave: the region of any selection of a "
      "tray's\n"
      "parts is an intersection of ready bitmaps (P1 3.4.1, 3.5.1).\n"
      "\n"
      "    grid = mg.base.make_base_grid(problem, database)\n"
      "    regions = mg.base.ObjectRegions.compute(problem, database, grid)\n"
      "    cells = regions.region(0, regions.parts(0))  # from where all target parts of the first tray can be grasped")
      .def_static(
          "compute",
          [](const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
             const Progress& progress) {
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return ObjectRegions::compute(problem, database, grid, monitor); });
          },
          py::arg("problem"), py::arg("database"), py::arg("grid"), py::kw_only(), py::arg("progress") = py::none(),
          "The same as compute_base_regions, kept part by part.")
      .def_property_readonly("grid", &ObjectRegions::grid, "The grid that all regions share.")
      .def_property_readonly("trays", &ObjectRegions::trays, "How many.")
      .def(
          "parts", [](const ObjectRegions& r, int tray) { return r.parts(TrayId(tray)); }, py::arg("tray"),
          "Indices of a tray's target parts that are in place, ascending.")
      .def(
          "region",
          [](const ObjectRegions& r, int tray, const std::vector<int>& parts) {
            return mask_array(r.grid(), r.region(TrayId(tray), parts));
          },
          py::arg("tray"), py::arg("parts"),
          "(headings, ny, nx) array of 0 and 1: cells from which every one of these parts can be grasped.")
      .def(
          "base_region", [](const ObjectRegions& r, int tray) { return r.base_region(TrayId(tray)); }, py::arg("tray"),
          "The region of all target parts in place, with what became of the candidates.")
      .def(
          "remove",
          [](ObjectRegions& r, const std::vector<std::pair<int, int>>& tray_and_part, const Progress& progress) {
            const std::vector<PartRef> removed = parts_argument(tray_and_part);
            return LongCall(progress).run([&](const Monitor& monitor) { return r.remove(removed, monitor); });
          },
          py::arg("tray_and_part"), py::kw_only(), py::arg("progress") = py::none(),
          "Parts (tray, part) leave: they stand in nobody's way any more. False when stopped: nothing has changed.")
      .def("__repr__", [](const ObjectRegions& r) { return "ObjectRegions(" + std::to_string(r.trays()) + " trays)"; });
}

}  // namespace

void bind_base_regions(py::module_& m) {
  bind_region_classes(m);
  bind_object_regions(m);
}

}  // namespace mmgrasp::python
