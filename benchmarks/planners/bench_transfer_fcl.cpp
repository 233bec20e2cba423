// OMPL's RRT-Connect with FCL on problems of mbm_text.py's kind, one after the other until one is solved: a carry with
// a list of grasps as people plan it today. Prints one JSON line: processor time of the planning, what is loaded and
// set up apart.
//
//     bench_transfer_fcl <problems.txt> <seed> <seconds for each>

#include <cstdio>
#include <cstdlib>

#include "core/report.hpp"
#include "mbm_problem.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "ompl_baseline.hpp"

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  double seconds = 0;
  bool solved = false;
  for (const bench::MbmProblem& problem : bench::MbmReader(argv[1]).read()) {
    const bench::EdgeSteps steps{mmgrasp::motion_bounds(mmgrasp::CollisionChecker(problem.group, problem.world)), 0.02,
                                 0.005};
    bench::OmplBaseline baseline(problem.group, problem.world, steps);
    const double begin = bench::processor_seconds();
    // Range 0: OMPL's own choice.
    solved =
        baseline.solve(problem.start, problem.goals, 0, static_cast<unsigned>(std::atoi(argv[2])), std::atof(argv[3]))
            .solved;
    seconds += bench::processor_seconds() - begin;
    if (solved) break;
  }
  std::printf("{\"solved\": %s, \"seconds\": %.9g}\n", solved ? "true" : "false", seconds);
}
