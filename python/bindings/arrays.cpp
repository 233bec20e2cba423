#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <sstream>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shown(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

std::string shape_text(const std::vector<py::ssize_t>& shape) {
  std::ostringstream out;
  out << "(";
  for (std::size_t i = 0; i < shape.size(); ++i) out << (i ? ", " : "") << shape[i];
  out << (shape.size() == 1 ? ",)" : ")");
  return out.str();
}

std::vector<py::ssize_t> shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}

[[noreturn]] void wrong_shape(const std::string& name, const py::array& array, const std::string& wanted) {
  throw InvalidInput(name + " has shape " + shape_text(shape_of(array)) + ": must be " + wanted);
}

}  // namespace

py::array plain_array(const py::handle& value, const std::string& name) {
  if (value.is_none()) return py::array();
  if (py::isinstance<py::array>(value) && py::hasattr(value, "mask") &&
      py::cast<bool>(value.attr("mask").attr("__array__")().attr("any")())) {
    throw InvalidInput(name + ": a masked array of which entries are masked: fill them, where NaN may stand for what " +
                       "is not known with array.filled(numpy.nan)");
  }
  py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
  } else if (!(array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_)) {
    array = array.attr("copy")();  // Views into bytes at odd places hold numbers where C++ may not read any.
  }
  return array;
}

namespace {

/// The value as numpy's array, its element type one of `kinds` (numpy's letters).
py::array array_of(const py::handle& value, const std::string& name, const std::string& kinds,
                   const std::string& wanted) {
  const py::array raw = plain_array(value, name);
  if (!value.is_none() && raw && kinds.find(raw.dtype().kind()) != std::string::npos) return raw;
  std::string given = value.is_none() ? "None" : std::string(py::str(py::type::handle_of(value).attr("__name__")));
  if (raw && py::isinstance<py::array>(value)) given += " of " + std::string(py::str(raw.dtype()));
  throw InvalidInput(name + " = <" + given + ">: must be an array of " + wanted);
}

/// `shape`: lengths, -1 for any. They are looked at first: a copy of what cannot fit may take all memory. No number is
/// larger than `largest`.
Array numbers(const py::handle& value, const std::string& name, const std::vector<Eigen::Index>& shape,
              const std::string& wanted, double largest) {
  const py::array raw = array_of(value, name, "fiu", "numbers of shape " + wanted);
  const auto given = shape_of(raw);
  const auto fits = [](Eigen::Index length, py::ssize_t found) { return length < 0 || length == found; };
  if (!std::equal(shape.begin(), shape.end(), given.begin(), given.end(), fits)) wrong_shape(name, raw, wanted);
  const Array array = Array::ensure(raw);
  if (!array) {
    PyErr_Clear();
    throw InvalidInput(name + ": cannot be converted to an array of float64");
  }
  const auto fits_in = [&](double number) {
    return std::abs(number) <= std::min(largest, kLargestNumber) || (std::isinf(number) && std::isinf(largest));
  };
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    if (!fits_in(array.data()[i])) {
      const py::ssize_t columns = array.shape(array.ndim() - 1);
      const std::string entry = array.ndim() == 2
                                    ? "(" + std::to_string(i / columns) + ", " + std::to_string(i % columns) + ")"
                                    : std::to_string(i);
      throw InvalidInput(name + " holds " + shown(array.data()[i]) + " at entry " + entry +
                         (largest == detail::kInfinity ? ": must be a number, within 1e15 or infinite"
                                                       : ": must be finite and within " + shown(largest)));
    }
  }
  return array;
}

std::string count_text(Eigen::Index count, const char* any) {
  return count < 0 ? any : std::to_string(count);
}

}  // namespace

double finite_argument(double value, const std::string& name) {
  require_number(value, name);
  return value;
}

Eigen::VectorXd vector_argument(const py::handle& value, const std::string& name, Eigen::Index size, double largest) {
  const std::string wanted = "(" + count_text(size, "n") + ",)";
  const Array array = numbers(value, name, {size}, wanted, largest);
  return Eigen::Map<const Eigen::VectorXd>(array.data(), array.size());
}

std::vector<double> list_argument(const py::handle& value, const std::string& name, double largest) {
  const Eigen::VectorXd numbers = vector_argument(value, name, -1, largest);
  return {numbers.begin(), numbers.end()};
}

Eigen::Vector2d vector2_argument(const py::handle& value, const std::string& name) {
  return vector_argument(value, name, 2);
}

Eigen::Vector3d vector3_argument(const py::handle& value, const std::string& name) {
  return vector_argument(value, name, 3);
}

static Array rows_of_numbers(const py::handle& value, const std::string& name, Eigen::Index columns, double largest) {
  const std::string wanted = "(m, " + count_text(columns, "n") + ")";
  return numbers(value, name, {-1, columns}, wanted, largest);
}

py::array_t<double> batch_argument(const py::handle& value, const std::string& name, Eigen::Index columns) {
  return rows_of_numbers(value, name, columns, kLargestLength);
}

Eigen::MatrixXd matrix_argument(const py::handle& value, const std::string& name, Eigen::Index columns,
                                double largest) {
  const Array array = rows_of_numbers(value, name, columns, largest);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data(), array.shape(0), array.shape(1));
}

Pose pose_argument(const py::object& value, const std::string& name) {
  return value.is_none() ? Pose::Identity() : pose_argument(ArrayLike(value), name);
}

Pose pose_argument(const ArrayLike& value, const std::string& name) {
  const Array array = numbers(value, name, {4, 4}, "(4, 4)", kLargestLength);
  return checked_pose(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data()), name);
}

template <typename Entry>
static std::vector<std::uint8_t> checked_flags(const py::array& raw, const std::string& name) {
  const auto entries = py::array_t<Entry, py::array::c_style | py::array::forcecast>::ensure(raw);
  for (py::ssize_t i = 0; i < entries.size(); ++i) {
    if (entries.data()[i] == 0 || entries.data()[i] == 1) continue;
    throw InvalidInput(name + " holds " + std::to_string(entries.data()[i]) + " at entry " + std::to_string(i) +
                       ": must be 0 or 1");
  }
  return {entries.data(), entries.data() + entries.size()};
}

std::vector<std::uint8_t> flags_argument(const py::handle& value, const std::string& name,
                                         const std::vector<py::ssize_t>& shape) {
  std::string wanted = "(n,)";
  py::ssize_t count = -1;
  if (!shape.empty()) {
    count = std::accumulate(shape.begin(), shape.end(), py::ssize_t{1}, std::multiplies<>());
    wanted = shape_text(shape) + " or flat (" + std::to_string(count) + ",)";
  }
  const py::array raw = array_of(value, name, "biu", "flags of shape " + wanted);
  const bool flat = raw.ndim() == 1 && (count < 0 || raw.size() == count);
  if (!flat && shape_of(raw) != shape) wrong_shape(name, raw, wanted);
  return raw.itemsize() == 1 ? checked_flags<std::uint8_t>(raw, name) : checked_flags<std::int64_t>(raw, name);
}

static std::vector<Eigen::VectorXd> split(const Array& array) {
  std::vector<Eigen::VectorXd> rows(array.shape(0));
  const Eigen::Index columns = array.shape(1);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = Eigen::Map<const Eigen::VectorXd>(array.data() + i * columns, columns);
  return rows;
}

std::vector<Eigen::VectorXd> rows_argument(const py::handle& value, const std::string& name, Eigen::Index columns) {
  return split(rows_of_numbers(value, name, columns, kLargestLength));
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
  constexpr py::ssize_t kColumns = std::max<py::ssize_t>(0, Vector::RowsAtCompileTime);  // without rows: as (0, 3)
  const py::ssize_t columns = rows.empty() ? kColumns : rows.front().size();
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
