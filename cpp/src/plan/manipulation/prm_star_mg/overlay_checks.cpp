#include "plan/manipulation/prm_star_mg/overlay_checks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSampleSpacing = 0.4;  // [rad or m] Of the few configurations an edge is first looked at.
constexpr std::size_t kCheap = 64;      // Configurations that are worth a thread.

/// One question an opening's robot is asked about a vertex or an edge of the roadmap, however many paths lead over it.
struct RobotItem {
  int opening, what, path, place;
};

/// Of equal questions the one for the first path is kept.

std::vector<RobotItem> asked_once(std::vector<RobotItem> items) {
  const auto key = [](const RobotItem& i) { return std::tie(i.opening, i.what, i.path, i.place); };
  std::sort(items.begin(), items.end(), [&](const RobotItem& a, const RobotItem& b) { return key(a) < key(b); });
  items.erase(
      std::unique(items.begin(), items.end(),
                  [](const RobotItem& a, const RobotItem& b) { return a.opening == b.opening && a.what == b.what; }),
      items.end());
  return items;
}

}  // namespace

OverlayChecks::OverlayChecks(const Roadmap& roadmap, CarryChecks& checks, std::vector<RoadmapKnowledge>& knowledge,
                             int threads, const Monitor& monitor, ManipulationStats& stats)
    : roadmap_(roadmap), checks_(checks), knowledge_(knowledge), threads_(threads), stats_(stats) {
  stop_.stop = monitor.stop;
}

std::vector<char> OverlayChecks::check(const std::vector<GraspOverlay*>& paths) {
  paths_ = &paths;
  live_.assign(paths.size(), 1);
  vertices_for_robot();
  vertices_for_held();
  samples();
  edges_for_robot();
  edges_for_held();
  return live_;
}

void OverlayChecks::run(std::size_t count, std::size_t worth, const std::function<void(std::size_t, int)>& work) {
  parallel_for(count, count >= worth ? threads_ : 1, work, stop_);
}

// The ends were checked with their IK.
void OverlayChecks::vertices_for_robot() {
  std::vector<RobotItem> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    const GraspOverlay& overlay = *(*paths_)[p];
    for (const int node : overlay.nodes)
      if (node < overlay.vertex_count && robot_of(overlay).vertex(node) == RoadmapKnowledge::unknown)
        items.push_back({overlay.candidate.opening, node, static_cast<int>(p), 0});
  }
  items = asked_once(std::move(items));
  run(items.size(), kCheap, [&](std::size_t i, int worker) {
    const RobotItem& item = items[i];
    knowledge_[static_cast<std::size_t>(item.opening)].set_vertex(
        item.what, checks_.robot_is_free(worker, item.opening, roadmap_.vertices().col(item.what)));
  });
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    const GraspOverlay& overlay = *(*paths_)[p];
    for (const int node : overlay.nodes)
      if (node < overlay.vertex_count && robot_of(overlay).vertex(node) == RoadmapKnowledge::blocked) live_[p] = 0;
  }
}

void OverlayChecks::vertices_for_held() {
  std::vector<Item> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    if (!live_[p]) continue;
    const GraspOverlay& overlay = *(*paths_)[p];
    for (const int node : overlay.nodes)
      if (node < overlay.vertex_count && overlay.passed_vertices.count(node) == 0)
        items.push_back({static_cast<int>(p), node});
  }
  std::vector<char> answers(items.size());
  run(items.size(), kCheap, [&](std::size_t i, int worker) {
    answers[i] =
        checks_.held_is_free(worker, overlay_of(items[i]).candidate.grasp, roadmap_.vertices().col(items[i].what));
  });
  for (std::size_t i = 0; i < items.size(); ++i) {
    GraspOverlay& overlay = overlay_of(items[i]);
    if (answers[i]) {
      overlay.passed_vertices.insert(items[i].what);
    } else {
      overlay.blocked_vertices.push_back(items[i].what);
      live_[static_cast<std::size_t>(items[i].path)] = 0;
    }
  }
}

std::vector<OverlayChecks::Item> OverlayChecks::open_steps() const {
  std::vector<Item> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    if (!live_[p]) continue;
    const GraspOverlay& overlay = *(*paths_)[p];
    for (std::size_t i = 0; i < overlay.steps.size(); ++i)
      if (!overlay.passed(overlay.steps[i])) items.push_back({static_cast<int>(p), static_cast<int>(i)});
  }
  return items;
}

GraspOverlay& OverlayChecks::overlay_of(const Item& item) const {
  return *(*paths_)[static_cast<std::size_t>(item.path)];
}

Step OverlayChecks::step_of(const Item& item) const {
  return overlay_of(item).steps[static_cast<std::size_t>(item.what)];
}

std::pair<Eigen::VectorXd, Eigen::VectorXd> OverlayChecks::ends(const Item& step) const {
  const GraspOverlay& overlay = overlay_of(step);
  const auto place = static_cast<std::size_t>(step.what);
  return {overlay.configuration(roadmap_, overlay.nodes[place]),
          overlay.configuration(roadmap_, overlay.nodes[place + 1])};
}

void OverlayChecks::take_steps(const std::vector<Item>& items, const std::vector<char>& answers, bool final) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!answers[i]) live_[static_cast<std::size_t>(items[i].path)] = 0;
    if (!answers[i] || final) overlay_of(items[i]).set_step(step_of(items[i]), answers[i] != 0);
  }
}

// What blocks an edge tends to block a good part of it: a few configurations find most of those that are blocked.
void OverlayChecks::samples() {
  const std::vector<Item> items = open_steps();
  std::vector<char> answers(items.size());
  run(items.size(), kCheap / 4, [&](std::size_t i, int worker) {
    const CarryCandidate& candidate = overlay_of(items[i]).candidate;
    const bool is_link = step_of(items[i]).is_link();
    const auto [a, b] = ends(items[i]);
    const auto is_free = [&](double t) {
      const Eigen::VectorXd q = a + t * (b - a);
      return checks_.held_is_free(worker, candidate.grasp, q) &&
             (!is_link || checks_.robot_is_free(worker, candidate.opening, q));
    };
    // The middles first: 1/2, 1/4, 3/4, 1/8, ...
    const int depth = static_cast<int>(std::ceil(std::log2(std::max(1.0, (b - a).norm() / kSampleSpacing))));
    bool all = true;
    for (int level = 1; level <= std::min(depth, 5) && all; ++level)
      for (int k = 1; k < (1 << level) && all; k += 2) all = is_free(std::ldexp(k, -level));
    answers[i] = all;
  });
  take_steps(items, answers, false);
}

std::vector<OverlayChecks::Item> OverlayChecks::open_steps_of_robot() const {
  std::vector<Item> items;
  std::vector<RobotItem> edges;
  for (const Item& item : open_steps()) {
    const GraspOverlay& overlay = overlay_of(item);
    const Step step = step_of(item);
    if (step.is_link()) {  // No other path has it.
      if (!overlay.link(step.number()).robot_passed) items.push_back(item);
    } else if (robot_of(overlay).edge(step.number()) == RoadmapKnowledge::unknown) {
      edges.push_back({overlay.candidate.opening, step.number(), item.path, item.what});
    }
  }
  for (const RobotItem& edge : asked_once(std::move(edges))) items.push_back({edge.path, edge.place});
  return items;
}

void OverlayChecks::take_step_of_robot(const Item& item, bool is_free) {
  GraspOverlay& overlay = overlay_of(item);
  const Step step = step_of(item);
  if (!step.is_link()) return robot_of(overlay).set_edge(step.number(), is_free);
  GraspOverlay::Link& link = overlay.link(step.number());
  link.robot_passed = is_free;
  link.blocked = !is_free;
}

bool OverlayChecks::robot_blocks(const GraspOverlay& overlay) const {
  return std::any_of(overlay.steps.begin(), overlay.steps.end(), [&](Step step) {
    return step.is_link() ? overlay.link(step.number()).blocked
                          : robot_of(overlay).edge(step.number()) == RoadmapKnowledge::blocked;
  });
}

void OverlayChecks::edges_for_robot() {
  const std::vector<Item> items = open_steps_of_robot();
  std::vector<char> answers(items.size());
  run(items.size(), 2, [&](std::size_t i, int worker) {
    const auto [a, b] = ends(items[i]);
    answers[i] = checks_.robot_edge_is_free(worker, overlay_of(items[i]).candidate.opening, a, b);
  });
  stats_.edges_checked_robot += items.size();
  for (std::size_t i = 0; i < items.size(); ++i) take_step_of_robot(items[i], answers[i] != 0);
  for (std::size_t p = 0; p < paths_->size(); ++p)
    if (robot_blocks(*(*paths_)[p])) live_[p] = 0;
}

void OverlayChecks::edges_for_held() {
  const std::vector<Item> items = open_steps();
  std::vector<char> answers(items.size());
  run(items.size(), 2, [&](std::size_t i, int worker) {
    const auto [a, b] = ends(items[i]);
    answers[i] = checks_.held_edge_is_free(worker, overlay_of(items[i]).candidate.grasp, a, b);
  });
  stats_.edges_checked_held += items.size();
  take_steps(items, answers, true);
}

}  // namespace mmgrasp::detail
