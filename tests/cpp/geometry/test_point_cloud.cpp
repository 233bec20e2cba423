#include "mmgrasp/geometry/point_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;

namespace {

const std::filesystem::path kClouds = std::filesystem::path(std::string(MMGRASP_SHARED_DATA)) / "clouds";

class PointCloudFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("mmgrasp_pcd_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& content) const {
    const std::string path = folder_ / "cloud.pcd";
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }

  void refuses(const std::string& content, const std::string& reason) const {
    const std::string path = file(content);
    try {
      read_pcd(path);
      ADD_FAILURE() << "read: " << reason;
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  std::filesystem::path folder_;
};

const std::string kHeader = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

template <typename T>
std::string bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

TEST_F(PointCloudFile, ReadsTextWithOtherFieldsBetween) {
  const PointCloud cloud = read_pcd(
      file("# made by hand\nVERSION 0.7\nFIELDS n x y label z\nSIZE 4 4 4 2 8\nTYPE F F F U F\nCOUNT 3 1 1 1 1\n"
           "WIDTH 2\nHEIGHT 2\nVIEWPOINT 1 2 3 0 0 0 1\nPOINTS 4\nDATA ascii\n"
           "9 9 9 1 2 7 3\n9 9 9 nan nan 0 nan\r\n9 9 9 -1e-3 +2 8 3.5\n\n9 9 9 4 5 9 6"));
  ASSERT_EQ(cloud.points.size(), 4u);
  EXPECT_EQ(cloud.width, 2);
  EXPECT_EQ(cloud.height, 2);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(cloud.points[1].array().isNaN().all());
  EXPECT_EQ(cloud.points[2], Eigen::Vector3d(-1e-3, 2, 3.5));
  EXPECT_EQ(cloud.labels, (std::vector<int>{7, 0, 8, 9}));
  EXPECT_EQ(cloud.T_world_sensor.translation(), Eigen::Vector3d(1, 2, 3));
  // Half a turn about z.
  EXPECT_LT((cloud.T_world_sensor.linear() * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_TRUE(cloud.warning.empty());
}

TEST_F(PointCloudFile, ReadsBinaryAndItsCompressedTwinAlike) {
  const std::vector<float> rows{1, 2, 3, 4, 5, 6, 1, 2, 3};
  const PointCloud plain = read_pcd(file(kHeader + "WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA binary\n" + bytes(rows)));
  // Field after field: x x x y y y z z z, packed by hand. The third x repeats the first eight bytes before it.
  const std::vector<float> lanes{1, 4, 1, 2, 5, 2, 3, 6, 3};
  std::string packed;
  const std::string all = bytes(lanes);
  for (std::size_t i = 0; i < all.size(); i += 12) {
    packed += static_cast<char>(7);  // eight bytes as they are
    packed += all.substr(i, 8);
    packed += static_cast<char>((4 - 2) << 5);  // four bytes from eight back
    packed += static_cast<char>(7);
  }
  const std::uint32_t sizes[2] = {static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(all.size())};
  const PointCloud compressed = read_pcd(file(kHeader + "WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA binary_compressed\n" +
                                              std::string(reinterpret_cast<const char*>(sizes), 8) + packed));
  ASSERT_EQ(plain.points.size(), 3u);
  EXPECT_EQ(plain.points[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(compressed.points, plain.points);
}

TEST_F(PointCloudFile, RefusesWhatIsDamaged) {
  refuses("", "is empty");
  refuses("solid cube\n", "unknown header entry");
  refuses(kHeader, "no line DATA");
  refuses("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nPOINTS 1\nDATA ascii\n1 2\n", "must hold z");
  refuses(kHeader + "WIDTH 2\nHEIGHT 2\nPOINTS 5\nDATA ascii\n", "must be WIDTH * HEIGHT");
  refuses(kHeader + "WIDTH -1\nDATA ascii\n", "WIDTH");
  refuses(kHeader + "WIDTH 2\nDATA ascii\n1 2 3\n", "announces 2 points, the file holds 1");
  refuses(kHeader + "WIDTH 1\nDATA ascii\n1 2\n", "line 8");
  refuses(kHeader + "WIDTH 1\nDATA ascii\n1 2 cow\n", "'cow' is no number");
  refuses(kHeader + "WIDTH 2\nDATA binary\n" + bytes(std::vector<float>{1, 2, 3}), "truncated");
  refuses(kHeader + "WIDTH 1\nDATA zipped\n", "DATA");
  refuses(kHeader + "WIDTH 1\nDATA binary_compressed\nabc", "truncated");
  const std::uint32_t sizes[2] = {2, 12};
  const std::string head(reinterpret_cast<const char*>(sizes), 8);
  refuses(kHeader + "WIDTH 1\nDATA binary_compressed\n" + head + std::string("\x20\x05", 2), "damaged");
  refuses(kHeader + "WIDTH 9\nDATA binary_compressed\n" + head + "xx", "must be 108");
  refuses("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nDATA ascii\n", "field z");
  EXPECT_THROW(read_pcd(folder_ / "missing.pcd"), IoError);
}

TEST_F(PointCloudFile, WritesWhatItReadsBack) {
  PointCloud cloud;
  cloud.width = 2;
  cloud.height = 2;
  cloud.points = {{1, 2, 3}, Eigen::Vector3d::Constant(NAN), {0.5, -0.25, 8}, {0, 0, 0}};
  cloud.labels = {3, 0, -1, 70000};
  cloud.T_world_sensor.translation() << 1, 0.5, 2;
  const std::string path = folder_ / "out.pcd";
  write_pcd(path, cloud);
  const PointCloud again = read_pcd(path);
  EXPECT_EQ(again.width, 2);
  EXPECT_EQ(again.height, 2);
  EXPECT_EQ(again.labels, cloud.labels);
  EXPECT_EQ(again.points[2], cloud.points[2]);
  EXPECT_TRUE(std::isnan(again.points[1].x()));
  EXPECT_TRUE(again.T_world_sensor.isApprox(cloud.T_world_sensor));
  cloud.width = 3;
  EXPECT_THROW(write_pcd(path, cloud), InvalidInput);
  cloud.width = 2;
  EXPECT_THROW(write_pcd(folder_ / "none" / "out.pcd", cloud), IoError);
}

TEST(PointCloudData, EveryFileReadsWithTheCountItHolds) {
  if (!std::filesystem::exists(kClouds)) GTEST_SKIP() << "no reference data";
  // Points as the files' own headers say, but two headers that say 200 where 208 rows follow.
  const std::map<std::string, std::size_t> counts{{"haf/pcd1.pcd", 2935},
                                                  {"haf/pcd4.pcd", 208},
                                                  {"haf/pcd5.pcd", 208},
                                                  {"haf/plastic_mug2.pcd", 9549},
                                                  {"gpd/krylon.pcd", 4467},
                                                  {"open3d/Feature/cloud_bin_0.pcd", 3903},
                                                  {"pcl/lamppost.pcd", 1771},
                                                  {"pcl/template_alignment/object_template_0.pcd", 1397},
                                                  {"pcl/correspondence_grouping/milk.pcd", 12575},
                                                  {"pcl/table_scene_mug_stereo_textured.pcd", 307200},
                                                  {"pcl/mOSD/learn0.pcd", 307200}};
  for (const auto& [name, count] : counts) {
    const PointCloud cloud = read_pcd(kClouds / name);
    EXPECT_EQ(cloud.points.size(), count) << name;
    EXPECT_EQ(static_cast<std::size_t>(cloud.width) * cloud.height, count) << name;
    EXPECT_EQ(!cloud.warning.empty(), name == "haf/pcd4.pcd" || name == "haf/pcd5.pcd") << name << cloud.warning;
  }
  const PointCloud first = read_pcd(kClouds / "haf/pcd1.pcd");
  EXPECT_EQ(first.points[0], Eigen::Vector3d(-0.002637088, 0.06446785, 0.2131558));
}

TEST(PointCloudData, OrganisedKinectCloudIsAPinholeImage) {
  if (!std::filesystem::exists(kClouds)) GTEST_SKIP() << "no reference data";
  const PointCloud cloud = read_pcd(kClouds / "pcl/mOSD/learn0.pcd");
  ASSERT_EQ(cloud.width, 640);
  ASSERT_EQ(cloud.labels.size(), cloud.points.size());
  // Wrongly unpacked bytes would not lie on the rays of one focal length.
  int measured = 0;
  for (int v = 0; v < cloud.height; ++v) {
    for (int u = 0; u < cloud.width; ++u) {
      const Eigen::Vector3d& p = cloud.points[static_cast<std::size_t>(v) * cloud.width + u];
      if (!p.allFinite() || std::abs(u - 319.5) < 50 || std::abs(v - 239.5) < 50) continue;
      ++measured;
      ASSERT_NEAR((u - 319.5) * p.z() / p.x(), 525, 8);
      ASSERT_NEAR((v - 239.5) * p.z() / p.y(), 525, 8);
    }
  }
  EXPECT_GT(measured, 10000);
}
