#include "mmgrasp/collision/world.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;

namespace {

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(World, NamesAreUniqueOverSceneAndHands) {
  World world;
  world.add("a", Sphere{1}, Pose::Identity());
  EXPECT_NE(message_of([&] { world.add("a", Sphere{1}, Pose::Identity()); }).find("in use"), std::string::npos);
  world.attach("a", "hand", Pose::Identity());
  EXPECT_TRUE(world.has("a"));
  EXPECT_TRUE(world.objects().empty());
  EXPECT_NE(message_of([&] { world.add("a", Sphere{1}, Pose::Identity()); }), "");
  EXPECT_NE(message_of([&] { world.attach("a", "hand", Pose::Identity()); }).find("attached already"),
            std::string::npos);
  EXPECT_NE(message_of([&] { world.move("a", Pose::Identity()); }).find("is attached"), std::string::npos);
  const World snapshot = world;
  const Pose T = pose_from_xyz_rpy({1, 2, 3}, {0.1, 0.2, 0.3});
  world.detach("a", T);
  EXPECT_TRUE(world.objects().at("a").T_world_object.isApprox(T));
  EXPECT_TRUE(world.attached().empty());
  EXPECT_EQ(snapshot.attached().count("a"), 1u);
  world.remove("a");
  EXPECT_FALSE(world.has("a"));
}

TEST(World, BadInputIsNamed) {
  World world;
  world.add("ball", Sphere{1}, Pose::Identity());
  Pose skewed = Pose::Identity();
  skewed.linear() *= 1.1;
  Pose lost = Pose::Identity();
  lost.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of([&] {
              world.add("box", Box{{1, 0, 1}}, Pose::Identity());
            }).find("'box' shape 0.size.y"),
            std::string::npos);
  EXPECT_NE(message_of([&] { world.add("box", Sphere{1}, skewed); }).find("'box' pose"), std::string::npos);
  EXPECT_NE(message_of([&] { world.add("box", Sphere{1}, lost); }).find("'box' pose"), std::string::npos);
  EXPECT_NE(message_of([&] { world.add("", Sphere{1}, Pose::Identity()); }), "");
  EXPECT_NE(message_of([&] { world.add("none", WorldObject()); }).find("shapes"), std::string::npos);
  EXPECT_FALSE(world.has("box"));
  EXPECT_NE(message_of([&] { world.move("box", Pose::Identity()); }).find("box"), std::string::npos);
  EXPECT_NE(message_of([&] { world.remove("box"); }).find("box"), std::string::npos);
  EXPECT_NE(message_of([&] { world.attach("box", "hand", Pose::Identity()); }).find("box"), std::string::npos);
  EXPECT_NE(message_of([&] { world.attach("ball", "hand", lost); }).find("ball"), std::string::npos);
  EXPECT_NE(message_of([&] { world.detach("ball", Pose::Identity()); }).find("not attached"), std::string::npos);
  world.add("floor", Plane{}, Pose::Identity());
  EXPECT_NE(message_of([&] { world.attach("floor", "hand", Pose::Identity()); }).find("plane"), std::string::npos);
  EXPECT_TRUE(world.has("floor"));
}
