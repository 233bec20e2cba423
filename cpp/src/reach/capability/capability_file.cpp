// CapabilityMap::save and load: a folder of arrays with checksums.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "mmgrasp/core/detail/crc32.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/json_value.hpp"
#include "mmgrasp/core/detail/npy_file.hpp"
#include "mmgrasp/core/error.hpp"
#include "reach/capability/capability_data.hpp"
#include "reach/database/reach_data.hpp"
#include "reach/database/saved_folder.hpp"

namespace mmgrasp {
namespace {

namespace fs = std::filesystem;
using Data = CapabilityMap::Data;
using detail::NpyLayout;

constexpr const char* kName = "mmgrasp capability map";
constexpr const char* kSumMember = "\"crc32\"";

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw IoError(path + ": " + what);
}

struct ArrayFile {
  const char* name;
  NpyLayout layout;
};

/// The files beside meta.json. The last two are for readers: they follow from the others.
std::vector<ArrayFile> array_files(const Data& data, std::uint64_t reached) {
  const auto x = static_cast<std::uint64_t>(data.shape[0]), y = static_cast<std::uint64_t>(data.shape[1]),
             z = static_cast<std::uint64_t>(data.shape[2]), poses = data.tool_poses.size();
  return {{"classes.npy", {"|u1", 1, {x, y, z, poses}}},
          {"configurations.npy", {"<f4", 4, {reached, static_cast<std::uint64_t>(data.joints)}}},
          {"index.npy", {"<f4", 4, {x, y, z}}},
          {"tool_poses.npy", {"<f8", 8, {poses, 4, 4}}}};
}

std::vector<double> rows_of(const Poses& poses) {
  std::vector<double> values;
  for (const Pose& pose : poses)
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) values.push_back(pose.matrix()(row, column));
  return values;
}

template <class Values, class Print>
std::string listed(const Values& values, const Print& print) {
  std::string out;
  for (const auto& value : values) out += (out.empty() ? "" : ", ") + print(value);
  return "[" + out + "]";
}

std::string listed(const Eigen::Vector3d& v) {
  return listed(std::vector<double>(v.data(), v.data() + 3), detail::json_number);
}

std::string meta_text(const Data& data, std::uint64_t reached, const std::vector<std::vector<std::uint32_t>>& sums) {
  const CapabilityOptions& o = data.options;
  const auto number = [](auto value) { return std::to_string(value); };
  std::string text = "{\n\"name\": " + detail::json_quoted(kName) +
                     ",\n\"version\": " + number(detail::kCapabilityFormat) +
                     ",\n\"arm_key\": " + detail::json_quoted(data.arm_key) + ",\n\"joints\": " + number(data.joints) +
                     ",\n\"reached\": " + number(reached) + ",\n\"classes\": [\"reached\", \"reach\", \"limits\", " +
                     "\"self_collision\", \"scene\"],\n\"options\": {\"lower\": " + listed(o.lower) +
                     ", \"upper\": " + listed(o.upper) + ", \"voxel\": " + detail::json_number(o.voxel) +
                     ", \"poses\": " + number(o.poses) + ", \"rolls\": " + number(o.rolls) +
                     ", \"approach\": " + listed(o.approach) + ", \"samples\": " + number(o.samples) +
                     ", \"sweeps\": " + number(o.sweeps) + ", \"restarts\": " + number(o.restarts) +
                     ", \"padding\": " + detail::json_number(o.padding) + ", \"seed\": " + number(o.seed) + "},\n";
  const std::vector<ArrayFile> files = array_files(data, reached);
  text += "\"chunk_bytes\": " + number(detail::kChecksumChunk) + ",\n\"files\": {";
  for (std::size_t i = 0; i < files.size(); ++i)
    text += (i > 0 ? ",\n " : "") + detail::json_quoted(files[i].name) +
            ": {\"crc32_of_chunks\": " + listed(sums[i], number) + "}";
  text += "},\n";
  return text + kSumMember + ": " + number(detail::crc32(text.data(), text.size())) + "\n}\n";
}

detail::JsonValue read_meta(const std::string& path) {
  const std::string text = detail::file_content(path, "capability map", detail::kLargestText);
  if (text.find(kName) == std::string::npos) refuse(path, "not of a capability map");
  const std::size_t before = text.rfind(kSumMember);
  if (before == std::string::npos) refuse(path, "truncated: it does not end with its checksum");
  const detail::JsonValue meta = detail::JsonValue::parse(text, path);
  if (meta.at("name").string() != kName) refuse(path, "not of a capability map");
  if (meta.at("version").integer() != detail::kCapabilityFormat)
    refuse(path, "format version " + std::to_string(meta.at("version").integer()) + ", this library reads " +
                     std::to_string(detail::kCapabilityFormat));
  if (meta.at("crc32").integer() != static_cast<std::int64_t>(detail::crc32(text.data(), before)))
    refuse(path, "corrupt: its checksum differs (was it edited?)");
  return meta;
}

Eigen::Vector3d vector_of(const detail::JsonValue& value, const std::string& path) {
  const std::vector<double> numbers = value.numbers();
  if (numbers.size() != 3) refuse(path, "corrupt: a vector of three numbers expected");
  return Eigen::Vector3d(numbers.data());
}

CapabilityOptions read_options(const detail::JsonValue& from, const std::string& path) {
  const auto integer = [&](const char* name) {
    const std::int64_t value = from.at(name).integer();
    if (value < 0 || value > 0x7fffffff) refuse(path, std::string("corrupt: impossible ") + name);
    return static_cast<int>(value);
  };
  CapabilityOptions o;
  o.lower = vector_of(from.at("lower"), path);
  o.upper = vector_of(from.at("upper"), path);
  o.voxel = from.at("voxel").number();
  o.poses = integer("poses");
  o.rolls = integer("rolls");
  o.approach = vector_of(from.at("approach"), path);
  o.samples = integer("samples");
  o.sweeps = integer("sweeps");
  o.restarts = integer("restarts");
  o.padding = from.at("padding").number();
  const std::int64_t seed = from.at("seed").integer();
  if (seed < 0 || seed > 0xffffffffLL) refuse(path, "corrupt: impossible seed");
  o.seed = static_cast<unsigned>(seed);
  try {
    o.check();
  } catch (const InvalidInput& invalid) {
    refuse(path, std::string("corrupt: ") + invalid.what());
  }
  return o;
}

/// The payload of a file whose header and checksums are as they must be.
std::vector<unsigned char> read_array(const std::string& folder, const ArrayFile& array,
                                      const detail::JsonValue& meta) {
  const std::string path = (fs::path(folder) / array.name).string(), header = array.layout.header();
  const detail::FileCopy file(path, header.size() + array.layout.payload_bytes());
  file.read(0, file.size());
  if (std::memcmp(file.data(), header.data(), header.size()) != 0)
    refuse(path, "corrupt: its header contradicts meta.json");
  const std::vector<detail::JsonValue>& sums = meta.at("files").at(array.name).at("crc32_of_chunks").array();
  if (sums.size() != (file.size() + detail::kChecksumChunk - 1) / detail::kChecksumChunk)
    refuse(path, "corrupt: meta.json has another number of checksums");
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::size_t begin = i * detail::kChecksumChunk;
    const std::size_t size = std::min<std::size_t>(detail::kChecksumChunk, file.size() - begin);
    if (sums[i].integer() != static_cast<std::int64_t>(detail::crc32(file.data() + begin, size)))
      refuse(path, "corrupt: the checksum of bytes " + std::to_string(begin) + " and on differs");
  }
  return {file.data() + header.size(), file.data() + file.size()};
}

CapabilityMap load_once(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) refuse(path, "no such folder");
  const std::string meta_path = (fs::path(path) / "meta.json").string();
  if (!fs::is_regular_file(meta_path, error)) refuse(path, "not a capability map: it holds no meta.json");
  const detail::JsonValue meta = read_meta(meta_path);
  auto data = std::make_shared<Data>();
  data->options = read_options(meta.at("options"), meta_path);
  data->arm_key = meta.at("arm_key").string();
  const std::int64_t joints = meta.at("joints").integer(), reached = meta.at("reached").integer();
  data->lay_out();
  const std::int64_t most = data->voxel_count() * static_cast<std::int64_t>(data->poses());
  if (joints < 1 || joints > 1000 || reached < 0 || reached > most) refuse(meta_path, "corrupt: impossible counts");
  data->joints = static_cast<int>(joints);
  const std::vector<ArrayFile> files = array_files(*data, static_cast<std::uint64_t>(reached));
  data->classes = read_array(path, files[0], meta);
  const std::vector<unsigned char> configurations = read_array(path, files[1], meta);
  data->configurations.resize(configurations.size() / sizeof(float));
  if (!configurations.empty()) std::memcpy(data->configurations.data(), configurations.data(), configurations.size());
  read_array(path, files[2], meta);
  read_array(path, files[3], meta);
  for (const std::uint8_t cause : data->classes)
    if (cause > static_cast<std::uint8_t>(Rejection::scene)) refuse(path, "corrupt: classes.npy holds no class");
  data->complete();
  if (data->first.back() != reached) refuse(path, "corrupt: classes.npy contradicts meta.json");
  return CapabilityMap(std::move(data));
}

}  // namespace

void CapabilityMap::save(const std::string& folder) const {
  const std::string path = detail::folder_name(folder);
  const std::string temporary = detail::temporary_beside(path);
  std::error_code error;
  if (!fs::create_directory(temporary, error)) refuse(path, "cannot write (" + error.message() + ")");
  try {
    const auto count = static_cast<std::uint64_t>(reached());
    const std::vector<double> tool_poses = rows_of(data_->tool_poses);
    const void* const arrays[] = {data_->classes.data(), data_->configurations.data(), data_->index.data(),
                                  tool_poses.data()};
    std::vector<std::vector<std::uint32_t>> sums;
    for (const ArrayFile& array : array_files(*data_, count)) {
      detail::NpyWriter writer((fs::path(temporary) / array.name).string(), path, array.layout);
      writer.write(arrays[sums.size()], array.layout.payload_bytes());
      writer.finish(array.layout.shape[0]);
      sums.push_back(writer.checksums());
    }
    std::ofstream file(fs::path(temporary) / "meta.json", std::ios::binary | std::ios::trunc);
    file << meta_text(*data_, count, sums);
    file.close();
    if (!file) refuse(path, "cannot write all of it (is the disk full?)");
    detail::put_in_place(temporary, path);
  } catch (...) {
    fs::remove_all(temporary, error);
    throw;
  }
}

CapabilityMap CapabilityMap::load(const std::string& path) {
  return detail::load_from_one_folder(path, [&path] { return load_once(path); });
}

}  // namespace mmgrasp
