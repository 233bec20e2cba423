#include "optim/set_cover/set_cover_branching.hpp"

#include <pthread.h>

#include <CbcEventHandler.hpp>
#include <CbcModel.hpp>
#include <CbcSolver.hpp>
#include <ClpEventHandler.hpp>
#include <ClpSimplex.hpp>
#include <OsiClpSolverInterface.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <mutex>
#include <new>
#include <thread>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "optim/set_cover/set_cover_prices.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kNodesWithoutCuts = 800;

/// CBC's command-line layer keeps process-wide state: one run at a time. A child that is forked during a run has no
/// thread that would end it, so it begins with a mutex of its own.
std::mutex& cbc_mutex() {
  static std::mutex* mutex = [] {
    ::pthread_atfork(nullptr, nullptr, [] { new (&cbc_mutex()) std::mutex; });
    return new std::mutex;
  }();
  return *mutex;
}

bool covers(const SetCoverProblem& problem, const std::vector<int>& sets) {
  std::vector<bool> covered(problem.elements, false);
  for (int s : sets) {
    for (int e : problem.sets[s]) covered[e] = true;
  }
  return std::all_of(covered.begin(), covered.end(), [](bool c) { return c; });
}

/// Whole-numbered costs allow rounding the bound up.
double safe_bound(double bound, const std::vector<double>& costs) {
  if (!std::isfinite(bound) || bound < 0) return 0;
  const double lowered = bound - 1e-6 * std::max(1.0, std::abs(bound));
  return std::max(0.0, all_integral(costs) ? std::ceil(lowered) : lowered);
}

/// What Ctrl-C calls, kept as it was: CBC puts a handler of its own in place while it prepares a problem, which
/// swallows the signal.
class InterruptHandler {
 public:
  InterruptHandler() { sigaction(SIGINT, nullptr, &own_); }
  void restore() const {
    struct sigaction now {};
    if (sigaction(SIGINT, nullptr, &now) == 0 && now.sa_handler != own_.sa_handler) sigaction(SIGINT, &own_, nullptr);
  }

 private:
  struct sigaction own_ {};
};

/// Ends CBC's search at its next event once the monitor says so, and reports how much of its time is over.
class StopAtEvents : public CbcEventHandler {
 public:
  StopAtEvents(const Monitor& monitor, double time_limit) : monitor_(&monitor), time_limit_(time_limit) {}
  CbcAction event(CbcEvent) override {
    interrupts_.restore();
    monitor_->report("set cover", std::min(1.0, watch_.seconds() / time_limit_));
    return monitor_->stopped() ? stop : noAction;
  }
  CbcEventHandler* clone() const override { return new StopAtEvents(*this); }

 private:
  const Monitor* monitor_;
  double time_limit_;
  Stopwatch watch_;
  InterruptHandler interrupts_;
};

/// The same within one linear programme.
class StopAtIterations : public ClpEventHandler {
 public:
  explicit StopAtIterations(const Monitor& monitor) : monitor_(&monitor) {}
  int event(Event) override {
    interrupts_.restore();
    return monitor_->stopped() ? 5 : -1;  // 5: stopped by an event; -1: go on
  }
  ClpEventHandler* clone() const override { return new StopAtIterations(*this); }

 private:
  const Monitor* monitor_;
  InterruptHandler interrupts_;
};

void load(const SetCoverProblem& problem, OsiClpSolverInterface& solver) {
  const int columns = static_cast<int>(problem.sets.size());
  std::vector<int> starts{0}, rows;
  for (const auto& set : problem.sets) {
    rows.insert(rows.end(), set.begin(), set.end());
    starts.push_back(static_cast<int>(rows.size()));
  }
  const std::size_t elements = problem.elements;
  const std::vector<double> ones(rows.size(), 1.0), lower(problem.sets.size(), 0.0), upper(problem.sets.size(), 1.0);
  const std::vector<double> row_lower(elements, 1.0);
  // No row bound from above is needed; the number of columns is never reached in vain and spares CBC an infinity.
  const std::vector<double> row_upper(elements, static_cast<double>(columns));
  solver.setHintParam(OsiDoReducePrint, true, OsiHintTry);
  solver.messageHandler()->setLogLevel(0);
  solver.loadProblem(columns, problem.elements, starts.data(), rows.data(), ones.data(), lower.data(), upper.data(),
                     problem.costs.data(), row_lower.data(), row_upper.data());
  for (int c = 0; c < columns; ++c) solver.setInteger(c);
}

int no_callback(CbcModel*, int) {
  return 0;
}

BranchAndBoundAnswer run_cbc(const SetCoverProblem& problem, double known_cost, bool with_cuts, int max_nodes,
                             double time_limit, const Monitor& monitor) {
  OsiClpSolverInterface solver;
  load(problem, solver);
  StopAtIterations stop_at_iterations(monitor);
  solver.getModelPtr()->passInEventHandler(&stop_at_iterations);
  CbcModel model(solver);
  CbcSolverUsefulData data;
  CbcMain0(model, data);
  StopAtEvents stop_at_events(monitor, time_limit);
  model.passInEventHandler(&stop_at_events);
  model.setLogLevel(0);
  model.setAllowableGap(0.0);
  model.setAllowableFractionGap(0.0);
  model.setMaximumSeconds(time_limit);
  if (max_nodes >= 0) model.setMaximumNodes(max_nodes);
  std::vector<const char*> words = {"mmgrasp", "-log", "0", "-threads", "0", "-timeMode", "elapsed"};
  if (!all_integral(problem.costs)) words.insert(words.end(), {"-increment", "1e-9"});
  if (!with_cuts) {
    words.insert(words.end(), {"-cutsOnOff", "off", "-heuristicsOnOff", "off"});
    if (all_integral(problem.costs)) model.setCutoff(known_cost - 0.5);
  }
  words.insert(words.end(), {"-solve", "-quit"});
  CbcMain1(static_cast<int>(words.size()), words.data(), model, no_callback, data);

  BranchAndBoundAnswer answer;
  if (monitor.stopped()) return answer;  // what an LP that was broken off says is no proof
  answer.lower_bound = safe_bound(model.getBestPossibleObjValue(), problem.costs);
  if (const double* solution = model.bestSolution()) {
    std::vector<int> chosen;
    for (int c = 0; c < static_cast<int>(problem.sets.size()); ++c) {
      if (solution[c] > 0.5) chosen.push_back(c);
    }
    if (covers(problem, chosen)) answer.chosen = std::move(chosen);
  }
  answer.proven = model.isProvenOptimal() && answer.chosen.has_value();
  answer.none_cheaper = model.isProvenInfeasible();
  return answer;
}

}  // namespace

BranchAndBoundAnswer branch_and_bound(const SetCoverProblem& problem, double known_cost, double time_limit,
                                      const Monitor& monitor) {
  const TimeLimit limit(time_limit);
  std::unique_lock lock(cbc_mutex(), std::defer_lock);
  while (!lock.try_lock()) {
    if (limit.expired() || monitor.stopped()) return {};
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  // Cutting planes decide sparse problems such as floors full of trays and only cost time on dense ones: nodes are
  // cheap without them, so some are tried first.
  BranchAndBoundAnswer answer = run_cbc(problem, known_cost, false, kNodesWithoutCuts, limit.seconds_left(), monitor);
  const double left = limit.seconds_left();
  if (answer.proven || answer.none_cheaper || left <= 0 || monitor.stopped()) return answer;
  BranchAndBoundAnswer second = run_cbc(problem, known_cost, true, -1, left, monitor);
  second.lower_bound = std::max(second.lower_bound, answer.lower_bound);
  if (!second.chosen) second.chosen = answer.chosen;
  return second;
}

}  // namespace mmgrasp::detail
