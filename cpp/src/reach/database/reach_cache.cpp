// ReachDatabase::load_or_build: databases kept by what they depend on.
#include <filesystem>
#include <system_error>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/hash.hpp"
#include "reach/database/reach_data.hpp"

namespace mmgrasp {

JointGroup detail::checked_arm(const JointGroup& arm) {
  require(!arm.has_base(), "arm", arm.name(), "must not have base joints: the database is relative to the base");
  require(arm.size() > 0, "arm", arm.name(), "must have at least one joint");
  return arm.at(Pose::Identity());
}

std::string ReachDatabase::cache_key(const JointGroup& arm, const ReachOptions& options) {
  const JointGroup at_root = detail::checked_arm(arm);
  Hasher hasher;
  hasher.add(detail::kReachFormat).add(at_root.robot().hash());
  hasher.add(at_root.size());
  for (const std::string& name : at_root.names()) hasher.add(name);
  hasher.add(at_root.robot().links()[at_root.tip_link()].name);
  // The arm's own reference values do not matter: they are replaced by every sample.
  hasher.add(Eigen::MatrixXd(at_root.full_values(Eigen::VectorXd::Zero(at_root.size()))));
  hasher.add(options.samples).add(options.position_cell).add(options.rotation_cell).add(options.max_per_cell);
  hasher.add(options.min_manipulability).add(options.thinning).add(options.seed);
  return hasher.hex();
}

ReachDatabase ReachDatabase::load_or_build(const JointGroup& arm, const ReachOptions& options,
                                           const std::string& cache_dir, const Monitor& monitor) {
  options.check();
  const std::string key = cache_key(arm, options);
  std::error_code error;
  std::filesystem::create_directories(cache_dir, error);
  if (!std::filesystem::is_directory(cache_dir))
    throw IoError(cache_dir + ": cannot make the cache folder" + (error ? ": " + error.message() : ""));
  const std::string path = (std::filesystem::path(cache_dir) / (key + ".reach")).string();
  Monitor building = monitor;
  if (std::filesystem::exists(path)) {
    try {
      ReachDatabase found = load(path);
      if (found.key() == key) {
        found.verify(monitor);
        return found;
      }
    } catch (const IoError&) {  // a damaged cache is worth nothing, and costs nothing: build again and replace it
      building.progress = [&monitor](const std::string&, double fraction) {
        monitor.report("replacing a damaged reachability database", fraction);
      };
    }
    detail::move_away(path);
  }
  // Only what takes long is worth leaving parts of when interrupted.
  constexpr std::int64_t kWorthParts = 16'000'000;
  if (options.samples >= kWorthParts) return build_to(path, arm, options, building);
  ReachDatabase built = build(arm, options, building);
  if (monitor.stopped()) return built;
  try {
    built.save(path);
  } catch (const IoError& error) {  // a full disk, say: what was built is not lost
    monitor.report(std::string("the reachability database is not kept: ") + error.what(), 1.0);
  }
  return built;
}

}  // namespace mmgrasp
