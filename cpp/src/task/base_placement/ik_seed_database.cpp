// IkSeedDatabase: past solutions that seed the next searches.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>

#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/hash.hpp"
#include "mmgrasp/task/platform_locations.hpp"

namespace mmgrasp {
namespace {

constexpr const char* kMagic = "mmgrasp IK seeds 1";

/// What a file must agree on: robot, joints and tip.
std::string key_of(const JointGroup& group) {
  Hasher hasher;
  hasher.add(group.robot().hash());
  for (const std::string& name : group.names()) hasher.add(name);
  hasher.add(group.robot().links()[group.tip_link()].name);
  return hasher.hex();
}

[[noreturn]] void damaged(const std::string& path, const std::string& what) {
  throw IoError(path + ": " + what);
}

}  // namespace

IkSeedDatabase::IkSeedDatabase(const JointGroup& group, int capacity) : group_(group), capacity_(capacity) {
  require(capacity > 0, "seed database capacity", capacity, "must be positive");
  if (!group.has_base())
    throw InvalidInput("group \"" + group.name() + "\": a seed database is for groups with base joints");
}

void IkSeedDatabase::add(const Eigen::VectorXd& q) {
  group_.check_configuration(q, "q");
  const std::lock_guard<std::mutex> lock(*mutex_);
  if (static_cast<int>(entries_.size()) == capacity_) entries_.pop_front();
  Eigen::VectorXd at_origin = q;
  at_origin.head<3>().setZero();
  entries_.push_back({group_.fk(at_origin), q.tail(q.size() - 3)});
}

std::vector<Eigen::VectorXd> IkSeedDatabase::seeds(const Pose& T_world_tip, int count) const {
  constexpr double kMetresPerRadian = 0.3;
  struct Match {
    double score;
    std::size_t entry;
    double yaw;
  };
  const std::lock_guard<std::mutex> lock(*mutex_);
  std::vector<Match> matches;
  matches.reserve(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Pose& T_root_tip = entries_[i].T_root_tip;
    // The turn about the vertical that leaves the least rotation: it maximises the trace.
    const Eigen::Matrix3d A = T_world_tip.linear() * T_root_tip.linear().transpose();
    const double yaw = std::atan2(A(1, 0) - A(0, 1), A(0, 0) + A(1, 1));
    const double trace = std::hypot(A(1, 0) - A(0, 1), A(0, 0) + A(1, 1)) + A(2, 2);
    const double tilt = std::acos(std::min(1.0, std::max(-1.0, 0.5 * (trace - 1))));
    const double height = std::abs(T_world_tip.translation().z() - T_root_tip.translation().z());
    matches.push_back({height + kMetresPerRadian * tilt, i, yaw});
  }
  const std::size_t kept = std::min(matches.size(), static_cast<std::size_t>(std::max(count, 0)));
  std::partial_sort(matches.begin(), matches.begin() + static_cast<long>(kept), matches.end(),
                    [](const Match& a, const Match& b) {
                      return a.score != b.score ? a.score < b.score : a.entry > b.entry;  // the newer of equals
                    });
  std::vector<Eigen::VectorXd> found;
  for (std::size_t i = 0; i < kept; ++i) {
    const Entry& entry = entries_[matches[i].entry];
    const Eigen::Vector2d reach = Eigen::Rotation2Dd(matches[i].yaw) * entry.T_root_tip.translation().head<2>();
    Eigen::VectorXd q(group_.size());
    q << T_world_tip.translation().head<2>() - reach, matches[i].yaw, entry.q;
    found.push_back(q.cwiseMax(group_.lower()).cwiseMin(group_.upper()));
  }
  return found;
}

std::size_t IkSeedDatabase::size() const {
  const std::lock_guard<std::mutex> lock(*mutex_);
  return entries_.size();
}

std::string IkSeedDatabase::body() const {
  const std::lock_guard<std::mutex> lock(*mutex_);
  std::ostringstream text;
  text << kMagic << '\n' << key_of(group_) << '\n' << entries_.size() << ' ' << group_.size() - 3 << '\n';
  text << std::setprecision(17);
  for (const Entry& entry : entries_) {
    for (Eigen::Index i = 0; i < entry.q.size(); ++i) text << (i ? " " : "") << entry.q[i];
    text << '\n';
  }
  return text.str();
}

void IkSeedDatabase::save(const std::string& path) const {
  const std::string text = body();
  detail::write_file(path, "IK seeds", {text, Hasher().add(text).hex(), "\n"});
}

IkSeedDatabase IkSeedDatabase::load(const std::string& path, const JointGroup& group, int capacity) {
  IkSeedDatabase database(group, capacity);
  const std::string text = detail::file_content(path, "IK seeds");
  if (text.rfind(std::string(kMagic) + "\n", 0) != 0) damaged(path, "is no file of IK seeds of this version");
  if (text.size() < 18 || text.back() != '\n') damaged(path, "is cut off");
  const std::string body = text.substr(0, text.size() - 17), checksum = text.substr(text.size() - 17, 16);
  if (Hasher().add(body).hex() != checksum) damaged(path, "is damaged: its checksum does not match");
  std::istringstream lines(body.substr(std::string(kMagic).size() + 1));
  std::string key;
  std::size_t count = 0;
  Eigen::Index joints = 0;
  lines >> key >> count >> joints;
  if (key != key_of(group))
    damaged(path, "was made for another robot, other joints or another tip than group \"" + group.name() + "\"");
  Eigen::VectorXd q = Eigen::VectorXd::Zero(group.size());
  if (joints != q.size() - 3) damaged(path, "holds postures of another length");
  for (std::size_t i = 0; i < count; ++i) {
    for (Eigen::Index j = 3; j < q.size(); ++j)
      if (!(lines >> q[j])) damaged(path, "posture " + std::to_string(i) + " is incomplete");
    database.add(q);
  }
  return database;
}

}  // namespace mmgrasp
