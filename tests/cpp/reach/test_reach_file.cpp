#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "support/small_robots.hpp"

namespace mmgrasp {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, gone afterwards.
class ReachFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("mmgrasp_reach_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static void write(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
  }

  /// The message names the file and says what is wrong.
  static void expect_refused(const std::string& path, const std::string& what) {
    try {
      ReachDatabase::load(path);
      ADD_FAILURE() << "accepted: " << what;
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
};

JointGroup seven_joints(const std::string& elbow_upper = "2.4") {
  return Robot::from_strings(test::seven_joint_urdf(elbow_upper)).chain("column", "tool");
}

ReachOptions small() {
  ReachOptions options;
  options.samples = 150000;
  options.max_per_cell = 2;
  options.position_cell = 0.2;
  options.rotation_cell = 0.8;
  return options;
}

TEST_F(ReachFile, SameBytesAtAnyThreadCount) {
  const JointGroup arm = seven_joints();
  std::string first;
  for (const int threads : {1, 2, 4}) {
    ReachOptions options = small();
    options.threads = threads;
    ReachDatabase::build(arm, options).save(path("t.reach"));
    const std::string bytes = read(path("t.reach"));
    ASSERT_GT(bytes.size(), 100000u);
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
  ReachOptions options = small();
  options.seed = 2;
  ReachDatabase::build(arm, options).save(path("t.reach"));
  EXPECT_FALSE(read(path("t.reach")) == first);
}

TEST_F(ReachFile, RoundTripKeepsEverything) {
  const JointGroup arm = seven_joints();
  const auto built = ReachDatabase::build(arm, small());
  built.save(path("a.reach"));
  EXPECT_EQ(file_count(), 1u);  // no temporary file is left
  const auto loaded = ReachDatabase::load(path("a.reach"));
  EXPECT_EQ(loaded.key(), built.key());
  EXPECT_EQ(loaded.key(), ReachDatabase::cache_key(arm, small()));
  EXPECT_EQ(loaded.size(), built.size());
  EXPECT_EQ(loaded.cell_count(), built.cell_count());
  EXPECT_EQ(loaded.joint_count(), 7);
  EXPECT_EQ(loaded.reach(), built.reach());
  EXPECT_EQ(loaded.bounds().max(), built.bounds().max());
  EXPECT_EQ(loaded.options().samples, small().samples);
  EXPECT_EQ(loaded.options().position_cell, small().position_cell);
  EXPECT_EQ(loaded.options().rotation_cell, small().rotation_cell);
  EXPECT_EQ(loaded.options().max_per_cell, small().max_per_cell);
  EXPECT_EQ(loaded.options().min_manipulability, small().min_manipulability);
  EXPECT_EQ(loaded.options().seed, small().seed);
  Eigen::MatrixXd a, b;
  for (std::int64_t i = 0; i < built.size(); i += 1009) {
    const Pose T = arm.fk(built.configuration(i));
    EXPECT_EQ(built.cell(T), loaded.cell(T));
    ASSERT_EQ(built.nearest(T, 6, a), loaded.nearest(T, 6, b));
    EXPECT_EQ(a, b);
  }
  loaded.save(path("b.reach"));
  EXPECT_TRUE(read(path("a.reach")) == read(path("b.reach")));
}

TEST_F(ReachFile, RefusesDamagedFiles) {
  const std::string file = path("d.reach");
  ReachOptions options = small();
  options.samples = 5000;
  ReachDatabase::build(seven_joints(), options).save(file);
  const std::string sound = read(file);
  for (const std::size_t offset :
       {std::size_t{20}, std::size_t{40}, std::size_t{80}, std::size_t{110}, std::size_t{119}, std::size_t{120},
        sound.size() / 3, sound.size() / 2, sound.size() - 1}) {
    std::string bytes = sound;
    bytes[offset] = static_cast<char>(bytes[offset] ^ 0x10);
    write(file, bytes);
    expect_refused(file, "corrupt");
  }
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{8}, std::size_t{119}, std::size_t{120}, sound.size() / 2, sound.size() - 1}) {
    write(file, sound.substr(0, size));
    expect_refused(file, "truncated");
  }
  write(file, sound + "x");
  expect_refused(file, "bytes after the end");
  write(file, std::string(500, 'a'));
  expect_refused(file, "not a reachability database");
  std::string newer = sound;
  newer[8] = 99;
  write(file, newer);
  expect_refused(file, "version 99");
  expect_refused(path("absent.reach"), "no such file");
  expect_refused(folder_.string(), "no such file");
  write(file, sound);
  EXPECT_NO_THROW(ReachDatabase::load(file));
}

TEST_F(ReachFile, CannotBeWrittenWhereThereIsNoFolder) {
  ReachOptions options = small();
  options.samples = 100;
  const auto database = ReachDatabase::build(seven_joints(), options);
  EXPECT_THROW(database.save(path("no/such/folder/x.reach")), IoError);
  fs::create_directories(path("taken.reach/inside"));
  EXPECT_THROW(database.save(path("taken.reach")), IoError);
  EXPECT_EQ(file_count(), 1u);  // the folder only: no temporary file is left
}

TEST_F(ReachFile, CacheIsUsedWhenSoundAndRebuiltWhenNot) {
  const JointGroup arm = seven_joints();
  ReachOptions options = small();
  options.samples = 5000;
  const std::string cache = path("cache/reach");
  const auto first = ReachDatabase::load_or_build(arm, options, cache);
  const std::string file = (fs::path(cache) / (first.key() + ".reach")).string();
  ASSERT_TRUE(fs::exists(file));
  const std::string sound = read(file);

  int reports = 0;
  Monitor monitor;
  monitor.progress = [&](const std::string&, double) { ++reports; };
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache, monitor).size(), first.size());
  EXPECT_EQ(reports, 0);  // read, not built

  write(file, sound.substr(0, sound.size() / 2));
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache, monitor).size(), first.size());
  EXPECT_GT(reports, 0);
  EXPECT_TRUE(read(file) == sound);

  // A sound file of another arm under this name is not taken for this arm's.
  ReachDatabase::build(seven_joints("2.3"), options).save(file);
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache).key(), first.key());
  EXPECT_TRUE(read(file) == sound);

  Monitor stopped;
  stopped.stop.stop();
  options.seed = 7;
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache, stopped).size(), 0);
  EXPECT_FALSE(fs::exists(fs::path(cache) / (ReachDatabase::cache_key(arm, options) + ".reach")));

  write(path("file"), "x");
  EXPECT_THROW(ReachDatabase::load_or_build(arm, options, path("file")), IoError);
}

TEST_F(ReachFile, KeyFollowsEverythingThatMattersAndNothingElse) {
  write(path("part.stl"),
        "solid t\n"
        "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
        "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
        "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid t\n");
  const auto with_mesh = [&](const std::string& scale) {
    RobotOptions options;
    options.mesh_dir = folder_.string();
    const std::string mesh = "<geometry><mesh filename='part.stl' scale='" + scale + "'/></geometry>";
    return Robot::from_strings("<robot name='m'>" + test::urdf_link("base") + test::urdf_link("tip", mesh) +
                                   test::urdf_link("other") +
                                   test::urdf_joint("j", "revolute", "base", "tip", "0 0 0", "0 0 1") +
                                   test::urdf_joint("k", "revolute", "base", "other", "0 0 0", "0 0 1") + "</robot>",
                               "", options);
  };
  const ReachOptions options = small();
  const auto key = [&](const JointGroup& arm) { return ReachDatabase::cache_key(arm, options); };
  const Robot robot = with_mesh("1 1 1");
  const JointGroup arm = robot.chain("base", "tip");
  const std::string reference = key(arm);
  EXPECT_EQ(reference, key(with_mesh("1 1 1").chain("base", "tip")));
  EXPECT_NE(reference, key(with_mesh("1 1 1.0000001").chain("base", "tip")));
  EXPECT_NE(reference, key(robot.chain("base", "other")));
  EXPECT_NE(reference, key(arm.with_reference(robot.values({{"k", 0.5}}))));
  EXPECT_EQ(reference, key(arm.with_reference(robot.values({{"j", 0.5}}))));
  EXPECT_EQ(reference, key(arm.at(pose_from_planar({1, 2, 3}))));
  EXPECT_NE(key(seven_joints("2.4")), key(seven_joints("2.4000001")));

  for (int field = 0; field < 7; ++field) {
    ReachOptions changed = options;
    if (field == 0) ++changed.samples;
    if (field == 1) changed.position_cell += 1e-9;
    if (field == 2) changed.rotation_cell += 1e-9;
    if (field == 3) ++changed.max_per_cell;
    if (field == 4) changed.min_manipulability += 1e-9;
    if (field == 5) ++changed.seed;
    if (field == 6) changed.threads = 3;
    EXPECT_EQ(ReachDatabase::cache_key(arm, changed) == reference, field == 6) << field;
  }
}

}  // namespace
}  // namespace mmgrasp
