#include "reach/database/reach_meta.hpp"

#include <algorithm>
#include <cstdio>

#include "mmgrasp/core/detail/crc32.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/json_value.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

constexpr const char* kSumMember = "\"crc32\"";

/// The end of the text.
std::string sum_line(std::uint32_t sum) {
  return kSumMember + (": " + std::to_string(sum)) + "\n}\n";
}

template <class Values, class Print>
std::string listed(const Values& values, const Print& print) {
  std::string out;
  for (const auto& value : values) out += (out.empty() ? "" : ", ") + print(value);
  return "[" + out + "]";
}
std::string listed(const std::vector<double>& values) {
  return listed(values, json_number);
}
std::string listed(const std::vector<std::string>& values) {
  return listed(values, json_quoted);
}
std::string listed(const Eigen::Vector3d& v) {
  return listed(std::vector<double>(v.data(), v.data() + 3));
}

std::uint64_t count_of(const JsonValue& value, std::uint64_t most, const std::string& path, const std::string& member) {
  const std::int64_t count = value.integer();
  if (count < 0 || static_cast<std::uint64_t>(count) > most)
    throw IoError(path + ": corrupt: impossible " + member + " " + std::to_string(count));
  return static_cast<std::uint64_t>(count);
}

void read_arm(const JsonValue& meta, StoredArm& arm) {
  arm.robot = meta.at("robot").string();
  arm.robot_hash = meta.at("robot_hash").string();
  arm.group = meta.at("group").string();
  arm.tip = meta.at("tip").string();
  arm.joints = meta.at("joints").strings();
  arm.lower = meta.at("joint_lower").numbers();
  arm.step = meta.at("joint_step").numbers();
  arm.other_joints = meta.at("other_joints").strings();
  arm.other_values = meta.at("other_values").numbers();
  for (const JsonValue& row : meta.at("chain").array()) {
    const std::vector<double> numbers = row.numbers();
    if (numbers.size() != StoredArm::kRow) {
      arm.chain.clear();  // what is left is not sound
      arm.chain.push_back(0);
      return;
    }
    arm.chain.insert(arm.chain.end(), numbers.begin(), numbers.end());
  }
  arm.root = meta.at("root").numbers();
  arm.tip_pose = meta.at("tip_pose").numbers();
}

void read_options(const JsonValue& options, ReachOptions& out, const std::string& path) {
  out.samples = options.at("samples").integer();
  out.position_cell = options.at("position_cell").number();
  out.rotation_cell = options.at("rotation_cell").number();
  out.max_per_cell = static_cast<int>(count_of(options.at("max_per_cell"), 0x7fffffff, path, "max_per_cell"));
  out.min_manipulability = options.at("min_manipulability").number();
  out.thinning = options.at("thinning").number();
  out.seed = static_cast<unsigned>(count_of(options.at("seed"), 0xffffffffu, path, "seed"));
  try {
    out.check();
  } catch (const InvalidInput& invalid) {
    throw IoError(path + ": corrupt: " + invalid.what());
  }
}

}  // namespace

std::array<NpyLayout, kArrayCount> array_layouts(std::uint64_t positions, std::uint64_t cells, std::uint64_t size,
                                                 std::uint64_t joints) {
  return {NpyLayout{"<i4", 4, {positions, 3}}, NpyLayout{"<u4", 4, {positions + 1}}, NpyLayout{"<u4", 4, {cells}},
          NpyLayout{"<u4", 4, {cells + 1}}, NpyLayout{"<u2", 2, {size, joints}}};
}

std::string meta_text(const ReachDatabase::Data& data, const FileChecksums& checksums) {
  const StoredArm& arm = data.arm;
  std::string text = "{\n";
  const auto member = [&](const std::string& name, const std::string& value) {
    text += json_quoted(name) + ": " + value + ",\n";
  };
  member("name", json_quoted(kReachName));
  member("version", std::to_string(kReachFormat));
  member("key", json_quoted(data.key));
  member("robot", json_quoted(arm.robot));
  member("robot_hash", json_quoted(arm.robot_hash));
  member("group", json_quoted(arm.group));
  member("tip", json_quoted(arm.tip));
  member("joints", listed(arm.joints));
  member("joint_lower", listed(arm.lower));
  member("joint_step", listed(arm.step));
  member("other_joints", listed(arm.other_joints));
  member("other_values", listed(arm.other_values));
  std::string rows;
  for (std::size_t i = 0; i < arm.chain.size(); i += StoredArm::kRow)
    rows += (i > 0 ? ", " : "") +
            listed(std::vector<double>(arm.chain.begin() + static_cast<std::ptrdiff_t>(i),
                                       arm.chain.begin() + static_cast<std::ptrdiff_t>(i + StoredArm::kRow)));
  member("chain", "[" + rows + "]");
  member("root", listed(arm.root));
  member("tip_pose", listed(arm.tip_pose));
  const ReachOptions& options = data.options;
  member("options", "{\"samples\": " + std::to_string(options.samples) +
                        ", \"position_cell\": " + json_number(options.position_cell) +
                        ", \"rotation_cell\": " + json_number(options.rotation_cell) +
                        ", \"max_per_cell\": " + std::to_string(options.max_per_cell) + ", \"min_manipulability\": " +
                        json_number(options.min_manipulability) + ", \"thinning\": " + json_number(options.thinning) +
                        ", \"seed\": " + std::to_string(options.seed) + "}");
  member("position_cells", std::to_string(data.position_count()));
  member("cells", std::to_string(data.cell_count()));
  member("size", std::to_string(data.size()));
  member("reach", json_number(data.reach));
  const bool empty = data.bounds.isEmpty();
  member("bounds_lower", empty ? "[]" : listed(data.bounds.min()));
  member("bounds_upper", empty ? "[]" : listed(data.bounds.max()));
  member("chunk_bytes", std::to_string(kChecksumChunk));
  const auto layouts =
      array_layouts(data.position_count(), data.cell_count(), data.size(), static_cast<std::uint64_t>(data.joints));
  std::string files;
  for (int i = 0; i < kArrayCount; ++i) {
    const auto number = [](auto value) { return std::to_string(value); };
    files += std::string(i > 0 ? ",\n " : "") + json_quoted(kArrayFiles[i]) +
             ": {\"dtype\": " + json_quoted(layouts[i].dtype) + ", \"shape\": " + listed(layouts[i].shape, number) +
             ", \"crc32_of_chunks\": " + listed(checksums[i], number) + "}";
  }
  member("files", "{" + files + "}");
  return text + sum_line(crc32(text.data(), text.size()));
}

Meta read_meta(const std::string& path, ReachDatabase::Data& data) {
  const std::string text = file_content(path, "reachability database", kLargestText);
  if (text.find(kReachName) == std::string::npos) throw IoError(path + ": not of a reachability database");
  const std::size_t before = text.rfind(kSumMember);
  if (before == std::string::npos) throw IoError(path + ": truncated: it does not end with its checksum");
  const JsonValue meta = JsonValue::parse(text, path);
  // The version first: another one may be summed in another way.
  if (meta.at("name").string() != kReachName) throw IoError(path + ": not of a reachability database");
  const std::int64_t version = meta.at("version").integer();
  if (version != kReachFormat)
    throw IoError(path + ": format version " + std::to_string(version) + ", this library reads " +
                  std::to_string(kReachFormat) + "; build the database again");
  if (text.substr(before) != sum_line(crc32(text.data(), before)))
    throw IoError(path + ": corrupt: its checksum differs (was it edited?)");

  data.key = meta.at("key").string();
  read_arm(meta, data.arm);
  if (!data.arm.sound()) throw IoError(path + ": corrupt: joints and chain make no sense");
  data.arm.complete();
  data.joints = data.arm.size();
  read_options(meta.at("options"), data.options, path);
  Meta out;
  constexpr std::uint64_t kMaxCount = 0xfffffffe;
  out.positions = count_of(meta.at("position_cells"), kMaxCount, path, "position_cells");
  out.cells = count_of(meta.at("cells"), kMaxCount, path, "cells");
  out.size = count_of(meta.at("size"), kMaxCount, path, "size");
  data.reach = meta.at("reach").number();
  const std::vector<double> low = meta.at("bounds_lower").numbers(), high = meta.at("bounds_upper").numbers();
  data.bounds.setEmpty();
  if (low.size() == 3 && high.size() == 3)
    data.bounds = Eigen::AlignedBox3d(Eigen::Vector3d(low.data()), Eigen::Vector3d(high.data()));
  if (meta.at("chunk_bytes").integer() != static_cast<std::int64_t>(kChecksumChunk))
    throw IoError(path + ": corrupt: unknown chunk_bytes");
  const auto layouts = array_layouts(out.positions, out.cells, out.size, static_cast<std::uint64_t>(data.joints));
  for (int i = 0; i < kArrayCount; ++i) {
    const JsonValue& entry = meta.at("files").at(kArrayFiles[i]);
    std::vector<std::uint64_t> shape;
    for (const JsonValue& extent : entry.at("shape").array())
      shape.push_back(count_of(extent, std::uint64_t{1} << 40, path, "shape"));
    if (entry.at("dtype").string() != layouts[i].dtype || shape != layouts[i].shape)
      throw IoError(path + ": corrupt: type or shape of " + kArrayFiles[i] + " contradicts the counts");
    for (const JsonValue& sum : entry.at("crc32_of_chunks").array())
      out.checksums[i].push_back(static_cast<std::uint32_t>(count_of(sum, 0xffffffffu, path, "checksum")));
  }
  return out;
}

}  // namespace mmgrasp::detail
