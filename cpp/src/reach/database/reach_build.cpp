// ReachDatabase::build and build_to: sampling in shards, resumed after an interruption.
#include <sys/file.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <numeric>
#include <optional>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/reach/reach_parts.hpp"
#include "reach/database/reach_meta.hpp"
#include "reach/database/shard_merge.hpp"

namespace mmgrasp {
namespace {

namespace fs = std::filesystem;
using Data = ReachDatabase::Data;

constexpr std::int64_t kManipulabilityBlocks = 8;
constexpr std::int64_t kMostBlocksAShard = 256, kLeastShards = 64;
constexpr std::int64_t kWorthCountingFull = 200'000;  // samples per place in a cell: with fewer, few cells ever fill
constexpr double kSamplingShare = 0.9;                // of the progress
constexpr const char* kStage = "reachability database";

/// Samples an arm shard by shard and puts the shards together.
class Builder {
 public:
  Builder(const JointGroup& arm, const ReachOptions& options, const std::string& key, const std::string& partial,
          const Monitor& monitor)
      : arm_(arm),
        stored_(arm_),
        options_(options),
        monitor_(monitor),
        threads_(resolve_threads(options.threads)),
        rotations_(options.rotation_cell),
        blocks_((options.samples + detail::kBlock - 1) / detail::kBlock),
        shard_blocks_(std::clamp<std::int64_t>((blocks_ + kLeastShards - 1) / kLeastShards, 1, kMostBlocksAShard)),
        shards_((blocks_ + shard_blocks_ - 1) / shard_blocks_),
        store_(partial, key, shards_, arm_.size()) {
    CheckerOptions checking;
    checking.check_scene = false;
    const CollisionChecker checker(arm_, World{}, checking);
    samplers_.reserve(threads_);
    for (int i = 0; i < threads_; ++i) samplers_.emplace_back(arm_, stored_, options_, rotations_, checker.clone());
    if (options.samples / options.max_per_cell > kWorthCountingFull) full_.emplace(options.max_per_cell);
  }

  std::int64_t shards() const { return shards_; }

  /// Only these shards, into the store. False when stopped.
  bool run_shards(const std::vector<std::int64_t>& wanted) {
    full_.reset();
    return estimate_manipulability() && sample(wanted);
  }

  /// The configurations go to `writer`, or to data.own when it is null. False when stopped.
  bool run(Data& data, detail::NpyWriter* writer) {
    data.arm = stored_;
    data.joints = arm_.size();
    monitor_.report(kStage, 0);
    if (!estimate_manipulability() || !sample() || !merge(data, writer)) return false;
    data.view_own();
    return true;
  }

 private:
  Monitor silent() const { return Monitor{monitor_.stop, {}}; }

  /// Takes the largest manipulability from the first blocks, so that every sample is measured against the same
  /// threshold.
  bool estimate_manipulability() {
    if (options_.min_manipulability <= 0 && options_.thinning <= 0) return !monitor_.stopped();
    std::vector<double> largest(std::min(kManipulabilityBlocks, blocks_), 0);
    const auto work = [&](std::size_t block, int worker) {
      largest[block] = samplers_[worker].largest_manipulability(static_cast<std::int64_t>(block));
    };
    if (!parallel_for(largest.size(), threads_, work, silent())) return false;
    for (detail::ShardSampler& sampler : samplers_)
      sampler.set_largest_manipulability(*std::max_element(largest.begin(), largest.end()));
    return true;
  }

  bool sample() {
    std::vector<std::int64_t> all(shards_);
    std::iota(all.begin(), all.end(), std::int64_t{0});
    return sample(all);
  }

  bool sample(const std::vector<std::int64_t>& wanted) {
    std::atomic<std::int64_t> done{0};
    std::vector<std::int64_t> missing;
    for (const std::int64_t shard : wanted) {
      if (!store_.has(shard)) {
        missing.push_back(shard);
        continue;
      }
      done += blocks_of(shard);
      if (full_) full_->finish(shard, store_.cell_keys(shard));
    }
    std::atomic<bool> stopped{false};
    const auto work = [&](std::size_t item, int worker) {
      const std::int64_t shard = missing[item];
      double reported = -1;
      const auto step = [&] {
        const double fraction =
            kSamplingShare * static_cast<double>(done.fetch_add(1) + 1) / static_cast<double>(blocks_);
        if (worker == 0 && fraction > reported + 0.002) monitor_.report(kStage, reported = fraction);
        return !monitor_.stopped();
      };
      detail::ShardRecords records;
      const detail::FillTable* full = full_ ? &*full_ : nullptr;
      if (!samplers_[worker].sample(shard * shard_blocks_, blocks_of(shard), full, step, records)) {
        stopped = true;
        return;
      }
      store_.put(shard, std::move(records));
      if (full_) full_->finish(shard, store_.cell_keys(shard));
    };
    return parallel_for(missing.size(), threads_, work, silent()) && !stopped;
  }

  std::int64_t blocks_of(std::int64_t shard) const { return std::min(shard_blocks_, blocks_ - shard * shard_blocks_); }

  bool merge(Data& data, detail::NpyWriter* writer) {
    const detail::ShardMerge merging(store_, shards_, rotations_.count(), arm_.size(), options_.max_per_cell);
    require(merging.record_count() < 0xffffffffu, "samples", static_cast<double>(options_.samples),
            "too many: fewer than 2^32 configurations can be stored");
    detail::OwnArrays& own = data.own;
    own.position_first.assign(1, 0);
    own.cell_first.assign(1, 0);
    if (writer == nullptr) own.configurations.reserve(merging.record_count() * arm_.size());
    const std::size_t parts = merging.part_count(), batch = 4 * threads_;
    std::vector<detail::MergedCells> merged(batch);
    for (std::size_t first = 0; first < parts; first += batch) {
      const std::size_t count = std::min(batch, parts - first);
      const auto work = [&](std::size_t item, int) { merged[item] = merging.merge(first + item); };
      if (!parallel_for(count, threads_, work, silent())) return false;
      for (std::size_t i = 0; i < count; ++i) append(merged[i], own, writer);
      monitor_.report(kStage, kSamplingShare + (1 - kSamplingShare) * static_cast<double>(first + count) /
                                                   static_cast<double>(parts + 1));
    }
    return !monitor_.stopped();
  }

  static void append(const detail::MergedCells& cells, detail::OwnArrays& own, detail::NpyWriter* writer) {
    own.positions.insert(own.positions.end(), cells.positions.begin(), cells.positions.end());
    for (const std::uint32_t count : cells.position_counts)
      own.position_first.push_back(own.position_first.back() + count);
    own.rotation_ids.insert(own.rotation_ids.end(), cells.rotation_ids.begin(), cells.rotation_ids.end());
    for (const std::uint32_t count : cells.cell_counts) own.cell_first.push_back(own.cell_first.back() + count);
    if (writer != nullptr)
      writer->write(cells.configurations.data(), cells.configurations.size() * sizeof(std::uint16_t));
    else
      own.configurations.insert(own.configurations.end(), cells.configurations.begin(), cells.configurations.end());
  }

  JointGroup arm_;
  detail::StoredArm stored_;
  ReachOptions options_;
  const Monitor& monitor_;
  int threads_;
  detail::RotationCells rotations_;
  std::int64_t blocks_, shard_blocks_, shards_;
  detail::ShardStore store_;
  std::optional<detail::FillTable> full_;
  std::vector<detail::ShardSampler> samplers_;
};

std::shared_ptr<Data> make_data(const JointGroup& arm, const ReachOptions& options) {
  auto data = std::make_shared<Data>();
  data->options = options;
  data->options.threads = 0;
  data->key = ReachDatabase::cache_key(arm, options);
  data->arm = detail::StoredArm(detail::checked_arm(arm));
  data->joints = arm.size();
  return data;
}

/// Holds no configuration.
ReachDatabase empty_database(const JointGroup& arm, const ReachOptions& options) {
  auto data = make_data(arm, options);
  data->own.position_first.assign(1, 0);
  data->own.cell_first.assign(1, 0);
  data->view_own();
  data->complete();
  return ReachDatabase(std::move(data));
}

/// The folder of unfinished shards. A second build of the same path at the same time gets one of its own, which does
/// not outlive it.
class PartialFolder {
 public:
  explicit PartialFolder(const std::string& path) : folder_(path + ".partial") {
    if (try_lock()) return;
    folder_ = detail::temporary_beside(path);
    own_ = true;
    if (!try_lock()) throw IoError(folder_ + ": cannot make the folder for unfinished parts");
  }
  ~PartialFolder() {
    std::error_code error;
    if (own_ || finished_ || !holds_parts()) fs::remove_all(folder_, error);
    if (lock_ >= 0) ::close(lock_);
  }
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  const std::string& path() const { return folder_; }
  void finished() { finished_ = true; }

 private:
  bool try_lock() {
    std::error_code error;
    fs::create_directory(folder_, error);
    lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) throw IoError(folder_ + ": cannot make the folder for unfinished parts");
    if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return true;
    ::close(lock_);
    lock_ = -1;
    return false;
  }
  bool holds_parts() const {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_, error))
      if (entry.path().extension() == ".part") return true;
    return false;
  }

  std::string folder_;
  int lock_ = -1;
  bool own_ = false, finished_ = false;
};

}  // namespace

ReachDatabase ReachDatabase::build(const JointGroup& arm, const ReachOptions& options, const Monitor& monitor) {
  options.check();
  auto data = make_data(arm, options);
  const bool built = Builder(detail::checked_arm(arm), options, data->key, "", monitor).run(*data, nullptr);
  if (!built) return empty_database(arm, options);
  data->complete();
  data->measure();
  monitor.report(kStage, 1.0);
  return ReachDatabase(std::move(data));
}

std::int64_t reach_part_count(const JointGroup& arm, const ReachOptions& options) {
  options.check();
  return Builder(detail::checked_arm(arm), options, ReachDatabase::cache_key(arm, options), "", {}).shards();
}

bool build_reach_parts(const std::string& folder, const JointGroup& arm, const ReachOptions& options,
                       const std::vector<std::int64_t>& parts, const Monitor& monitor) {
  options.check();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder + ": cannot make the folder for parts (" + error.message() + ")");
  Builder builder(detail::checked_arm(arm), options, ReachDatabase::cache_key(arm, options), folder, monitor);
  for (const std::int64_t part : parts) {
    require(part >= 0 && part < builder.shards(), "part", static_cast<double>(part),
            "must be in [0, " + std::to_string(builder.shards()) + ")");
  }
  return builder.run_shards(parts);
}

ReachDatabase ReachDatabase::build_to(const std::string& folder, const JointGroup& arm, const ReachOptions& options,
                                      const Monitor& monitor) {
  options.check();
  const std::string path = detail::folder_name(folder);
  const std::string key = cache_key(arm, options);
  PartialFolder partial(path);
  const std::string written = (fs::path(partial.path()) / "written").string();
  std::error_code error;
  fs::remove_all(written, error);
  if (!fs::create_directory(written, error)) throw IoError(path + ": cannot write (" + error.message() + ")");
  bool built = false;
  try {
    auto data = make_data(arm, options);
    auto layout = detail::array_layouts(0, 0, 0, static_cast<std::uint64_t>(arm.size()))[detail::kArrayCount - 1];
    const std::string file = (fs::path(written) / detail::kArrayFiles[detail::kArrayCount - 1]).string();
    detail::NpyWriter writer(file, path, layout);
    built = Builder(detail::checked_arm(arm), options, key, partial.path(), monitor).run(*data, &writer);
    if (built) {
      writer.finish(data->size());
      const auto rows = static_cast<std::uint64_t>(data->size());
      layout.shape[0] = rows;
      data->files.push_back(std::make_unique<detail::CheckedFile>(file, layout, writer.checksums()));
      data->configurations = {reinterpret_cast<const std::uint16_t*>(data->files[0]->payload()), rows * arm.size()};
      data->configuration_file = data->files[0].get();
      data->complete();
      data->measure();
      detail::write_database(*data, written, path, &writer);
    }
  } catch (...) {
    fs::remove_all(written, error);
    throw;
  }
  if (!built) {
    fs::remove_all(written, error);
    return empty_database(arm, options);
  }
  detail::put_in_place(written, path);
  partial.finished();
  monitor.report(kStage, 1.0);
  return load(path);
}

}  // namespace mmgrasp
