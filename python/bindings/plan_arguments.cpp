#include "plan_arguments.hpp"

namespace mmgrasp::python {

Poses poses_argument(const ArrayLike& value, const std::string& name) {
  const py::array array = plain_array(value, name);
  if (!array || array.ndim() != 3) return {pose_argument(value, name)};
  Poses poses;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const std::string entry = name + "[" + std::to_string(i) + "]";
    poses.push_back(pose_argument(ArrayLike(py::object(array[py::int_(i)])), entry));
  }
  return poses;
}

MaybeFloats path_array(const std::optional<JointPath>& path) {
  if (!path) return MaybeFloats(py::none());
  return rows_to_array(path->waypoints);
}

py::object path_list(const std::optional<JointPath>& path) {
  return path ? py::object(path_array(path).attr("tolist")()) : py::none();
}

}  // namespace mmgrasp::python
