#include "task/drive_by/drive_by_events.hpp"

#include <sstream>

#include "task/drive_by/drive_by_seed.hpp"

namespace mmgrasp::detail {

using Eigen::VectorXd;

std::string number(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

std::string describe(const WholeBodyResult& r) {
  std::string text =
      std::string(to_string(r.outcome)) + " after " + std::to_string(r.iterations) + " iterations (" + r.message + ")";
  for (const Violation& v : r.violations) {
    if (v.kept()) continue;
    text += "; " + v.kind + " (" + v.what + ") broken by " + number(v.value) + " " + v.unit + " at waypoint " +
            std::to_string(v.waypoint) + ", " + number(v.time) + " s";
  }
  return text;
}

std::vector<DriveByEvent> events_of(const WholeBodyTrajectory& t, const World& world,
                                    const std::vector<DriveByStep>& steps, const std::vector<int>& waypoints,
                                    const ConfigurationSequence& sequence) {
  std::vector<DriveByEvent> events;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const std::size_t at = waypoints[i];
    if (steps[i].begins) events.emplace_back();
    DriveByEvent& e = events.back();
    const VectorXd rate = configuration_velocity(t.group(), t.positions()[at], t.drive()[at]);
    e.waypoint = waypoints[i];
    e.time = t.times()[at];
    if (steps[i].closes) e.close_time = e.time;
    if (steps[i].push) e.push = push_grasp(push_closing(steps[i])).push;
    if (!steps[i].object.empty()) {
      e.object = steps[i].object;
      const Pose& T_world_object = world.objects().at(e.object).T_world_object;
      e.T_tip_object = attached_pose(steps[i], t.group().fk(t.positions()[at]), T_world_object);
      e.attach_time = t.times()[at + (steps[i].dwell > 0 ? dwell_intervals(steps[i].dwell) : 0)];
    }
    e.candidate = sequence[i].candidate;
    e.base_speed = t.group().has_base() ? rate.head<2>().norm() : 0;
    e.tool_speed = (t.group().jacobian(t.positions()[at]) * rate).head<3>().norm();
  }
  return events;
}

}  // namespace mmgrasp::detail
