// What ProbabilisticSdf refuses: one clear message each, and the map stays as it was.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "mapping/sdf_scenes.hpp"
#include "mmgrasp/core/error.hpp"
#include "support/temporary_folder.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Vector3d;

namespace {

std::string message(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << text << "\" does not say \"" << part << "\"";
}

std::string read(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A corner of a room: enough shape for poses to be distinguished.
std::vector<PlacedShape> room() {
  return {{Box{{0.6, 0.6, 0.02}}, Pose(Eigen::Translation3d(0, 0, -0.01))},
          {Box{{0.10, 0.06, 0.08}}, Pose(Eigen::Translation3d(0.02, 0.03, 0.04))},
          {Sphere{0.03}, Pose(Eigen::Translation3d(-0.06, -0.04, 0.03))}};
}

class BadFrame : public ::testing::Test {
 protected:
  BadFrame() : camera_(small_camera()), good_(frame_of(room(), camera_, look_at({0.15, 0.1, 0.3}, {0, 0, 0.02}))) {}

  /// The change is refused with these words, on an empty map and on one that has a frame.
  void refuses(const std::function<void(DepthImage&, DepthCamera&, FrameUncertainty&)>& change, const char* words) {
    for (const bool second : {false, true}) {
      ProbabilisticSdf sdf;
      if (second) sdf.integrate(good_, camera_);
      const TemporaryFolder folder;
      const std::string path = folder.file("bad_frame.sdf");
      sdf.save(path);
      const std::string before = read(path);
      DepthImage image = good_;
      DepthCamera camera = camera_;
      FrameUncertainty uncertainty;
      change(image, camera, uncertainty);
      expect_contains(message([&] { sdf.integrate(image, camera, uncertainty); }), words);
      sdf.save(path);
      EXPECT_EQ(read(path), before) << words;
    }
  }

  DepthCamera camera_;
  DepthImage good_;
};

}  // namespace

TEST_F(BadFrame, WrongDepthScale) {
  refuses(
      [](auto& image, auto&, auto&) {
        for (float& z : image.depth) z *= 1000;
      },
      "divided by 1000");
  refuses(
      [](auto& image, auto&, auto&) {
        for (float& z : image.depth) z /= 1000;
      },
      "multiplied by 1000");
  refuses(
      [](auto& image, auto&, auto&) {
        for (float& z : image.depth) z *= 40;
      },
      "none is in the camera's range");
}

TEST_F(BadFrame, Intrinsics) {
  refuses([](auto&, auto& camera, auto&) { camera.intrinsics.fx = -525; }, "camera.fx = -525");
  refuses([](auto&, auto& camera, auto&) { camera.intrinsics.fx = 300; }, "other intrinsics");
  refuses([](auto&, auto& camera, auto&) { camera.intrinsics.width = 320; },
          "160 x 120 pixels: must have the size of camera 'camera', 320 x 120");
  refuses([](auto& image, auto&, auto&) { image.depth.pop_back(); }, "19199 pixels");
}

TEST_F(BadFrame, NothingMeasured) {
  refuses([](auto& image, auto&, auto&) { image.depth.assign(image.depth.size(), 0.0f); }, "no pixel measured");
  refuses([](auto& image, auto&, auto&) { image.depth.assign(image.depth.size(), NAN); }, "no pixel measured");
  refuses([](auto& image, auto&, auto&) { image.depth.assign(image.depth.size(), -1.0f); }, "no pixel measured");
  refuses([](auto& image, auto&, auto&) { image.depth.clear(); }, "0 pixels");
}

TEST_F(BadFrame, Poses) {
  refuses([](auto& image, auto&, auto&) { image.T_world_camera.linear() *= 1.01; }, "T_world_camera");
  refuses([](auto& image, auto&, auto&) { image.T_world_camera.linear().col(0) *= -1; }, "T_world_camera");
  refuses([](auto& image, auto&, auto&) { image.T_world_camera.translation().x() = NAN; }, "T_world_camera");
}

TEST_F(BadFrame, Uncertainty) {
  refuses([](auto&, auto&, auto& u) { u.pose_covariance(0, 0) = -1e-6; }, "negative eigenvalue");
  refuses([](auto&, auto&, auto& u) { u.pose_covariance(0, 1) = 1e-6; }, "must be symmetric");
  refuses([](auto&, auto&, auto& u) { u.pose_covariance(2, 2) = NAN; }, "pose_covariance");
  refuses([](auto&, auto&, auto& u) { u.sigma.assign(7, 0.001f); }, "sigma = 7 pixels");
  refuses([](auto& image, auto&, auto& u) { u.sigma.assign(image.depth.size(), 0.0f); }, "sigma = 0");
  refuses([](auto&, auto& camera, auto&) { camera.noise = constant_noise(0.02); }, "three standard deviations");
}

TEST_F(BadFrame, OnePoseTheWrongWayRound) {
  std::vector<Pose> poses;
  for (int k = 0; k < 6; ++k)
    poses.push_back(look_at({0.3 * std::cos(0.5 * k), 0.3 * std::sin(0.5 * k), 0.25 + 0.03 * (k % 3)}, {0, 0, 0.02}));
  for (std::size_t wrong = 0; wrong < poses.size(); ++wrong) {
    ProbabilisticSdf sdf;
    std::vector<std::string> said;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      DepthImage image = frame_of(room(), camera_, poses[k]);
      if (k == wrong) image.T_world_camera = poses[k].inverse();
      std::string warning;
      const std::string refused = message([&] { warning = sdf.integrate(image, camera_).warning; });
      said.push_back(refused == "accepted" ? warning : refused);
    }
    if (wrong == 0) {  // Nothing can be said of it until another frame is there.
      EXPECT_NE(said[1].find("when the earlier one's pose is inverted"), std::string::npos) << said[1];
      continue;
    }
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (k == wrong)
        EXPECT_NE(said[k].find("when its own pose is inverted"), std::string::npos) << k << ": " << said[k];
      else
        EXPECT_EQ(said[k], "") << wrong << " is inverted, " << k << " is not";
    }
  }
}

TEST_F(BadFrame, PosesTheWrongWayRound) {
  ProbabilisticSdf sdf;
  std::vector<Pose> poses;
  for (int k = 0; k < 6; ++k) poses.push_back(look_at({0.15 - 0.05 * k, 0.02 * k, 0.3}, {0, 0, 0.02}));
  std::string said;
  int taken = 0;
  for (const Pose& pose : poses) {
    DepthImage image = frame_of(room(), camera_, pose);
    image.T_world_camera = pose.inverse();
    said = message([&] { sdf.integrate(image, camera_); });
    if (said != "accepted") break;
    ++taken;
  }
  expect_contains(said, "when the poses are inverted");
  EXPECT_EQ(sdf.frames(), taken);
  EXPECT_LE(taken, 3);
  // The right way round nothing is said.
  ProbabilisticSdf right;
  for (const Pose& pose : poses) {
    const IntegrationReport report = right.integrate(frame_of(room(), camera_, pose), camera_);
    EXPECT_EQ(report.warning, "");
    if (right.frames() > 1) {
      EXPECT_GT(report.agreement, 0.7);
    }
  }
  // A pose that fits neither way is integrated with a warning.
  DepthImage off = frame_of(room(), camera_, poses[0]);
  off.T_world_camera.translation().z() += 0.15;
  expect_contains(right.integrate(off, camera_).warning, "is its pose right?");
}

TEST_F(BadFrame, OneNameForTwoCameras) {
  ProbabilisticSdf sdf;
  sdf.integrate(good_, camera_);
  DepthCamera other = camera_;
  other.systematic = 0.001;
  expect_contains(message([&] { sdf.integrate(good_, other); }), "is the name of a camera with another systematic");
  other.name = "other";
  EXPECT_EQ(message([&] { sdf.integrate(good_, other); }), "accepted");
}

TEST_F(BadFrame, MapTooLargeForTheMemory) {
  SdfOptions options;
  options.max_memory = 1e6;
  ProbabilisticSdf sdf(options);
  const std::string said = message([&] { sdf.integrate(good_, camera_); });
  expect_contains(said, "max_memory = 1 MB: the map has 0 MB and this frame would add up to");
  EXPECT_EQ(sdf.blocks(), 0u);
  options.voxel = 2e-6;
  options.truncation = 6e-5;
  options.max_memory = 2e9;
  ProbabilisticSdf fine(options);
  DepthCamera exact = camera_;
  exact.noise = constant_noise(1e-5);
  expect_contains(message([&] { fine.integrate(good_, exact); }), "max_memory = 2000 MB");
}

TEST_F(BadFrame, SomePixelsAreCountedByCause) {
  DepthImage image = good_;
  image.depth[5] = NAN;
  image.depth[6] = -3;
  image.depth[7] = 0;
  image.depth[8] = 7;      // beyond the camera's range
  image.depth[9] = 0.05f;  // too near
  ProbabilisticSdf sdf;
  const IntegrationReport report = sdf.integrate(image, camera_);
  EXPECT_EQ(report.out_of_range, 2);
  EXPECT_EQ(report.measured,
            report.used + report.out_of_range + report.too_noisy + report.without_normal + report.too_slanted);
  EXPECT_GT(report.used, 0.8 * report.measured);
  EXPECT_EQ(report.new_blocks, static_cast<int>(sdf.blocks()));
  EXPECT_TRUE(std::isnan(report.agreement));
}

TEST(SdfOptions, BadFieldsAreNamed) {
  const auto with = [](const auto& change) {
    SdfOptions options;
    change(options);
    return message([&] { ProbabilisticSdf sdf(options); });
  };
  expect_contains(with([](SdfOptions& o) { o.voxel = 0; }), "voxel");
  expect_contains(with([](SdfOptions& o) { o.voxel = 0.004; }), "at least three voxels");
  expect_contains(with([](SdfOptions& o) { o.truncation = NAN; }), "truncation");
  expect_contains(with([](SdfOptions& o) { o.max_incidence = 1.6; }), "max_incidence");
  expect_contains(with([](SdfOptions& o) { o.max_memory = -1; }), "max_memory");
  expect_contains(with([](SdfOptions& o) { o.threads = -1; }), "threads");
}

TEST(SdfQueries, BadArgumentsAreNamed) {
  const ProbabilisticSdf sdf;
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, 4), directions = Eigen::Matrix3Xd::Ones(3, 4);
  directions.col(1).setZero();
  expect_contains(message([&] { sdf.cast_rays(points, directions); }), "direction 1: must not be zero");
  expect_contains(message([&] { sdf.cast_rays(points, Eigen::Matrix3Xd::Ones(3, 5)); }), "directions = 5");
  points(1, 2) = NAN;
  expect_contains(message([&] { sdf.query(points); }), "point 2.y = nan: must be finite");
  expect_contains(message([&] { sdf.cast_rays(points, Eigen::Matrix3Xd::Ones(3, 4)); }),
                  "origin 2.y = nan: must be finite");
}

TEST_F(BadFrame, FilesThatAreNoMap) {
  const TemporaryFolder folder;
  const std::string path = folder.file("map.sdf");
  SdfOptions options;
  options.voxel = 0.006;
  options.truncation = 0.02;
  ProbabilisticSdf sdf(options);
  sdf.integrate(good_, camera_);
  DepthCamera biased = camera_;
  biased.name = "biased";
  biased.systematic = 0.001;
  sdf.integrate(good_, biased);
  sdf.save(path);
  const std::string bytes = read(path);

  // What comes back is the same map, and goes on as it would have.
  ProbabilisticSdf again = ProbabilisticSdf::load(path);
  again.save(path);
  EXPECT_EQ(read(path), bytes);
  EXPECT_EQ(again.frames(), 2);
  const DepthImage next = frame_of(room(), camera_, look_at({0.1, 0.12, 0.3}, {0, 0, 0.02}));
  EXPECT_EQ(again.integrate(next, camera_).agreement, sdf.integrate(next, camera_).agreement);
  const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Random(3, 5000) * 0.1;
  const SdfValues a = sdf.query(points), b = again.query(points);
  EXPECT_EQ(a.known, b.known);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (a.known[i]) {
      EXPECT_EQ(a.mean[i], b.mean[i]);
    }
  }

  const auto refused = [&](const std::string& content) {
    write(path, content);
    return message([&] { ProbabilisticSdf::load(path); });
  };
  for (std::size_t size = 1; size < bytes.size(); size += 1 + size / 3) {
    expect_contains(refused(bytes.substr(0, size)), size < 26 ? "is no map" : "truncated");
  }
  expect_contains(refused("ply\nformat ascii 1.0\nelement vertex 3\n and so on"), "is no map of mmgrasp");
  expect_contains(refused(bytes + "x"), "bytes after the end");
  expect_contains(refused(""), "empty");
  std::string other = bytes;
  other[26] = 9;
  expect_contains(refused(other), "has version 9 of the format, this program reads version 2");
  Rng rng(4);
  for (int k = 0; k < 40; ++k) {
    std::string damaged = bytes;
    damaged[38 + rng.index(damaged.size() - 38)] ^= static_cast<char>(1 << rng.index(8));
    expect_contains(refused(damaged), "checksum");
  }
  expect_contains(message([&] { ProbabilisticSdf::load(folder.file("none.sdf")); }), "does not exist");
  expect_contains(message([&] { sdf.save("/nowhere/at/all/map.sdf"); }), "cannot be written");
}
