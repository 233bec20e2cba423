// OR-Library's set covering files: cost, proven bound and time of each. Costs are whole numbers, unlike stops': a
// stress test of the same solver.
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "core/report.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "support/orlib.hpp"

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1
                                           ? std::filesystem::path(argv[1])
                                           : std::filesystem::path(MMGRASP_SHARED_DATA) / "reference" / "orlib_scp";
  std::set<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".txt") files.insert(entry.path());
  }
  for (const auto& file : files) {
    std::ifstream in(file);
    const mmgrasp::SetCoverProblem problem = mmgrasp::test::read_orlib(in);
    const double start = bench::now();
    const mmgrasp::SetCoverResult result = mmgrasp::solve_set_cover(problem, 60.0);
    bench::Line line;
    line.row = "set cover";
    line.on = file.stem().string();
    line.who = "mmgrasp";
    line.unit = "s";
    line.value = bench::now() - start;
    char more[200];
    std::snprintf(more, sizeof more, "\"rows\": %d, \"columns\": %zu, \"cost\": %g, \"bound\": %g, \"proven\": %s",
                  problem.elements, problem.sets.size(), result.cost, result.lower_bound,
                  result.outcome == mmgrasp::Outcome::solved ? "true" : "false");
    line.more = more;
    line.settings = "60 s at most";
    bench::print(line);
  }
}
