#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "bindings.hpp"
#include "mmgrasp/collision/disabled_pairs.hpp"

namespace mmgrasp::python {
namespace {

const std::vector<OptionField<DisabledPairsOptions>>& pair_fields() {
  using O = DisabledPairsOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("samples", &O::samples, "random configurations"),
      option<O>("always_fraction", &O::always_fraction, "a pair in collision at least this often is called always"),
      option<O>("trust_samples", &O::trust_samples, "call pairs that touch in no sample never, without a proof"),
      option<O>("seed", &O::seed, "same seed, same pairs"), option<O>("threads", &O::threads, "0: all")};
  return fields;
}

std::filesystem::path cache_folder() {
  // The XDG base directory specification: paths that are not absolute are to be ignored.
  const char *folder = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
  if (folder && *folder == '/') return std::filesystem::path(folder) / "mmgrasp";
  if (home && *home == '/') return std::filesystem::path(home) / ".cache" / "mmgrasp";
  std::error_code error;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  return (error ? std::filesystem::path("/tmp") : temporary) / "mmgrasp-cache";
}

/// Pairs by link names, one "a<tab>b<tab>reason" a line; the reason as a number. Empty when the file is absent or
/// foreign.
std::map<std::pair<int, int>, DisabledReason> read_pairs(const std::filesystem::path& file, const Robot& robot) {
  std::map<std::pair<int, int>, DisabledReason> pairs;
  std::ifstream in(file);
  std::string header, a, b, reason;
  if (!std::getline(in, header) || header != "mmgrasp-pairs 1 " + robot.hash()) return pairs;
  while (std::getline(in, a, '\t') && std::getline(in, b, '\t') && std::getline(in, reason)) {
    if (a == "end") return pairs;
    if (!robot.has_link(a) || !robot.has_link(b) || reason.size() != 1 || reason[0] < '0' || reason[0] > '4') break;
    const int i = robot.link_index(a), j = robot.link_index(b);
    pairs[{std::min(i, j), std::max(i, j)}] = static_cast<DisabledReason>(reason[0] - '0');
  }
  return {};
}

void write_pairs(const std::filesystem::path& file, const Robot& before, const Robot& after) {
  std::error_code ignored;  // a cache that cannot be written costs time only
  std::filesystem::create_directories(file.parent_path(), ignored);
  const std::filesystem::path draft = file.string() + "." + std::to_string(::getpid()) + ".tmp";
  {
    std::ofstream out(draft);
    out << "mmgrasp-pairs 1 " << before.hash() << "\n";
    for (const auto& [pair, reason] : after.disabled_pairs()) {
      out << after.links()[pair.first].name << "\t" << after.links()[pair.second].name << "\t"
          << static_cast<int>(reason) << "\n";
    }
    out << "end\tend\t0\n";
    out.close();
    if (!out) {
      std::filesystem::remove(draft, ignored);
      return;
    }
  }
  std::filesystem::rename(draft, file, ignored);
}

Robot sampled(const Robot& robot, const Progress& progress) {
  LongCall call(progress);  // first: a wrong argument is told even when nothing is left to do
  const std::filesystem::path file = cache_folder() / ("proven-pairs-" + robot.hash() + ".txt");
  if (auto pairs = read_pairs(file, robot); !pairs.empty()) return robot.with_disabled_pairs(std::move(pairs));
  Robot out = call.run([&](const Monitor& monitor) { return compute_disabled_pairs(robot, {}, monitor); });
  write_pairs(file, robot, out);
  return out;
}

bool knows_more_than_adjacent(const Robot& robot) {
  for (const auto& [pair, reason] : robot.disabled_pairs()) {
    if (reason != DisabledReason::adjacent) return true;
  }
  return false;
}

int links_with_shapes(const Robot& robot) {
  int count = 0;
  for (const Link& link : robot.links()) count += !link.collisions.empty();
  return count;
}

/// The group again on a robot that differs in its pairs only.
JointGroup rebuilt(const JointGroup& group, const Robot& robot) {
  const std::string tip = robot.links()[group.tip_link()].name;
  const int first = group.joints()[group.has_base() ? 3 : 0];
  const std::string base = robot.links()[robot.joints()[first].parent_link].name;
  const bool named = [&] {
    for (const GroupDescription& description : robot.groups()) {
      if (description.name == group.name()) return true;
    }
    return false;
  }();
  JointGroup out = named ? robot.group(group.name(), tip, group.has_base()) : robot.chain(base, tip, group.has_base());
  out = out.with_reference(group.reference()).with_acceleration_limits(group.acceleration_limits());
  return group.has_base() ? out : out.at(group.T_world_root());
}

}  // namespace

JointGroup with_sampled_pairs(const JointGroup& group) {
  const Robot& robot = group.robot();
  if (knows_more_than_adjacent(robot) || links_with_shapes(robot) < 3) return group;
  // One process asks for the same few robots again and again.
  static std::map<std::string, Robot> known;
  const std::string key = robot.hash();
  auto found = known.find(key);
  if (found == known.end()) {
    if (known.size() >= 16) known.clear();
    found = known.emplace(key, sampled(robot, py::none())).first;
  }
  return rebuilt(group, found->second);
}

void bind_disabled_pairs(py::module_& m) {
  m.def(
      "compute_disabled_pairs",
      [](const Robot& robot, const Progress& progress, const py::kwargs& options) {
        const DisabledPairsOptions read = read_options(pair_fields(), options, "compute_disabled_pairs");
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return compute_disabled_pairs(robot, read, monitor); });
      },
      py::arg("robot"), py::kw_only(), py::arg("progress") = py::none(),
      ("The robot with the link pairs that always or never touch found by sampling; those of an SRDF are kept." +
       option_help(pair_fields()))
          .c_str());
  m.def("with_sampled_pairs", &sampled, py::arg("robot"), py::kw_only(), py::arg("progress") = py::none(),
        "compute_disabled_pairs with default options, its result cached on disk under the robot's hash.");
  m.def(
      "cache_folder", [] { return py::reinterpret_steal<py::str>(PyUnicode_DecodeFSDefault(cache_folder().c_str())); },
      "$XDG_CACHE_HOME/mmgrasp, or ~/.cache/mmgrasp.");
}

}  // namespace mmgrasp::python
