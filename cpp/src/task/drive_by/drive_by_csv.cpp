// drive_by_csv(): the trajectory as text, with the tasks and what is attached.
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/drive_by.hpp"

namespace mmgrasp {
namespace {

/// A name as a CSV field.
std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + '"';
}

}  // namespace

std::string drive_by_csv(const DriveByResult& result, int between) {
  if (!result.trajectory) throw InvalidInput("result: there is no trajectory to write");
  const std::string plain = result.trajectory->to_csv(between);
  const std::vector<double> times = result.trajectory->sampled(between).times;
  std::string text;
  std::size_t from = 0;
  for (std::size_t line = 0; line <= times.size(); ++line) {
    const std::size_t end = plain.find('\n', from);
    text.append(plain, from, end - from);
    from = end + 1;
    std::string task, attached;
    for (std::size_t i = 0; line > 0 && i < result.events.size(); ++i) {
      const DriveByEvent& event = result.events[i];
      if (line - 1 == static_cast<std::size_t>(event.waypoint) * (between + 1)) task = std::to_string(i);
      if (!event.object.empty() && times[line - 1] >= event.attach_time) attached = event.object;
    }
    text += line == 0 ? ",task,attached" : "," + task + "," + quoted(attached);
    text += '\n';
  }
  return text;
}

}  // namespace mmgrasp
