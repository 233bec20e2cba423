#include "structure/object_path/grasp_variables.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

using Eigen::VectorXd;

namespace {
enum Index { kSection, kLength, kAngle, kFlip };
}

GraspVariables::GraspVariables(const Pipe& pipe, const PipeGraspOptions& grasp) : pipe_(pipe), options_(grasp) {
  pipe.check();
  grasp.check();
  for (int i = 0; i < static_cast<int>(pipe.sections.size()); ++i) {
    const double room = pipe.length(i) - 2 * grasp.end_margin;
    if (pipe.diameters[i] > grasp.max_opening || room <= 0) continue;
    sections_.push_back(i);
    room_.push_back(room);
  }
  require(!sections_.empty(), "pipe", "no section",
          "must have a section that the hand fits around, longer than both margins");
}

std::vector<SearchVariable> GraspVariables::variables() const {
  using Kind = SearchVariable::Kind;
  const double longest = *std::max_element(room_.begin(), room_.end());
  constexpr double kMutation = 0.1, kTurn = 100 * kPi / 180;  // [m], [rad] of the genetic algorithm (P2 3.5.1)
  return {{"section", Kind::category, 0, static_cast<double>(sections_.size() - 1)},  // P2: no velocities for it
          {"length", Kind::real, 0, longest, kMutation},
          {"angle", Kind::real, -kPi, kPi, kTurn},
          {"flip", Kind::category, 0, 1}};
}

Grasp GraspVariables::grasp(const VectorXd& x) const {
  const int section = sections_[static_cast<int>(x(kSection))];
  return place_pipe_grasp(pipe_, section, x(kLength) + options_.end_margin, x(kAngle), x(kFlip) > 0.5, options_);
}

VectorXd GraspVariables::neighbour(const VectorXd& x, double size, GraspNeighbourhood kind, Rng& rng) const {
  const std::vector<SearchVariable> all = variables();
  VectorXd near = x;
  const auto step = [&](int i) {
    const double reach = size / 2 * (all[i].upper - all[i].lower);
    return rng.uniform(-reach, reach);
  };
  if (kind == GraspNeighbourhood::independent) {  // at least the neighbouring sections
    const double reach = std::max(1.0, size / 2 * all[kSection].upper) + 0.5;
    near(kSection) = std::clamp(std::round(x(kSection) + rng.uniform(-reach, reach)), 0.0, all[kSection].upper);
  }
  near(kLength) += step(kLength);
  near(kAngle) = shortest_turn(x(kAngle) + step(kAngle));
  if (rng.uniform() < 0.5) near(kFlip) = 1 - near(kFlip);
  const double room = room_[static_cast<int>(near(kSection))];
  if (kind == GraspNeighbourhood::connected_sections && near(kLength) < 0) {
    cross_node(near, false, -near(kLength), rng);
  } else if (kind == GraspNeighbourhood::connected_sections && near(kLength) > room) {
    cross_node(near, true, near(kLength) - room, rng);
  }
  return near;  // the search puts what is still beyond a bound onto it
}

void GraspVariables::cross_node(VectorXd& x, bool at_end, double beyond, Rng& rng) const {
  const int own = static_cast<int>(x(kSection)), node = pipe_.sections[sections_[own]][at_end ? 1 : 0];
  std::vector<int> meeting;
  for (int i = 0; i < static_cast<int>(sections_.size()); ++i) {
    const auto [a, b] = pipe_.sections[sections_[i]];
    if (i != own && (a == node || b == node)) meeting.push_back(i);
  }
  if (meeting.empty()) return;
  const int next = meeting[rng.index(meeting.size())];
  beyond = std::min(beyond, room_[next]);
  x(kSection) = next;
  x(kLength) = pipe_.sections[sections_[next]][0] == node ? beyond : room_[next] - beyond;
}

}  // namespace mmgrasp::detail
