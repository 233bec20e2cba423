// Stops chosen among equally few: smallest and mean disc, length of the route (run_tie_steps.py leaves out one step of
// the choice after the other).
#include <algorithm>
#include <string>

#include "core/report.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/region_layouts.hpp"

namespace {

void run(const mmgrasp::test::Layout& layout) {
  mmgrasp::StopOptions options;
  options.route_length = [](const std::vector<mmgrasp::Stop>& stops) {
    return mmgrasp::straight_route_length(stops, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero());
  };
  const double start = bench::processor_seconds();
  const mmgrasp::StopSet set = mmgrasp::plan_stops_exact(layout.grid, layout.regions, options);
  const double seconds = bench::processor_seconds() - start;
  double least = set.stops.empty() ? 0 : set.stops.front().radius, sum = 0;
  for (const mmgrasp::Stop& stop : set.stops) {
    least = std::min(least, stop.radius);
    sum += stop.radius;
  }
  char more[200];
  std::snprintf(more, sizeof more, "\"stops\": %zu, \"least_radius\": %.5f, \"mean_radius\": %.5f, \"route\": %.4f",
                set.stops.size(), least, sum / static_cast<double>(set.stops.size()), options.route_length(set.stops));
  bench::print({"ties", layout.name, "mmgrasp", "s", seconds, more, "5 cm cells, uncertainty 0.10 m; 10 s for ties"});
}

}  // namespace

int main() {
  for (const int trays : {10, 22, 50}) {
    run(mmgrasp::test::row_layout(trays, 0.45));
    run(mmgrasp::test::aisle_layout(trays, 0.45, 1.5));
    run(mmgrasp::test::block_layout(trays, 0.45, 1.5));
  }
  for (const unsigned seed : {1u, 2u, 3u}) run(mmgrasp::test::random_layout(50, seed));
  for (const unsigned seed : {1u, 2u, 3u}) run(mmgrasp::test::overhead_layout(30, seed));
  return 0;
}
