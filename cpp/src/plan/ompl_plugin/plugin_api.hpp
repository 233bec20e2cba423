#pragma once

/// The boundary between libmmgrasp and the private plugin that links OMPL: plain C structs, doubles and function
/// pointers. Nothing of Eigen, OMPL or the standard library crosses it (docs/methods/plan.md says why they are kept
/// apart).

extern "C" {

enum MmgraspOmplStatus {
  MMGRASP_OMPL_SOLVED = 0,
  MMGRASP_OMPL_BUDGET_SPENT = 1,  ///< Iterations, the time limit or `stopped` ended the run without a path.
  MMGRASP_OMPL_EXHAUSTED = 2,     ///< The planner gave up by itself.
  MMGRASP_OMPL_FAILED = 3         ///< `fail` was called with a message.
};

/// One planning query. Configurations are rows of `size` doubles: joint values times their weights, in which lengths
/// are Euclidean. Values that wrap lie within half a turn of 0.
struct MmgraspOmplProblem {
  const char* planner;
  int size;
  const double* lower;
  const double* upper;
  const double* turns;  ///< A whole turn of each value that wraps; 0: it does not.
  const double* start;
  int goal_count;
  const double* goals;
  double range;                 ///< Longest tree edge; 0: the planner's own default.
  double near_end_probability;  ///< Chance that a roadmap's sample is drawn around the start or a goal.
  unsigned seed;
  int max_iterations;  ///< States drawn (or planner rounds, where rounds draw none).
  double time_limit;   ///< [s]

  void* user;  ///< First argument of every function below.
  int (*is_free)(void* user, const double* q);
  int (*edge_is_free)(void* user, const double* q0,
                      const double* q1);  ///< The shortest way round for values that wrap.
  int (*stopped)(void* user);
  void (*waypoint)(void* user, const double* q);  ///< Called for each waypoint of the path, in order.
  void (*on_improvement)(void* user, int count, const double* path);  ///< Rows of a shorter path; or null.
  void (*fail)(void* user, const char* message);
};

struct MmgraspOmplApi {
  int version;  ///< kMmgraspOmplApiVersion of the plugin.
  int planner_count;
  const char* (*planner_name)(int index);
  int (*planner_keeps_improving)(int index);        ///< Goes on after its first path until its budget is spent.
  int (*solve)(const MmgraspOmplProblem* problem);  ///< Returns a MmgraspOmplStatus; throws nothing.
};

/// The one symbol the plugin shows.
__attribute__((visibility("default"))) const MmgraspOmplApi* mmgrasp_ompl_api();

}  // extern "C"

constexpr int kMmgraspOmplApiVersion = 5;
constexpr const char* kMmgraspOmplApiSymbol = "mmgrasp_ompl_api";
