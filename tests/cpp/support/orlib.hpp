#pragma once

#include <cstddef>
#include <istream>

#include "mmgrasp/optim/set_cover.hpp"

namespace mmgrasp::test {

/// OR-Library's layout of set covering problems: rows (elements), columns (sets), the costs, then for each row how many
/// columns cover it and which, counted from one.
inline SetCoverProblem read_orlib(std::istream& in) {
  SetCoverProblem problem;
  int sets = 0;
  in >> problem.elements >> sets;
  problem.sets.resize(sets);
  problem.costs.resize(sets);
  for (double& cost : problem.costs) in >> cost;
  for (int e = 0; e < problem.elements; ++e) {
    int count = 0;
    in >> count;
    for (int k = 0; k < count; ++k) {
      int set = 0;
      in >> set;
      problem.sets.at(set - 1).push_back(e);
    }
  }
  return problem;
}

}  // namespace mmgrasp::test
