#include <cmath>

#include "batch.hpp"
#include "bindings.hpp"
#include "mmgrasp/geometry/grid_distance_field.hpp"

namespace mmgrasp::python {
namespace {

GridDistanceField grid_of(const ArrayLike& values, const ArrayLike& origin, double spacing, double error,
                          double truncation) {
  using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const py::array given = plain_array(values, "values");
  const bool numbers = given && std::string("fiu").find(given.dtype().kind()) != std::string::npos;
  const auto array = numbers ? Values::ensure(given) : Values();
  if (!numbers || array.ndim() != 3) {
    throw InvalidInput("values: must be an array of numbers (nx, ny, nz)");
  }
  GridDistanceField::Grid grid;
  for (int k = 0; k < 3; ++k) {
    if (array.shape(k) > 1'000'000) throw InvalidInput("values: at most a million along an axis");
    grid.size[k] = static_cast<int>(array.shape(k));
  }
  grid.values.assign(array.data(), array.data() + array.size());
  grid.origin = vector3_argument(origin, "origin");
  grid.spacing = spacing;
  grid.error = error;
  grid.truncation = truncation;
  return GridDistanceField(std::move(grid));
}

std::pair<Eigen::VectorXd, Eigen::MatrixXd> distances_and_gradients(const DistanceField& field,
                                                                    const ArrayLike& points) {
  const Eigen::Matrix3Xd columns = matrix_argument(points, "points", 3).transpose();
  Eigen::VectorXd distances(columns.cols());
  Eigen::MatrixXd gradients(columns.cols(), 3);
  in_pieces(columns.cols(), [&](Eigen::Index first, Eigen::Index count) {
    Eigen::Matrix3Xd piece;
    distances.segment(first, count) = field.distances(columns.middleCols(first, count), piece);
    gradients.middleRows(first, count) = piece.transpose();
  });
  return {std::move(distances), std::move(gradients)};
}

}  // namespace

void bind_distance_fields(py::module_& m) {
  using Field = std::shared_ptr<DistanceField>;
  py::class_<DistanceField, Field>(
      m, "DistanceField",
      "Signed distance from the surface of a body, in the field's own frame: negative inside, NaN where unknown [m].")
      .def(
          "distances",
          [](const DistanceField& f, const ArrayLike& points) {
            const Eigen::Matrix3Xd columns = matrix_argument(points, "points", 3).transpose();
            Eigen::VectorXd distances(columns.cols());
            in_pieces(columns.cols(), [&](Eigen::Index first, Eigen::Index count) {
              distances.segment(first, count) = f.distances(columns.middleCols(first, count));
            });
            return distances;
          },
          py::arg("points"), "Signed distances (m,) of `points` (m, 3) [m].")
      .def("distances_and_gradients", &distances_and_gradients, py::arg("points"),
           "The same with the unit directions (m, 3) along which they grow fastest; zero where unknown.")
      .def_property_readonly(
          "domain",
          [](const DistanceField& f) {
            const Eigen::AlignedBox3d domain = f.properties().domain;
            return rows_to_array(std::vector<Eigen::Vector3d>{domain.min(), domain.max()});
          },
          "Least and largest corner (2, 3) of the box in which it knows anything [m]; infinite: everywhere.")
      .def_property_readonly(
          "error", [](const DistanceField& f) { return f.properties().error; }, "How far a distance may be off [m].")
      .def_property_readonly(
          "truncation", [](const DistanceField& f) { return f.properties().truncation; },
          "Distances are clipped to this [m].");
  py::class_<MeshDistanceField, DistanceField, std::shared_ptr<MeshDistanceField>>(
      m, "MeshDistanceField",
      "The exact distance from a closed mesh, negative inside.\n"
      "\n"
      "    field = mg.collision.MeshDistanceField(mesh)\n"
      "    world.add_field(\"statue\", field, mg.pose([2.0, 1.0, 0.0]))")
      .def(py::init([](const MeshShape& mesh) {
             return interruptible([&] { return std::make_shared<MeshDistanceField>(*mesh.mesh); });
           }),
           py::arg("mesh"), "Raises InvalidInput for a mesh that is not closed.");
  const GridDistanceField::Grid own;
  py::class_<GridDistanceField, DistanceField, std::shared_ptr<GridDistanceField>>(
      m, "GridDistanceField",
      "Signed distances at the points of a regular grid, interpolated linearly along each axis between them.\n"
      "\n"
      "    x = np.linspace(-0.5, 0.5, 21)\n"
      "    values = np.linalg.norm(np.stack(np.meshgrid(x, x, x, indexing=\"ij\")), axis=0) - 0.3  # a sphere\n"
      "    field = mg.collision.GridDistanceField(values, [-0.5, -0.5, -0.5], 0.05)\n"
      "    field.distances([[0.0, 0.0, 0.4]])")
      .def(py::init(
               [](const ArrayLike& values, const ArrayLike& origin, double spacing, double error, double truncation) {
                 return std::make_shared<GridDistanceField>(grid_of(values, origin, spacing, error, truncation));
               }),
           py::arg("values"), py::arg("origin"), py::arg("spacing"), py::kw_only(), py::arg("error") = own.error,
           py::arg("truncation") = own.truncation,
           "`values` (nx, ny, nz) [m], NaN where unknown: [i, j, k] is the distance at origin + spacing (i, j, k). "
           "`error`\nof the values [m]; the field's own error adds sqrt(3) / 2 of the spacing, the most by which what "
           "lies between can\nbe off.");
}

}  // namespace mmgrasp::python
