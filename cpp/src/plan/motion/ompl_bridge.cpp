#include "plan/motion/ompl_bridge.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "mmgrasp/core/error.hpp"
#include "plan/ompl_plugin/plugin_api.hpp"

namespace mmgrasp::detail {
namespace {

constexpr const char* kPluginFile = "libmmgrasp_ompl.so";

/// An address inside this library, with which the loader tells the library's folder.
const char kAddressInLibrary = 0;

std::vector<std::filesystem::path> plugin_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("MMGRASP_PLUGIN_DIR")) folders.emplace_back(folder);
  Dl_info info{};
  if (dladdr(&kAddressInLibrary, &info) != 0 && info.dli_fname) {
    std::error_code error;
    const auto library = std::filesystem::weakly_canonical(info.dli_fname, error);
    if (!error) {
      folders.push_back(library.parent_path());
      folders.push_back(library.parent_path().parent_path() / "lib");
    }
  }
  return folders;
}

int open_flags() {
  int flags = RTLD_NOW | RTLD_LOCAL;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // The plugin must find its own Eigen symbols, not the ones KDL or PCL brought. Sanitizers refuse the flag.
  flags |= RTLD_DEEPBIND;
#endif
  return flags;
}

const MmgraspOmplApi* open_plugin() {
  std::string tried;
  for (const auto& folder : plugin_folders()) {
    const std::filesystem::path file = folder / kPluginFile;
    void* handle = dlopen(file.c_str(), open_flags());
    if (!handle) {
      tried += std::string(tried.empty() ? "" : "; ") + dlerror();
      continue;
    }
    const auto api = reinterpret_cast<const MmgraspOmplApi* (*)()>(dlsym(handle, kMmgraspOmplApiSymbol));
    if (api && api()->version == kMmgraspOmplApiVersion) return api();
    tried += std::string(tried.empty() ? "" : "; ") + file.string() + ": is of another version";
    dlclose(handle);
  }
  throw IoError(std::string(kPluginFile) + ": the planner plugin cannot be opened (" + tried + ")");
}

/// Opened once, never closed: OMPL's globals live until the process ends.
const MmgraspOmplApi& plugin() {
  static const MmgraspOmplApi* const api = open_plugin();
  return *api;
}

/// The plugin's callbacks get this as `user`. Exceptions must not cross the boundary: the first one is kept and ends
/// the run.
struct Session {
  const PlannerQuery& query;
  PlannerAnswer answer;
  std::string failure;
  std::exception_ptr thrown;
  Eigen::VectorXd a, b;

  explicit Session(const PlannerQuery& q) : query(q), a(q.start.size()), b(q.start.size()) {}
  void load(const double* coordinates, Eigen::VectorXd& to) {
    query.metric.from_coordinates(coordinates, to.data(), static_cast<int>(to.size()));
  }

  template <typename Function>
  int guarded(const Function& function) {
    if (thrown) return 0;
    try {
      return function() ? 1 : 0;
    } catch (...) {
      thrown = std::current_exception();
      return 0;
    }
  }
};

Session& session(void* user) {
  return *static_cast<Session*>(user);
}

int is_free(void* user, const double* q) {
  Session& s = session(user);
  s.load(q, s.a);
  return s.guarded([&] { return s.query.is_free(s.a); });
}

int edge_is_free(void* user, const double* q0, const double* q1) {
  Session& s = session(user);
  s.load(q0, s.a);
  s.load(q1, s.b);
  return s.guarded([&] { return s.query.edge_is_free(s.a, s.b); });
}

int stopped(void* user) {
  Session& s = session(user);
  return s.thrown || s.query.stopped() ? 1 : 0;
}

void waypoint(void* user, const double* q) {
  Session& s = session(user);
  s.load(q, s.a);
  s.answer.waypoints.push_back(s.a);
}

void on_improvement(void* user, int count, const double* path) {
  Session& s = session(user);
  s.guarded([&] {
    std::vector<Eigen::VectorXd> waypoints;
    for (int i = 0; i < count; ++i) {
      s.load(path + i * s.a.size(), s.a);
      waypoints.push_back(s.a);
    }
    s.query.on_improvement(waypoints);
    return true;
  });
}

void fail(void* user, const char* message) {
  session(user).failure = message;
}

/// Values one after the other, times the weights of their joints.
std::vector<double> weighted(const JointMetric& metric, const std::vector<Eigen::VectorXd>& rows) {
  std::vector<double> flat;
  for (const auto& row : rows)
    for (Eigen::Index i = 0; i < row.size(); ++i) flat.push_back(metric.weight(static_cast<int>(i)) * row[i]);
  return flat;
}

}  // namespace

std::vector<OmplPlanner> ompl_planners() {
  std::vector<OmplPlanner> planners;
  for (int i = 0; i < plugin().planner_count; ++i)
    planners.push_back({plugin().planner_name(i), plugin().planner_keeps_improving(i) != 0});
  return planners;
}

PlannerAnswer solve_with_ompl(const PlannerQuery& query) {
  Session session(query);
  const JointMetric& metric = query.metric;
  const std::vector<double> goals = weighted(metric, query.goals), start = weighted(metric, {query.start}),
                            lower = weighted(metric, {query.lower}), upper = weighted(metric, {query.upper});
  std::vector<double> turns(start.size(), 0.0);
  for (const int i : metric.wrapping()) turns[static_cast<std::size_t>(i)] = metric.turn(i);
  MmgraspOmplProblem problem{};
  problem.planner = query.planner.c_str();
  problem.size = static_cast<int>(query.start.size());
  problem.lower = lower.data();
  problem.upper = upper.data();
  problem.turns = turns.data();
  problem.start = start.data();
  problem.goal_count = static_cast<int>(query.goals.size());
  problem.goals = goals.data();
  problem.range = query.range;
  problem.near_end_probability = query.near_end_probability;
  problem.seed = query.seed;
  problem.max_iterations = query.max_iterations;
  problem.time_limit = query.time_limit;
  problem.user = &session;
  problem.is_free = is_free;
  problem.edge_is_free = edge_is_free;
  problem.stopped = stopped;
  problem.waypoint = waypoint;
  problem.on_improvement = query.on_improvement ? on_improvement : nullptr;
  problem.fail = fail;
  const int status = plugin().solve(&problem);
  if (session.thrown) std::rethrow_exception(session.thrown);
  if (status == MMGRASP_OMPL_FAILED) throw Error("planner " + query.planner + ": " + session.failure);
  session.answer.solved = status == MMGRASP_OMPL_SOLVED;
  session.answer.exhausted = status == MMGRASP_OMPL_EXHAUSTED;
  return std::move(session.answer);
}

}  // namespace mmgrasp::detail
