#include "mmgrasp/task/problem.hpp"
#include "place_regions.hpp"

namespace mmgrasp::python {

void bind_place_regions(py::module_& m) {
  py::class_<PlaceRegion>(m, "PlaceRegion", "Where picked parts go: a bin fixed to the robot.")
      .def(py::init([](const ArrayLike& T_base_bin, const ArrayLike& size, double drop_height, int capacity) {
             return PlaceRegion{pose_argument(T_base_bin, "T_base_bin"), vector2_argument(size, "size"),
                                finite_argument(drop_height, "drop_height"), capacity};
           }),
           py::arg("T_base_bin"), py::arg("size"), py::arg("drop_height") = PlaceRegion{}.drop_height,
           py::arg("capacity") = PlaceRegion{}.capacity,
           "`T_base_bin` (4, 4): middle of the bin's top plane in the robot's root frame, z up; `size` (2,): inner x "
           "and y\n[m], > 0; `drop_height`: how far above the top plane a part is released [m], >= 0; "
           "`capacity`: so many parts fill the bin, 0: it takes all.")
      .def_property_readonly(
          "T_base_bin", [](const PlaceRegion& c) { return to_array(c.T_base_bin); },
          "Middle of the bin's top plane in the robot's root frame (4, 4), z up.")
      .def_readonly("size", &PlaceRegion::size, "Inner x and y (2,) [m].")
      .def_readonly("drop_height", &PlaceRegion::drop_height,
                    "A part is released with its lowest point so far above the bin's top plane [m].")
      .def_readonly(
          "capacity", &PlaceRegion::capacity,
          "So many parts fill the bin; then the robot drives to the goal, where it is emptied. 0: it takes all.");
  py::class_<UnloadRegion>(
      m, "UnloadRegion",
      "Where a robot without a bin lets go what it brought to the goal in its hand: a rectangle in "
      "the world.")
      .def(py::init([](const ArrayLike& T_world_region, const ArrayLike& size, double drop_height) {
             return UnloadRegion{pose_argument(T_world_region, "T_world_region"), vector2_argument(size, "size"),
                                 finite_argument(drop_height, "drop_height")};
           }),
           py::arg("T_world_region"), py::arg("size"), py::arg("drop_height") = UnloadRegion{}.drop_height,
           "`T_world_region` (4, 4): middle of the rectangle, z up; `size` (2,): x and y [m], > 0; `drop_height`: how "
           "far "
           "above it a\npart is released [m], >= 0. What stands there, a bin or a chute, is an object of the world.")
      .def_property_readonly(
          "T_world_region", [](const UnloadRegion& r) { return to_array(r.T_world_region); },
          "Middle of the rectangle (4, 4), z up.")
      .def_readonly("size", &UnloadRegion::size, "x and y (2,) [m].")
      .def_readonly("drop_height", &UnloadRegion::drop_height,
                    "A part is released with its lowest point so far above the rectangle [m].");
}

}  // namespace mmgrasp::python
