#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/reach/capability_map.hpp"
#include "support/reach_arms.hpp"
#include "support/temporary_folder.hpp"

namespace mmgrasp {
namespace {

TEST(CapabilityMapFile, ComesBackAsItWasAndRefusesWhatIsCorrupt) {
  namespace fs = std::filesystem;
  CapabilityOptions options;
  options.lower = {-1.2, -1.2, -0.6};
  options.upper = {1.2, 1.2, 1.4};
  options.voxel = 0.4;
  options.poses = 12;
  const auto map = CapabilityMap::build(test::seven_joints(), World{}, options);
  const test::TemporaryFolder temporary;
  const std::string folder = temporary.file("map");
  map.save(folder);
  map.save(folder);  // in place of the first
  const auto back = CapabilityMap::load(folder);
  EXPECT_EQ(back.classes(), map.classes());
  EXPECT_EQ(back.configurations(), map.configurations());
  EXPECT_EQ(back.index(), map.index());
  EXPECT_EQ(back.arm_key(), map.arm_key());
  EXPECT_EQ(back.shape(), map.shape());
  EXPECT_TRUE(back.rejections() == map.rejections());
  EXPECT_EQ(back.restricted(test::seven_joints(), World{}).classes(), map.classes());
  const auto refused = [&](const std::string& file, std::streamoff at, const std::string& word) {
    const std::string path = (fs::path(folder) / file).string();
    std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(at);
    const char was = static_cast<char>(stream.get());
    stream.seekp(at);
    stream.put(static_cast<char>(was ^ 1));
    stream.close();
    try {
      CapabilityMap::load(folder);
      ADD_FAILURE() << file << " was taken";
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    std::fstream again(path, std::ios::binary | std::ios::in | std::ios::out);
    again.seekp(at);
    again.put(was);
  };
  refused("classes.npy", 500, "classes.npy");
  refused("configurations.npy", 400, "configurations.npy");
  refused("index.npy", 300, "index.npy");
  refused("meta.json", 60, "meta.json");
  fs::resize_file(fs::path(folder) / "classes.npy", 600);
  EXPECT_THROW(CapabilityMap::load(folder), IoError);
  fs::remove_all(folder);
  EXPECT_THROW(CapabilityMap::load(folder), IoError);
}

}  // namespace
}  // namespace mmgrasp
