#include <gtest/gtest.h>

#include <thread>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/reach/reach_arrays.hpp"
#include "mmgrasp/reach/reach_solve.hpp"
#include "support/reach_folder.hpp"

namespace mmgrasp {
namespace {

namespace fs = std::filesystem;
using ReachFile = test::ReachFolder;

TEST_F(ReachFile, SameBytesAtAnyThreadCount) {
  const JointGroup arm = test::seven_joints_to("2.4");
  std::map<std::string, std::string> first;
  for (const int threads : {1, 2, 4}) {
    ReachOptions options = small();
    options.threads = threads;
    ReachDatabase::build(arm, options).save(path("t.reach"));
    const auto files = test::read_folder(path("t.reach"));
    ASSERT_EQ(files.size(), 6u);
    ASSERT_GT(files.at("configurations.npy").size(), 100000u);
    if (first.empty()) first = files;
    EXPECT_TRUE(files == first) << threads << " threads";
    ReachDatabase::build_to(path("u.reach"), arm, options);
    EXPECT_TRUE(test::read_folder(path("u.reach")) == first) << threads << " threads, through files";
  }
  EXPECT_EQ(entry_count(), 2u);  // no parts and no temporary folder are left
  ReachOptions options = small();
  options.seed = 2;
  ReachDatabase::build(arm, options).save(path("t.reach"));
  EXPECT_FALSE(test::read_folder(path("t.reach")) == first);
}

TEST_F(ReachFile, RoundTripKeepsEverything) {
  const JointGroup arm = test::seven_joints_to("2.4");
  const auto built = ReachDatabase::build(arm, small());
  built.save(path("a.reach"));
  EXPECT_EQ(entry_count(), 1u);  // nothing temporary is left
  const auto loaded = ReachDatabase::load(path("a.reach"));
  EXPECT_TRUE(loaded.verify());
  EXPECT_EQ(loaded.path(), path("a.reach"));
  EXPECT_EQ(built.path(), "");
  EXPECT_EQ(loaded.key(), built.key());
  EXPECT_EQ(loaded.key(), ReachDatabase::cache_key(arm, small()));
  EXPECT_EQ(loaded.size(), built.size());
  EXPECT_EQ(loaded.cell_count(), built.cell_count());
  EXPECT_EQ(loaded.joint_count(), 7);
  EXPECT_EQ(loaded.reach(), built.reach());
  EXPECT_EQ(loaded.bounds().max(), built.bounds().max());
  EXPECT_EQ(loaded.bounds().min(), built.bounds().min());
  EXPECT_EQ(loaded.options().samples, small().samples);
  EXPECT_EQ(loaded.options().position_cell, small().position_cell);
  EXPECT_EQ(loaded.options().rotation_cell, small().rotation_cell);
  EXPECT_EQ(loaded.options().max_per_cell, small().max_per_cell);
  EXPECT_EQ(loaded.options().min_manipulability, small().min_manipulability);
  EXPECT_EQ(loaded.options().thinning, small().thinning);
  EXPECT_EQ(loaded.options().seed, small().seed);
  Eigen::MatrixXd a, b;
  for (std::int64_t i = 0; i < built.size(); i += 1009) {
    const Pose T = arm.fk(built.configuration(i));
    EXPECT_EQ(built.cell(T), loaded.cell(T));
    ASSERT_EQ(built.nearest(T, 6, a), loaded.nearest(T, 6, b));
    EXPECT_EQ(a, b);
    EXPECT_LT((loaded.tool_pose(i).matrix() - T.matrix()).norm(), 1e-12) << "from the file alone";
  }
  loaded.save(path("b.reach"));
  EXPECT_TRUE(test::read_folder(path("a.reach")) == test::read_folder(path("b.reach")));
}

TEST_F(ReachFile, RefusesEveryFileThatIsCut) {
  ReachDatabase::build(test::seven_joints_to("2.4"), small(5000)).save(path("d.reach"));
  const auto sound = test::read_folder(path("d.reach"));
  const auto refused = [&](const std::string& name, const std::string& what) {
    expect_io_error(name, what, [&] { ReachDatabase::load(path("d.reach")); });
  };
  for (const auto& [name, bytes] : sound) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{8}, bytes.size() / 2, bytes.size() - 1}) {
      auto cut = sound;
      cut[name] = bytes.substr(0, size);
      test::write_folder(path("d.reach"), cut);
      refused(name, "");
    }
    auto longer = sound;
    longer[name] += "x";
    test::write_folder(path("d.reach"), longer);
    refused(name, name == "meta.json" ? "JSON" : "bytes after the end");
    auto missing = sound;
    missing.erase(name);
    test::write_folder(path("d.reach"), missing);
    refused("d.reach", name);
  }
  test::write_folder(path("d.reach"), sound);
  EXPECT_NO_THROW(ReachDatabase::load(path("d.reach")));
}

TEST_F(ReachFile, NoFlippedBitGoesUnnoticed) {
  ReachDatabase::build(test::seven_joints_to("2.4"), small(5000)).save(path("f.reach"));
  const auto sound = test::read_folder(path("f.reach"));
  Rng rng(3);
  for (const auto& [name, bytes] : sound) {
    for (int trial = 0; trial < 40; ++trial) {
      auto flipped = sound;
      const std::size_t at = trial == 0 ? bytes.size() - 3 : rng.index(bytes.size());
      flipped[name][at] = static_cast<char>(bytes[at] ^ (1 << rng.index(8)));
      test::write_folder(path("f.reach"), flipped);
      if (name != "configurations.npy" || at < 128) {
        expect_refused(path("f.reach"), "");
        continue;
      }
      // The largest array is compared when asked for, or when it is first used.
      const auto database = ReachDatabase::load(path("f.reach"));
      expect_io_error(name, "differ from their checksum", [&] { database.verify(); });
      const auto again = ReachDatabase::load(path("f.reach"));
      expect_io_error(name, "corrupt", [&] {
        Eigen::MatrixXd out;
        for (std::int64_t i = 0; i < again.size(); ++i) again.configuration(i);
      });
      expect_io_error(name, "corrupt", [&] { again.save(path("copy.reach")); });
      expect_io_error(name, "corrupt", [&] { checked_reach_arrays(again); });
    }
  }
}

/// What was asked of a database, and what it answered.
struct Asked {
  int same = 0, refused = 0, other = 0;

  template <class Answer>
  void ask(const Answer& answer, const ReachDatabase& sound, const ReachDatabase& damaged) {
    const auto expected = answer(sound);
    try {
      ++(answer(damaged) == expected ? same : other);
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find("corrupt"), std::string::npos) << error.what();
      ++refused;
    }
  }
};

/// A database whose configurations were changed loads as quickly as any, and every question that meets them refuses:
/// no answer is another one.
TEST_F(ReachFile, ChangedConfigurationsNeverAnswer) {
  const JointGroup arm = test::seven_joints_to("2.4");
  ReachDatabase::build(arm, small()).save(path("g.reach"));
  const auto sound = ReachDatabase::load(path("g.reach"));
  const auto bytes = test::read_folder(path("g.reach"));
  Rng rng(5);
  Asked asked;
  for (int trial = 0; trial < 12; ++trial) {
    auto flipped = bytes;
    std::string& configurations = flipped["configurations.npy"];
    configurations[128 + rng.index(configurations.size() - 128)] ^= static_cast<char>(1 << rng.index(8));
    test::write_folder(path("h.reach"), flipped);
    for (std::int64_t i = trial; i < sound.size(); i += sound.size() / 12) {
      const auto damaged = ReachDatabase::load(path("h.reach"));  // anew: what refused once is not asked again
      const Pose T = sound.tool_pose(i);
      asked.ask([&](const ReachDatabase& d) { return d.configuration(i); }, sound, damaged);
      asked.ask([&](const ReachDatabase& d) { return d.tool_pose(i).matrix(); }, sound, damaged);
      asked.ask([&](const ReachDatabase& d) { return d.cell(T); }, sound, damaged);
      asked.ask(
          [&](const ReachDatabase& d) {
            Eigen::MatrixXd out;
            return Eigen::MatrixXd(out.leftCols(d.nearest(T, 6, out)));
          },
          sound, damaged);
      asked.ask([&](const ReachDatabase& d) { return solve_reach(d, arm, T); }, sound, damaged);
    }
  }
  EXPECT_EQ(asked.other, 0);
  EXPECT_GT(asked.refused, 100);
  EXPECT_GT(asked.same, 100);
}

/// With a right checksum again: an edit that was meant, not an accident.
std::string summed(std::string meta) {
  const std::size_t before = meta.rfind("\"crc32\"");
  std::uint32_t sum = ~0u;
  for (std::size_t i = 0; i < before; ++i) {
    sum ^= static_cast<unsigned char>(meta[i]);
    for (int bit = 0; bit < 8; ++bit) sum = sum & 1 ? (sum >> 1) ^ 0xedb88320u : sum >> 1;
  }
  return meta.substr(0, before) + "\"crc32\": " + std::to_string(~sum) + "\n}\n";
}

std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

TEST_F(ReachFile, RefusesForeignFilesAndEditedOnes) {
  ReachDatabase::build(test::seven_joints_to("2.4"), small(5000)).save(path("e.reach"));
  const auto sound = test::read_folder(path("e.reach"));
  const auto refused = [&](const std::string& name, const std::string& bytes, const std::string& what) {
    auto edited = sound;
    edited[name] = bytes;
    test::write_folder(path("e.reach"), edited);
    expect_refused(path("e.reach"), what);
  };
  const std::string& meta = sound.at("meta.json");
  EXPECT_EQ(summed(meta), meta) << "the checksum is the CRC-32 of zlib";
  refused("meta.json", with(meta, "\"version\": 2", "\"version\": 99"), "version 99");
  refused("meta.json", with(meta, "\"seed\": 1", "\"seed\": 3"), "checksum differs");
  refused("meta.json", summed(with(meta, "\"max_per_cell\": 2", "\"max_per_cell\": -2")), "max_per_cell");
  refused("meta.json", summed(with(meta, "\"position_cell\": 0.2", "\"position_cell\": -0.2")), "position_cell");
  refused("meta.json", summed(with(meta, "\"size\": ", "\"size\": 9")), "shape");
  refused("meta.json", summed(with(meta, "\"<u2\"", "\"<f4\"")), "type or shape");
  refused("meta.json", summed(with(meta, "\"tip\"", "\"top\"")), "\"tip\" is missing");
  refused("meta.json", summed(with(meta, "\"joint_step\": [", "\"joint_step\": [0.1, ")), "make no sense");
  refused("meta.json", summed(with(meta, "\"reach\": ", "\"reach\": 9")), "do not fit the cells");
  refused("meta.json", summed(with(meta, "\"bounds_lower\": [-", "\"bounds_lower\": [-9")), "do not fit the cells");
  refused("meta.json", "{\"name\": \"something else\"}", "not of a reachability database");
  refused("meta.json", std::string(100000, '['), "not of a reachability database");
  std::string other = with(sound.at("cell_first.npy"), "<u4", "<f4");
  refused("cell_first.npy", other, "type <u4");
  refused("cell_first.npy", std::string(sound.at("cell_first.npy").size(), 'a'), "header");

  // Tables that contradict each other, with every checksum right, never lead outside of the arrays.
  const auto number_at = [](std::string& bytes, std::size_t index, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes[192 + 4 * index + i] = static_cast<char>(value >> 8 * i);
  };
  for (const char* name : {"cell_first.npy", "position_first.npy", "rotation_ids.npy", "positions.npy"}) {
    for (const std::uint32_t value : {0xffffffffu, 0x7fffffffu}) {
      std::string bytes = sound.at(name);
      number_at(bytes, 7, value);
      std::uint32_t sums[2];
      for (int which = 0; which < 2; ++which) {
        std::uint32_t sum = ~0u;
        for (const char c : which ? bytes : sound.at(name)) {
          sum ^= static_cast<unsigned char>(c);
          for (int bit = 0; bit < 8; ++bit) sum = sum & 1 ? (sum >> 1) ^ 0xedb88320u : sum >> 1;
        }
        sums[which] = ~sum;
      }
      auto edited = sound;
      edited[name] = bytes;
      edited["meta.json"] = summed(with(meta, std::to_string(sums[0]), std::to_string(sums[1])));
      test::write_folder(path("e.reach"), edited);
      expect_refused(path("e.reach"), "corrupt: the ");
    }
  }

  test::write_bytes(path("old.reach"), "MMGREACH" + std::string(500, 'a'));
  expect_refused(path("old.reach"), "earlier versions; build it again");
  test::write_bytes(path("file.reach"), std::string(500, 'a'));
  expect_refused(path("file.reach"), "not a reachability database");
  expect_refused(path("absent.reach"), "no such file");
  fs::create_directories(path("empty"));
  expect_refused(path("empty"), "meta.json");
}

TEST_F(ReachFile, NoticesThatTheRobotHasChanged) {
  const JointGroup arm = test::seven_joints_to("2.4");
  const auto database = ReachDatabase::build(arm, small(2000));
  database.save(path("r.reach"));
  EXPECT_EQ(database.difference(arm), "");
  EXPECT_EQ(ReachDatabase::load(path("r.reach"), arm.at(pose_from_planar({1, 2, 3}))).size(), database.size());
  const JointGroup shorter = test::seven_joints_to("2.3");
  expect_io_error(path("r.reach"), "the upper limit of \"" + arm.names()[3] + "\" was 2.4, is 2.3",
                  [&] { ReachDatabase::load(path("r.reach"), shorter); });
  const Robot robot = arm.robot();
  EXPECT_NE(database.difference(robot.chain("column", robot.links().back().name == "tool"
                                                          ? robot.links()[robot.links().size() - 2].name
                                                          : robot.links().back().name)),
            "");
}

TEST_F(ReachFile, CannotBeWrittenWhereThereIsNoFolder) {
  const auto database = ReachDatabase::build(test::seven_joints_to("2.4"), small(100));
  EXPECT_THROW(database.save(path("no/such/folder/x.reach")), IoError);
  fs::create_directories(path("taken.reach/inside"));
  EXPECT_THROW(database.save(path("taken.reach")), IoError);
  EXPECT_EQ(entry_count(), 1u);  // the folder only: nothing temporary is left
  test::write_bytes(path("letter.txt"), "dear all");
  EXPECT_THROW(database.save(path("letter.txt")), IoError);
  EXPECT_EQ(test::read_bytes(path("letter.txt")), "dear all");
}

TEST_F(ReachFile, ASlashAtTheEndChangesNothing) {
  const auto database = ReachDatabase::build_to(path("a.reach/"), test::seven_joints_to("2.4"), small(100));
  EXPECT_EQ(database.path(), path("a.reach"));
  database.save(path("b.reach//"));
  EXPECT_EQ(entry_count(), 2u);
  EXPECT_TRUE(test::read_folder(path("a.reach")) == test::read_folder(path("b.reach")));
  EXPECT_THROW(database.save(""), IoError);
}

TEST_F(ReachFile, AStoppedBuildGoesOnWhereItWas) {
  const JointGroup arm = test::seven_joints_to("2.4");
  const ReachOptions options = small(600000);
  const auto whole = ReachDatabase::build_to(path("whole.reach"), arm, options);
  ASSERT_GT(whole.size(), 1000);
  const auto expected = test::read_folder(path("whole.reach"));

  const fs::path parts = path("r.reach.partial");
  const auto part_count = [&] {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(parts)) count += entry.path().extension() == ".part";
    return count;
  };
  std::size_t before = 0;
  for (const double until : {0.25, 0.6, 0.93}) {
    Monitor stopping;
    stopping.progress = [&](const std::string&, double fraction) {
      if (fraction > until) stopping.stop.stop();
    };
    EXPECT_EQ(ReachDatabase::build_to(path("r.reach"), arm, options, stopping).size(), 0);
    EXPECT_FALSE(fs::exists(path("r.reach"))) << "nothing that could be taken for whole";
    expect_refused(path("r.reach"), "no such file");
    expect_refused(parts.string(), "meta.json");
    EXPECT_GT(part_count(), before) << until;
    before = part_count();
  }
  // A damaged part and one of other options are made again; half a part is not a part.
  auto files = test::read_folder(parts);
  auto it = files.begin();
  it->second[it->second.size() / 2] ^= 4;
  (++it)->second.resize(it->second.size() - 1);
  test::write_folder(parts, files);
  test::write_bytes(parts / "000001.part.tmp", "half");
  double first = -1;
  Monitor watching;
  watching.progress = [&](const std::string&, double fraction) {
    if (first < 0 && fraction > 0) first = fraction;
  };
  const auto resumed = ReachDatabase::build_to(path("r.reach"), arm, options, watching);
  EXPECT_GT(first, 0.5) << "the work done before is not done again";
  EXPECT_TRUE(test::read_folder(path("r.reach")) == expected);
  EXPECT_FALSE(fs::exists(parts));

  ReachOptions other = options;
  other.seed = 5;
  const auto another = ReachDatabase::build(arm, other);
  Monitor stopping;
  stopping.progress = [&](const std::string&, double fraction) {
    if (fraction > 0.5) stopping.stop.stop();
  };
  ReachDatabase::build_to(path("o.reach"), arm, options, stopping);
  EXPECT_EQ(ReachDatabase::build_to(path("o.reach"), arm, other).size(), another.size());
  another.save(path("another.reach"));
  EXPECT_TRUE(test::read_folder(path("o.reach")) == test::read_folder(path("another.reach")));
}

TEST_F(ReachFile, ManyMaySaveTheSameDatabaseAtOnce) {
  const auto database = ReachDatabase::build(test::seven_joints_to("2.4"), small(2000));
  std::vector<std::thread> pool;
  for (int t = 0; t < 4; ++t)
    pool.emplace_back([&] {
      for (int i = 0; i < 10; ++i) database.save(path("s.reach"));
    });
  for (std::thread& thread : pool) thread.join();
  EXPECT_EQ(ReachDatabase::load(path("s.reach")).size(), database.size());
  EXPECT_EQ(entry_count(), 1u);
}

TEST_F(ReachFile, ManyThreadsMayUseAFreshDatabase) {
  const JointGroup arm = test::seven_joints_to("2.4");
  const auto built = ReachDatabase::build(arm, small());
  built.save(path("m.reach"));
  const auto loaded = ReachDatabase::load(path("m.reach"));
  std::vector<std::thread> pool;
  std::vector<int> wrong(4, 0);
  for (int t = 0; t < 4; ++t) {
    pool.emplace_back([&, t] {
      Eigen::MatrixXd a, b;
      for (std::int64_t i = 0; i < built.size(); i += 499) {
        const Pose T = built.tool_pose(i);
        const int found = loaded.nearest(T, 5, a);
        wrong[t] += found != built.nearest(T, 5, b) || a != b;
      }
    });
  }
  for (std::thread& thread : pool) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

TEST_F(ReachFile, CacheIsUsedWhenSoundAndRebuiltWhenNot) {
  const JointGroup arm = test::seven_joints_to("2.4");
  ReachOptions options = small();
  options.samples = 5000;
  const std::string cache = path("cache/reach");
  const auto first = ReachDatabase::load_or_build(arm, options, cache);
  const std::string file = (fs::path(cache) / (first.key() + ".reach")).string();
  ASSERT_TRUE(fs::exists(file));
  const auto sound = test::read_folder(file);

  int reports = 0;
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double) { reports += stage != "checksums"; };
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache, monitor).size(), first.size());
  EXPECT_EQ(reports, 0);  // checked and read, not built

  for (const auto& [name, bytes] : sound) {
    auto cut = sound;
    cut[name] = bytes.substr(0, bytes.size() / 2);
    auto flipped = sound;
    flipped[name][bytes.size() - 3] ^= 1;
    for (const auto& damaged : {cut, flipped}) {
      test::write_folder(file, damaged);
      bool told = false;
      Monitor listening;
      listening.progress = [&](const std::string& stage, double) {
        told = told || stage == "replacing a damaged reachability database";
      };
      EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache, listening).size(), first.size());
      EXPECT_TRUE(told) << name;
      EXPECT_TRUE(test::read_folder(file) == sound) << name;
      told = false;
      ReachDatabase::load_or_build(arm, options, cache, listening);
      EXPECT_FALSE(told) << name;
    }
  }
  // So is a cache in the one-file format of earlier versions.
  fs::remove_all(file);
  test::write_bytes(file, "MMGREACH" + std::string(200, 'x'));
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache, monitor).size(), first.size());
  EXPECT_GT(reports, 0);
  EXPECT_TRUE(test::read_folder(file) == sound);

  // A sound file of another arm under this name is not taken for this arm's.
  ReachDatabase::build(test::seven_joints_to("2.3"), options).save(file);
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache).key(), first.key());
  EXPECT_TRUE(test::read_folder(file) == sound);

  Monitor stopped;
  stopped.stop.stop();
  options.seed = 7;
  EXPECT_EQ(ReachDatabase::load_or_build(arm, options, cache, stopped).size(), 0);
  EXPECT_FALSE(fs::exists(fs::path(cache) / (ReachDatabase::cache_key(arm, options) + ".reach")));

  test::write_bytes(path("file"), "x");
  EXPECT_THROW(ReachDatabase::load_or_build(arm, options, path("file")), IoError);
}

TEST_F(ReachFile, KeyFollowsEverythingThatMattersAndNothingElse) {
  test::write_bytes(
      path("part.stl"),
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
  EXPECT_NE(key(test::seven_joints_to("2.4")), key(test::seven_joints_to("2.4000001")));

  for (int field = 0; field < 8; ++field) {
    ReachOptions changed = options;
    if (field == 0) ++changed.samples;
    if (field == 1) changed.position_cell += 1e-9;
    if (field == 2) changed.rotation_cell += 1e-9;
    if (field == 3) ++changed.max_per_cell;
    if (field == 4) changed.min_manipulability += 1e-9;
    if (field == 5) ++changed.seed;
    if (field == 6) changed.thinning += 1e-9;
    if (field == 7) changed.threads = 3;
    EXPECT_EQ(ReachDatabase::cache_key(arm, changed) == reference, field == 7) << field;
  }
}

}  // namespace
}  // namespace mmgrasp
