#include "arrays.hpp"

#include <cmath>
#include <sstream>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_text(const py::array& array) {
  std::ostringstream out;
  out << "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) out << (i ? ", " : "") << array.shape(i);
  out << (array.ndim() == 1 ? ",)" : ")");
  return out.str();
}

Array numbers(const py::handle& value, const std::string& name, int dimensions, const std::string& wanted) {
  py::array raw = value.is_none() ? py::array() : py::array::ensure(value);
  PyErr_Clear();
  const char kind = raw ? raw.dtype().kind() : 'O';
  if (value.is_none() || !raw || (kind != 'f' && kind != 'i' && kind != 'u')) {
    const std::string given =
        value.is_none() ? "None" : std::string(py::str(py::type::handle_of(value).attr("__name__")));
    throw InvalidInput(name + " = <" + given + ">: must be an array of numbers of shape " + wanted);
  }
  if (raw.ndim() != dimensions) {
    throw InvalidInput(name + " has shape " + shape_text(raw) + ": must be " + wanted);
  }
  Array array = Array::ensure(raw);
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    if (!std::isfinite(array.data()[i])) {
      throw InvalidInput(name + " holds " + std::to_string(array.data()[i]) + " at entry " + std::to_string(i) +
                         ": must be finite");
    }
  }
  return array;
}

std::string count_text(Eigen::Index count, const char* any) {
  return count < 0 ? any : std::to_string(count);
}

}  // namespace

Eigen::VectorXd vector_argument(const py::handle& value, const std::string& name, Eigen::Index size) {
  const std::string wanted = "(" + count_text(size, "n") + ",)";
  const Array array = numbers(value, name, 1, wanted);
  if (size >= 0 && array.size() != size) {
    throw InvalidInput(name + " has shape " + shape_text(array) + ": must be " + wanted);
  }
  return Eigen::Map<const Eigen::VectorXd>(array.data(), array.size());
}

Eigen::Vector2d vector2_argument(const py::handle& value, const std::string& name) {
  return vector_argument(value, name, 2);
}

Eigen::Vector3d vector3_argument(const py::handle& value, const std::string& name) {
  return vector_argument(value, name, 3);
}

Eigen::MatrixXd matrix_argument(const py::handle& value, const std::string& name, Eigen::Index columns) {
  const std::string wanted = "(m, " + count_text(columns, "n") + ")";
  const Array array = numbers(value, name, 2, wanted);
  if (columns >= 0 && array.shape(1) != columns) {
    throw InvalidInput(name + " has shape " + shape_text(array) + ": must be " + wanted);
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data(), array.shape(0), array.shape(1));
}

Pose pose_argument(const py::handle& value, const std::string& name) {
  if (value.is_none()) return Pose::Identity();
  const Array array = numbers(value, name, 2, "(4, 4)");
  if (array.shape(0) != 4 || array.shape(1) != 4) {
    throw InvalidInput(name + " has shape " + shape_text(array) + ": must be (4, 4)");
  }
  return checked_pose(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data()), name);
}

std::vector<Eigen::VectorXd> rows_argument(const py::handle& value, const std::string& name, Eigen::Index columns) {
  const Eigen::MatrixXd matrix = matrix_argument(value, name, columns);
  std::vector<Eigen::VectorXd> rows(matrix.rows());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows[i] = matrix.row(i);
  return rows;
}

py::array_t<double> to_array(const Pose& T) {
  py::array_t<double> out({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(out.mutable_data()) = T.matrix();
  return out;
}

py::array_t<double> to_array(const Poses& poses) {
  py::array_t<double> out({static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(out.mutable_data() + 16 * i) = poses[i].matrix();
  }
  return out;
}

template <typename Vector>
static py::array_t<double> stack(const std::vector<Vector>& rows) {
  const py::ssize_t columns = rows.empty() ? 0 : rows.front().size();
  py::array_t<double> out({static_cast<py::ssize_t>(rows.size()), columns});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy(rows[i].data(), rows[i].data() + columns, out.mutable_data() + i * columns);
  }
  return out;
}

py::array_t<double> rows_to_array(const std::vector<Eigen::VectorXd>& rows) {
  return stack(rows);
}
py::array_t<double> rows_to_array(const std::vector<Eigen::Vector3d>& rows) {
  return stack(rows);
}

std::string text(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::ostringstream out;
  out.precision(4);
  out << "[";
  for (Eigen::Index i = 0; i < values.size(); ++i) out << (i ? ", " : "") << values[i];
  out << "]";
  return out.str();
}

}  // namespace mmgrasp::python
