// ReachDatabase::save and load: a folder of memory-mapped arrays with checksums.
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "reach/database/reach_meta.hpp"
#include "reach/database/saved_folder.hpp"

namespace mmgrasp {
namespace {

namespace fs = std::filesystem;

using Data = ReachDatabase::Data;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw IoError(path + ": " + what);
}

bool starts_with(const fs::path& file, const std::string& text) {
  std::string begin(text.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return stream && begin == text;
}

/// The one-file format of earlier versions.
bool is_old_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && starts_with(path, "MMGREACH");
}

/// Whether anything stands there that is no earlier save of what was written: it may be somebody's.
bool is_something_else(const fs::path& path, const fs::path& written) {
  std::error_code error;
  const auto kind = fs::symlink_status(path, error);
  if (fs::is_regular_file(kind)) return !is_old_file(path);
  if (fs::exists(kind) && !fs::is_directory(kind)) return true;  // a device, a pipe, a link that leads to no folder
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    if (!fs::exists(written / entry->path().filename())) return true;
  return false;
}

std::string file_in(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

/// Every offset must be usable: nothing that was read from a file is trusted.
void check_tables(const Data& data, const std::string& path) {
  const std::size_t positions = data.position_count(), cells = data.cell_count();
  bool sound = data.position_first[0] == 0 && data.position_first[positions] == cells && data.cell_first[0] == 0 &&
               data.configurations.count == data.size() * data.joints;
  for (std::size_t i = 0; i < positions; ++i) sound = sound && data.position_first[i] < data.position_first[i + 1];
  for (std::size_t i = 0; i < cells; ++i) sound = sound && data.cell_first[i] < data.cell_first[i + 1];
  for (std::size_t i = 0; i < 3 * positions; ++i)
    sound = sound && data.positions[i] >= -detail::kPositionLimit && data.positions[i] < detail::kPositionLimit;
  if (!sound) refuse(path, "corrupt: the tables contradict each other");
}

void check_order(const Data& data, const std::string& path) {
  bool sound = true;
  for (std::size_t i = 0; i + 1 < data.position_keys.size(); ++i)
    sound = sound && data.position_keys[i] < data.position_keys[i + 1];
  const std::uint32_t rotations = data.rotations.count();
  for (std::size_t i = 0; i < data.cell_count(); ++i) sound = sound && data.rotation_ids[i] < rotations;
  if (!sound) refuse(path, "corrupt: the cells are not in order");
}

/// Bounds and reach say how far to look: they must fit the cells that are there.
void check_bounds(const Data& data, const std::string& path) {
  const double cell = data.options.position_cell, slack = 1e-3 * cell;
  Eigen::AlignedBox3d cells;
  double nearest = 0, farthest = 0;  // least and largest that the reach can be
  for (std::size_t i = 0; i < data.position_count(); ++i) {
    const Eigen::Vector3d low =
        cell * Eigen::Vector3d(data.positions[3 * i], data.positions[3 * i + 1], data.positions[3 * i + 2]);
    const Eigen::AlignedBox3d box(low, low + Eigen::Vector3d::Constant(cell));
    cells.extend(box);
    nearest = std::max(nearest, box.exteriorDistance(Eigen::Vector3d::Zero().eval()));
    farthest = std::max(farthest, box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm());
  }
  bool sound =
      data.bounds.isEmpty() == cells.isEmpty() && data.reach >= nearest - slack && data.reach <= farthest + slack;
  if (sound && !cells.isEmpty()) {
    const Eigen::Vector3d low = data.bounds.min() - cells.min(), high = cells.max() - data.bounds.max();
    sound = low.minCoeff() >= -slack && low.maxCoeff() <= cell + slack && high.minCoeff() >= -slack &&
            high.maxCoeff() <= cell + slack;
  }
  if (!sound) refuse(path, "corrupt: reach or bounds do not fit the cells");
}

template <typename T>
detail::View<T> view(const detail::CheckedFile& file, std::uint64_t count) {
  return {reinterpret_cast<const T*>(file.payload()), count};
}

ReachDatabase load_once(const std::string& path) {
  std::error_code error;
  if (is_old_file(path))
    refuse(path, "a reachability database in the one-file format of earlier versions; build it again");
  if (!fs::exists(path, error)) refuse(path, "no such file or folder");
  if (!fs::is_directory(path, error)) refuse(path, "not a reachability database (those are folders)");
  const std::string meta_path = file_in(path, detail::kMetaFile);
  if (!fs::is_regular_file(meta_path, error))
    refuse(path, "not a reachability database: it holds no " + std::string(detail::kMetaFile));

  auto data = std::make_shared<Data>();
  detail::Meta meta = detail::read_meta(meta_path, *data);
  const auto joints = static_cast<std::uint64_t>(data->joints);
  const auto layouts = detail::array_layouts(meta.positions, meta.cells, meta.size, joints);
  for (int i = 0; i < detail::kArrayCount; ++i)
    data->files.push_back(std::make_unique<detail::CheckedFile>(file_in(path, detail::kArrayFiles[i]), layouts[i],
                                                                std::move(meta.checksums[i])));
  // The tables are small and are checked now; the configurations when they are first checked.
  for (int i = 0; i + 1 < detail::kArrayCount; ++i)
    if (layouts[i].payload_bytes() > 0) data->files[i]->ensure(0, layouts[i].payload_bytes());
  data->positions = view<std::int32_t>(*data->files[0], 3 * meta.positions);
  data->position_first = view<std::uint32_t>(*data->files[1], meta.positions + 1);
  data->rotation_ids = view<std::uint32_t>(*data->files[2], meta.cells);
  data->cell_first = view<std::uint32_t>(*data->files[3], meta.cells + 1);
  data->configurations = view<std::uint16_t>(*data->files[4], meta.size * joints);
  data->configuration_file = data->files[4].get();
  data->folder = path;
  if (data->cell_first[meta.cells] != meta.size) refuse(path, "corrupt: the tables contradict each other");
  check_tables(*data, path);
  data->complete();
  check_order(*data, path);
  check_bounds(*data, path);
  return ReachDatabase(std::move(data));
}

}  // namespace

namespace detail {

std::string folder_name(const std::string& path) {
  if (path.empty()) return path;
  std::error_code error;
  const fs::path folder = fs::path(path + "/").parent_path();
  if (!fs::is_symlink(folder, error) || !fs::is_directory(folder, error)) return folder.string();
  const fs::path target = fs::canonical(folder, error);  // the link stays, and the folder it leads to is replaced
  return error ? folder.string() : target.string();
}

std::string temporary_beside(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  return path + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
}

void write_database(const Data& data, const std::string& folder, const std::string& named,
                    const NpyWriter* configurations) {
  FileChecksums checksums;
  const auto layouts =
      array_layouts(data.position_count(), data.cell_count(), data.size(), static_cast<std::uint64_t>(data.joints));
  const void* const arrays[kArrayCount] = {data.positions.data, data.position_first.data, data.rotation_ids.data,
                                           data.cell_first.data, data.configurations.data};
  for (int i = 0; i < kArrayCount; ++i) {
    if (i == kArrayCount - 1 && configurations != nullptr) {
      checksums[i] = configurations->checksums();
      continue;
    }
    NpyWriter writer(file_in(folder, kArrayFiles[i]), named, layouts[i]);
    writer.write(arrays[i], layouts[i].payload_bytes());
    writer.finish(layouts[i].shape[0]);
    checksums[i] = writer.checksums();
  }
  std::ofstream file(file_in(folder, kMetaFile), std::ios::binary | std::ios::trunc);
  file << meta_text(data, checksums);
  file.close();
  if (!file) refuse(named, "cannot write all of it (is the disk full?)");
}

void put_in_place(const std::string& written, const std::string& path) {
  std::error_code error;
  constexpr int kLooks = 5;  // another save may take the folder away between two questions, but not every time
  int strange = 0;
  while (strange < kLooks && is_something_else(path, written)) ++strange;
  if (strange == kLooks) refuse(path, "cannot be written: something else stands there that saving would remove");
  if (const fs::file_status before = fs::status(path, error); fs::is_directory(before))
    fs::permissions(written, before.permissions(), error);  // who may read it stays as it was
  // Others may do the same at the same time; the last one stays.
  constexpr int kAttempts = 20;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    fs::rename(written, path, error);
    if (!error) return;  // nothing, or an empty folder, was there
    if (exchange_places(written, path)) {
      fs::remove_all(written, error);
      return;
    }
    move_away(path);  // some file systems cannot exchange: for a moment none is there, never half of one
  }
  refuse(path, "cannot put the written folder in place (" + error.message() + ")");
}

void move_away(const std::string& path) {
  const std::string aside = temporary_beside(path);
  std::error_code error;
  fs::rename(path, aside, error);
  if (!error) fs::remove_all(aside, error);
}

}  // namespace detail

void ReachDatabase::save(const std::string& folder) const {
  const std::string path = detail::folder_name(folder);
  const std::string temporary = detail::temporary_beside(path);
  std::error_code error;
  if (!fs::create_directory(temporary, error)) refuse(path, "cannot write (" + error.message() + ")");
  try {
    if (data_->size() > 0) data_->stored(0, data_->size());  // what is copied must be sound
    detail::write_database(*data_, temporary, path, nullptr);
    detail::put_in_place(temporary, path);
  } catch (...) {
    fs::remove_all(temporary, error);
    throw;
  }
}

ReachDatabase ReachDatabase::load(const std::string& path) {
  return detail::load_from_one_folder(path, [&path] { return load_once(path); });
}

ReachDatabase ReachDatabase::load(const std::string& path, const JointGroup& arm) {
  ReachDatabase database = load(path);
  const std::string difference = database.difference(arm);
  if (!difference.empty()) refuse(path, "built for another robot: " + difference + "; build it again");
  return database;
}

std::string ReachDatabase::difference(const JointGroup& arm) const {
  return data_->arm.difference(detail::StoredArm(detail::checked_arm(arm)));
}

bool ReachDatabase::verify(const Monitor& monitor) const {
  for (const auto& file : data_->files) {
    const auto work = [&](std::size_t chunk, int) { file->check_chunk(chunk); };
    if (!parallel_for(file->checksums.size(), 0, work, monitor, "checksums")) return false;
  }
  return true;
}

}  // namespace mmgrasp
