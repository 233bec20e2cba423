// Least numbers of stops with their proofs: rows, two-sided aisles, blocks of shelves and random storerooms.
#include <cmath>
#include <ctime>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include "core/report.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/region_layouts.hpp"

namespace {

constexpr double kUncertainty = 0.10;         // [m]
constexpr double kProof = 60.0, kTies = 2.0;  // At most [s].

double processor_time() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void run(const mmgrasp::test::Layout& layout) {
  const int trays = static_cast<int>(layout.regions.size());
  const double start = bench::now(), used = processor_time();
  const mmgrasp::Intersections found = mmgrasp::maximal_intersections(layout.grid, layout.regions, kUncertainty);
  const double searched = bench::now();
  mmgrasp::SetCoverProblem problem;
  problem.elements = trays;
  for (const mmgrasp::Intersection& place : found.robust)
    problem.sets.emplace_back(place.trays.begin(), place.trays.end());
  const mmgrasp::SetCoverResult cover = mmgrasp::solve_set_cover(problem, kProof);
  const double solved = bench::now(), processor = processor_time() - used;
  // Whole stops: what the bound cannot rule out is the next whole number.
  const int bound = found.complete ? static_cast<int>(std::ceil(cover.lower_bound - 1e-6)) : 1;
  const bool proven = found.complete && cover.outcome == mmgrasp::Outcome::solved;
  const std::size_t count = cover.chosen.size();
  if (count == 0) throw std::runtime_error(layout.name + ": no cover");
  bench::Line line;
  line.row = "exact stops";
  line.on = layout.name;
  line.who = "mmgrasp";
  line.unit = "s";
  line.value = solved - start;
  char more[500];
  int written = std::snprintf(more, sizeof more,
                              "\"trays\": %d, \"candidates\": %zu, \"stops\": %zu, \"bound\": %d, \"gap\": %d, "
                              "\"proven\": %s, \"candidates_s\": %.3f, \"proof_s\": %.3f, \"processor_s\": %.3f",
                              trays, found.robust.size(), count, bound, static_cast<int>(count) - bound,
                              proven ? "true" : "false", searched - start, solved - searched, processor);
  if (proven) {
    // Among equally few: the widest discs.
    mmgrasp::StopOptions options;
    options.min_radius = kUncertainty;
    options.tie_time_limit = kTies;
    const mmgrasp::StopSet stops = mmgrasp::plan_stops_exact(layout.grid, layout.regions, options);
    double least = 1e3, sum = 0;
    for (const mmgrasp::Stop& stop : stops.stops) {
      least = std::min(least, stop.radius);
      sum += stop.radius;
    }
    std::snprintf(more + written, sizeof more - written,
                  ", \"with_ties_s\": %.3f, \"least_radius\": %.4f, \"mean_radius\": %.4f", bench::now() - solved,
                  least, sum / static_cast<double>(stops.stops.size()));
  }
  line.more = more;
  line.settings = "5 cm cells, uncertainty 0.10 m; 60 s for a proof, 2 s for ties";
  bench::print(line);
}

}  // namespace

// bench_sequence [row | aisle | boards | block | random | dense]...    default: all but dense, which needs minutes
int main(int argc, char** argv) {
  const std::set<std::string> only(argv + 1, argv + argc);
  const auto wanted = [&](const char* name) { return only.empty() || only.count(name) > 0; };
  for (int trays : {2, 10, 22, 50, 100, 200, 500}) {
    if (wanted("row")) run(mmgrasp::test::row_layout(trays, 0.45));
    if (wanted("aisle")) run(mmgrasp::test::aisle_layout(trays, 0.45, 1.5));
  }
  // Thousands of candidates: many places and headings, deep overlaps.
  for (const auto& [boards, headings, spacing] : {std::tuple(5, 1, 0.5), std::tuple(10, 48, 1.2)}) {
    if (!wanted("boards")) break;
    run(mmgrasp::test::board_layout(500, boards, spacing, 0.0, headings, 1));
    run(mmgrasp::test::board_layout(500, boards, spacing, 1.4, headings, 1));
  }
  for (int trays : {50, 100, 200, 500}) {
    if (wanted("block")) run(mmgrasp::test::block_layout(trays, 0.45, 1.5));
    for (unsigned seed : {1u, 2u, 3u}) {
      if (wanted("random")) run(mmgrasp::test::random_layout(trays, seed));
    }
  }
  if (wanted("random")) run(mmgrasp::test::random_layout(1000, 1));
  if (only.count("dense") == 0) return 0;
  // Trays that the robot drives below, so many that each place serves a dozen or more.
  for (int trays : {50, 100, 200, 500}) {
    for (unsigned seed : {1u, 2u, 3u}) run(mmgrasp::test::overhead_layout(trays, seed));
  }
  for (const double area : {0.06, 0.03}) run(mmgrasp::test::overhead_layout(500, 1, area));
}
