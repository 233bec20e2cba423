#pragma once

#include <pybind11/eigen.h>
#include <pybind11/native_enum.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::python {

namespace py = pybind11;

/// Anything numpy can turn into an array of float64. The functions below check length and values, with the argument's
/// name in the message, where pybind11's own conversion would only say "incompatible arguments".
class ArrayLike : public py::object {
  PYBIND11_OBJECT_DEFAULT(ArrayLike, py::object, [](PyObject* o) { return static_cast<int>(o != nullptr); })
};

/// What numpy makes of the argument, empty where it can make nothing of it. A masked array's hidden entries would come
/// to light: refused.
py::array plain_array(const py::handle& value, const std::string& name);

// Numbers of arrays are within kLargestLength, whatever they mean: lengths, angles, times, forces. Where more may be
// meant, `largest` says so.

/// A plain number.
double finite_argument(double value, const std::string& name);
/// (n,) with finite entries; size < 0 takes any length.
Eigen::VectorXd vector_argument(const py::handle& value, const std::string& name, Eigen::Index size = -1,
                                double largest = kLargestLength);
/// The same as a list.
std::vector<double> list_argument(const py::handle& value, const std::string& name, double largest = kLargestLength);
Eigen::Vector2d vector2_argument(const py::handle& value, const std::string& name);
Eigen::Vector3d vector3_argument(const py::handle& value, const std::string& name);
/// (m, columns) with finite entries, or infinite ones where `largest` is; columns < 0 takes any number.
Eigen::MatrixXd matrix_argument(const py::handle& value, const std::string& name, Eigen::Index columns = -1,
                                double largest = kLargestLength);
/// (m, columns) with finite entries, as an array of float64 whose rows lie next to each other; not copied where the
/// argument is one.
py::array_t<double> batch_argument(const py::handle& value, const std::string& name, Eigen::Index columns);
/// (4, 4), a rigid transform. Where the argument may be left out (py::object), None is the identity.
Pose pose_argument(const ArrayLike& value, const std::string& name);
Pose pose_argument(const py::object& value, const std::string& name);
/// Zeros and ones (or booleans) of the given shape or flattened, as one row; without a shape any number of them.
std::vector<std::uint8_t> flags_argument(const py::handle& value, const std::string& name,
                                         const std::vector<py::ssize_t>& shape = {});
/// (m, n) rows as separate vectors.
std::vector<Eigen::VectorXd> rows_argument(const py::handle& value, const std::string& name, Eigen::Index columns = -1);

py::array_t<double> to_array(const Pose& T);
py::array_t<double> to_array(const Poses& poses);                             ///< (m, 4, 4)
py::array_t<double> rows_to_array(const std::vector<Eigen::VectorXd>& rows);  ///< (m, n)
py::array_t<double> rows_to_array(const std::vector<Eigen::Vector3d>& rows);  ///< (m, 3)

/// "[0.1, -0.2]", for messages and representations.
std::string text(const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace mmgrasp::python

namespace pybind11::detail {
template <>
struct handle_type_name<mmgrasp::python::ArrayLike> {
  static constexpr auto name = const_name("numpy.typing.ArrayLike");
};
}  // namespace pybind11::detail
