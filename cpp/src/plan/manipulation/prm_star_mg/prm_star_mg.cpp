#include "plan/manipulation/prm_star_mg/prm_star_mg.hpp"

#include <algorithm>
#include <optional>

#include "plan/manipulation/common/finish_path.hpp"
#include "plan/manipulation/common/first_transfer.hpp"
#include "plan/manipulation/common/transfer_shortening.hpp"
#include "plan/manipulation/prm_star_mg/roadmap_search.hpp"
#include "plan/manipulation/prm_star_mg/transfer_refinement.hpp"
#include "plan/roadmap/roadmap_data.hpp"

namespace mmgrasp::detail {
namespace {

/// The roadmap to begin with, built unless given; nothing when stopped.
std::optional<Roadmap> first_roadmap(ManipulationInput& input, ManipulationResult& result) {
  if (input.roadmap) return *input.roadmap;
  const Stopwatch clock;
  const Roadmap own = Roadmap::build(input.problem.group, roadmap_options(input.options), input.monitor);
  result.stats.roadmap_seconds = clock.seconds();
  input.clock.leave_out(result.stats.roadmap_seconds);
  if (input.monitor.stopped()) return std::nullopt;
  return own;
}

}  // namespace

bool run_prm_star_mg(ManipulationInput& input, ManipulationResult& result) {
  const PrmStarMgOptions& options = input.options.prm;
  // A first path leaves the roadmap, as shortened ones and straight edges do.
  TransferPath best;
  if (input.options.straight && options.shorten) best = find_first_transfer(input, result);
  if (best.grasp >= 0) shorten_transfer(input, best, result);
  // Paths over the roadmap have to beat the first one as it was found: they will be shortened too.
  const double first = best.cost;
  input.candidates.find_rest();
  std::optional<Roadmap> roadmap;
  if (!input.candidates.found().empty()) roadmap = first_roadmap(input, result);
  bool whole = false;
  while (roadmap) {
    const double before = best.cost;
    whole = RoadmapSearch(input, *roadmap, input.options.straight, input.options.threads, best, result).run();
    if (options.shorten && best.cost < before) shorten_transfer(input, best, result);
    if (!whole || 2.0 * roadmap->size() > options.max_vertices) break;
    // The same seed gives the same vertices, and more of them.
    RoadmapOptions denser = roadmap->options();
    denser.vertices = 2 * roadmap->size();
    roadmap = build_roadmap(input.problem.group, denser, input.monitor, [&] { return input.out_of_time(); });
    if (input.out_of_time()) break;
  }
  if (roadmap && !roadmap->warning().empty()) result.warnings.push_back(roadmap->warning());
  if (best.cost < first) result.stats.roadmap_cost = best.cost;
  if (result.path) {
    if (whole && options.shorten) refine_transfer(input, result);
    if (options.shorten) finish_path(input, result);
    result.stats.roadmap_bound = std::min(result.stats.roadmap_bound, result.cost);
  }
  return whole;
}

}  // namespace mmgrasp::detail
