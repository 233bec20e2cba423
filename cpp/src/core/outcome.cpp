#include "mmgrasp/core/outcome.hpp"

namespace mmgrasp {

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::solved:
      return "solved";
    case Outcome::approximate:
      return "approximate";
    case Outcome::infeasible:
      return "infeasible";
    case Outcome::not_found:
      return "not_found";
    case Outcome::timeout:
      return "timeout";
    case Outcome::stopped:
      return "stopped";
    case Outcome::invalid_start:
      return "invalid_start";
    case Outcome::invalid_goal:
      return "invalid_goal";
  }
  return "unknown";
}

const char* to_string(Rejection cause) {
  switch (cause) {
    case Rejection::none:
      return "none";
    case Rejection::unreachable:
      return "unreachable";
    case Rejection::limits:
      return "limits";
    case Rejection::self_collision:
      return "self_collision";
    case Rejection::scene:
      return "scene";
    case Rejection::grasp_filter:
      return "grasp_filter";
  }
  return "unknown";
}

void Rejections::add(Rejection cause, std::size_t count) {
  switch (cause) {
    case Rejection::none:
      break;
    case Rejection::unreachable:
      unreachable += count;
      break;
    case Rejection::limits:
      limits += count;
      break;
    case Rejection::self_collision:
      self_collision += count;
      break;
    case Rejection::scene:
      scene += count;
      break;
    case Rejection::grasp_filter:
      grasp_filter += count;
      break;
  }
}

Rejections& Rejections::operator+=(const Rejections& other) {
  unreachable += other.unreachable;
  limits += other.limits;
  self_collision += other.self_collision;
  scene += other.scene;
  grasp_filter += other.grasp_filter;
  return *this;
}

std::size_t Rejections::total() const {
  return unreachable + limits + self_collision + scene + grasp_filter;
}

std::string Rejections::summary() const {
  std::string text;
  const auto append = [&text](Rejection cause, std::size_t count) {
    if (count == 0) return;
    if (!text.empty()) text += ", ";
    text += std::string(to_string(cause)) + " " + std::to_string(count);
  };
  append(Rejection::unreachable, unreachable);
  append(Rejection::limits, limits);
  append(Rejection::self_collision, self_collision);
  append(Rejection::scene, scene);
  append(Rejection::grasp_filter, grasp_filter);
  return text.empty() ? "none" : text;
}

bool Rejections::operator==(const Rejections& other) const {
  return unreachable == other.unreachable && limits == other.limits && self_collision == other.self_collision &&
         scene == other.scene && grasp_filter == other.grasp_filter;
}

}  // namespace mmgrasp
