#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "support/small_robots.hpp"

namespace mmgrasp::test {

namespace fs = std::filesystem;

inline JointGroup seven_joints_to(const std::string& elbow_upper) {
  return Robot::from_strings(seven_joint_urdf(elbow_upper)).chain("column", "tool");
}

inline std::string read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
inline void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}
/// Every file of a database by name.
inline std::map<std::string, std::string> read_folder(const fs::path& path) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::directory_iterator(path)) out[entry.path().filename().string()] = read_bytes(entry);
  return out;
}
inline void write_folder(const fs::path& path, const std::map<std::string, std::string>& files) {
  fs::remove_all(path);
  fs::create_directories(path);
  for (const auto& [name, bytes] : files) write_bytes(path / name, bytes);
}

/// A folder of its own, gone afterwards.
class ReachFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("mmgrasp_reach_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t entry_count() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}); }

  static ReachOptions small(std::int64_t samples = 150000) {
    ReachOptions options;
    options.samples = samples;
    options.max_per_cell = 2;
    options.position_cell = 0.2;
    options.rotation_cell = 0.8;
    return options;
  }

  /// The message names the database and says what is wrong.
  template <class Call>
  static void expect_io_error(const std::string& path, const std::string& what, const Call& call) {
    try {
      call();
      ADD_FAILURE() << "accepted: " << what;
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  }
  static void expect_refused(const std::string& path, const std::string& what) {
    expect_io_error(path, what, [&] { ReachDatabase::load(path); });
  }

  fs::path folder_;
};

}  // namespace mmgrasp::test
