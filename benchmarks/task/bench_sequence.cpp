// Least numbers of stops with their proofs: rows, two-sided aisles, blocks of shelves and random storerooms.
#include <cstdlib>
#include <string>

#include "core/report.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/region_layouts.hpp"

namespace {

constexpr double kUncertainty = 0.10;  // [m]

void run(const mmgrasp::test::Layout& layout) {
  const int trays = static_cast<int>(layout.regions.size());
  const double start = bench::now();
  const mmgrasp::Intersections found = mmgrasp::maximal_intersections(layout.grid, layout.regions, kUncertainty);
  const double searched = bench::now();
  mmgrasp::SetCoverProblem problem;
  problem.elements = trays;
  for (const mmgrasp::Intersection& place : found.robust) problem.sets.push_back(place.trays);
  const mmgrasp::SetCoverResult cover = mmgrasp::solve_set_cover(problem, 60.0);
  const double solved = bench::now();
  mmgrasp::StopOptions options;
  options.min_radius = kUncertainty;
  const mmgrasp::StopSet stops = mmgrasp::least_stops(layout.grid, layout.regions, options);
  const double chosen = bench::now();
  double least = 1e3, sum = 0;
  for (const mmgrasp::Stop& stop : stops.stops) {
    least = std::min(least, stop.radius);
    sum += stop.radius;
  }
  bench::Line line;
  line.row = "least stops";
  line.on = layout.name;
  line.who = "mmgrasp";
  line.unit = "s";
  line.value = solved - start;
  char more[500];
  std::snprintf(more, sizeof more,
                "\"trays\": %d, \"candidates\": %zu, \"stops\": %zu, \"bound\": %d, \"proven\": %s, \"candidates_s\": "
                "%.3f, \"proof_s\": %.3f, \"with_ties_s\": %.3f, \"least_radius\": %.4f, \"mean_radius\": %.4f",
                trays, found.robust.size(), stops.stops.size(), static_cast<int>(cover.lower_bound),
                found.complete && cover.outcome == mmgrasp::Outcome::solved ? "true" : "false", searched - start,
                solved - searched, chosen - solved, least, sum / static_cast<double>(stops.stops.size()));
  line.more = more;
  line.settings = "5 cm cells, uncertainty 0.10 m";
  bench::print(line);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  const auto wanted = [&](const char* name) { return only.empty() || only == name; };
  for (int trays : {2, 10, 22, 50, 100, 200, 500}) {
    if (wanted("row")) run(mmgrasp::test::row_layout(trays, 0.45));
    if (wanted("aisle")) run(mmgrasp::test::aisle_layout(trays, 0.45, 1.5));
  }
  // Thousands of candidates: many trays in few places.
  for (const double area : {0.06, 0.03}) {
    if (wanted("dense")) run(mmgrasp::test::overhead_layout(500, 1, area));
  }
  for (int trays : {50, 100, 200, 500}) {
    if (wanted("block")) run(mmgrasp::test::block_layout(trays, 0.45, 1.5));
    for (unsigned seed : {1u, 2u, 3u}) {
      if (wanted("random")) run(mmgrasp::test::random_layout(trays, seed));
      if (wanted("overhead")) run(mmgrasp::test::overhead_layout(trays, seed));
    }
  }
}
