#include "mmgrasp/reach/reach_arrays.hpp"

#include "reach/database/reach_data.hpp"

namespace mmgrasp {

ReachArrays reach_arrays(const ReachDatabase& database) {
  const ReachDatabase::Data& data = database.data();
  ReachArrays out;
  out.positions = static_cast<std::int64_t>(data.position_count());
  out.cells = static_cast<std::int64_t>(data.cell_count());
  out.size = static_cast<std::int64_t>(data.size());
  out.joints = data.joints;
  out.position_cells = data.positions.data;
  out.position_first = data.position_first.data;
  out.rotation_ids = data.rotation_ids.data;
  out.cell_first = data.cell_first.data;
  out.configurations = data.configurations.data;
  out.joint_lower = data.arm.lower;
  out.joint_step = data.arm.step;
  out.joint_names = data.arm.joints;
  out.robot = data.arm.robot;
  out.tip = data.arm.tip;
  return out;
}

ReachArrays checked_reach_arrays(const ReachDatabase& database) {
  const ReachDatabase::Data& data = database.data();
  if (data.size() > 0) data.stored(0, data.size());
  return reach_arrays(database);
}

}  // namespace mmgrasp
