#include "verify/base/smallest_cover.hpp"

#include <CbcEventHandler.hpp>
#include <CbcModel.hpp>
#include <CoinPackedMatrix.hpp>
#include <OsiClpSolverInterface.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr int kMaxNodes = 5000;  // Most nodes of branch and bound, so that the answer does not depend on a clock.

/// Ends the search at its next event once the check is to end.
class StopAtEvents : public CbcEventHandler {
 public:
  CbcAction event(CbcEvent) override {
    const CancelToken* const token = mmgrasp::detail::interruption_token();
    return token && token->stopped() ? stop : noAction;
  }
  CbcEventHandler* clone() const override { return new StopAtEvents(*this); }
};

bool holds(const RegionSet& outer, const RegionSet& inner) {
  return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end());
}

/// What the sets hold of `wanted`: sets that differ in other regions only are one column of the problem.
std::vector<RegionSet> reduced(const std::vector<RegionSet>& sets, const RegionSet& wanted) {
  std::set<RegionSet> different;
  for (const RegionSet& set : sets) {
    RegionSet part;
    std::set_intersection(set.begin(), set.end(), wanted.begin(), wanted.end(), std::inserter(part, part.end()));
    different.insert(std::move(part));
  }
  std::vector<RegionSet> maximal;
  for (const RegionSet& set : different) add_maximal(maximal, set);
  return maximal;
}

}  // namespace

void add_maximal(std::vector<RegionSet>& sets, const RegionSet& set) {
  if (std::any_of(sets.begin(), sets.end(), [&](const RegionSet& other) { return holds(other, set); })) return;
  sets.erase(std::remove_if(sets.begin(), sets.end(), [&](const RegionSet& other) { return holds(set, other); }),
             sets.end());
  sets.push_back(set);
}

CoverBounds smallest_cover(const std::vector<RegionSet>& sets, const RegionSet& wanted) {
  if (wanted.empty()) return {0, 0};
  const std::vector<RegionSet> choices = reduced(sets, wanted);
  const int columns = static_cast<int>(choices.size());
  CoinPackedMatrix matrix(false, 0, 0);
  matrix.setDimensions(0, columns);
  std::vector<double> row_lower, row_upper;
  for (const int region : wanted) {
    CoinPackedVector row;
    for (int column = 0; column < columns; ++column) {
      if (choices[column].count(region)) row.insert(column, 1.0);
    }
    if (row.getNumElements() == 0) return {};
    matrix.appendRow(row);
    row_lower.push_back(1.0);
    row_upper.push_back(COIN_DBL_MAX);
  }
  const std::vector<double> lower(columns, 0.0), upper(columns, 1.0), cost(columns, 1.0);
  OsiClpSolverInterface solver;
  solver.messageHandler()->setLogLevel(0);
  solver.loadProblem(matrix, lower.data(), upper.data(), cost.data(), row_lower.data(), row_upper.data());
  for (int column = 0; column < columns; ++column) solver.setInteger(column);
  CbcModel model(solver);
  model.setLogLevel(0);
  model.setMaximumNodes(kMaxNodes);
  const StopAtEvents stop_at_events;
  model.passInEventHandler(&stop_at_events);
  model.branchAndBound();
  mmgrasp::detail::throw_if_interrupted();
  const int wanted_sets = static_cast<int>(wanted.size());  // one of its own for each is always enough
  const bool found = model.bestSolution() != nullptr;
  const int most = found ? static_cast<int>(std::lround(model.getObjValue())) : wanted_sets;
  if (model.isProvenOptimal()) return {most, most};
  const int least = static_cast<int>(std::ceil(model.getBestPossibleObjValue() - 1e-6));
  return {std::clamp(least, 1, most), most};
}

}  // namespace mmgrasp::verify::detail
