#pragma once

#include <pybind11/pybind11.h>

namespace mmgrasp::python {

namespace py = pybind11;

/// A Python object taken or given as it is, while signatures and stubs show it as `annotation`.
template <const auto& annotation>
class Shown : public py::object {
  PYBIND11_OBJECT_DEFAULT(Shown, py::object, [](PyObject* o) { return static_cast<int>(o != nullptr); })
};

/// The same for what must be a sequence, and for what must be a dict.
template <const auto& annotation>
class ShownSequence : public py::sequence {
  PYBIND11_OBJECT_DEFAULT(ShownSequence, py::sequence, PySequence_Check)
};
template <const auto& annotation>
class ShownDict : public py::dict {
  PYBIND11_OBJECT(ShownDict, py::dict, PyDict_Check)
};

namespace annotations {
inline constexpr char kPath[] = "str | os.PathLike[str]";
inline constexpr char kOptionalPath[] = "str | os.PathLike[str] | None";
inline constexpr char kOptionalArray[] = "numpy.typing.ArrayLike | None";
inline constexpr char kOptionalText[] = "str | None";
inline constexpr char kOptionalNumber[] = "float | None";
inline constexpr char kProgress[] = "collections.abc.Callable[[str, float], object] | None";
// None without an answer. Any stands for it, as in typeshed, so that code which knows the outcome need not ask again.
inline constexpr char kMaybeFloats[] = "numpy.typing.NDArray[numpy.float64] | typing.Any";
inline constexpr char kFloats32[] = "numpy.typing.NDArray[numpy.float32]";
inline constexpr char kBytes[] = "numpy.typing.NDArray[numpy.uint8]";
inline constexpr char kNamedFloats[] = "dict[str, float]";
inline constexpr char kNamedCounts[] = "dict[str, int]";
inline constexpr char kNamedOptions[] = "dict[str, bool | int | float | str]";
inline constexpr char kNamedPoses[] = "dict[str, numpy.typing.NDArray[numpy.float64]]";
}  // namespace annotations

using PathLike = Shown<annotations::kPath>;
using OptionalPath = Shown<annotations::kOptionalPath>;
using OptionalArray = Shown<annotations::kOptionalArray>;
using OptionalText = Shown<annotations::kOptionalText>;
using OptionalNumber = Shown<annotations::kOptionalNumber>;
/// A function of a stage's name and its done share in [0, 1], or None.
using Progress = Shown<annotations::kProgress>;
/// An array of float64, or None.
using MaybeFloats = Shown<annotations::kMaybeFloats>;
using Floats32 = Shown<annotations::kFloats32>;
using Bytes = Shown<annotations::kBytes>;
using NamedFloats = Shown<annotations::kNamedFloats>;
using NamedCounts = Shown<annotations::kNamedCounts>;
using NamedOptions = Shown<annotations::kNamedOptions>;
using NamedPoses = Shown<annotations::kNamedPoses>;

}  // namespace mmgrasp::python

namespace pybind11::detail {
template <const auto& annotation>
struct handle_type_name<mmgrasp::python::Shown<annotation>> {
  static constexpr auto name = const_name(annotation);
};
template <const auto& annotation>
struct handle_type_name<mmgrasp::python::ShownSequence<annotation>> {
  static constexpr auto name = const_name(annotation);
};
template <const auto& annotation>
struct handle_type_name<mmgrasp::python::ShownDict<annotation>> {
  static constexpr auto name = const_name(annotation);
};
}  // namespace pybind11::detail
