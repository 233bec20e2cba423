#include "task/pick/release.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "task/problem/full_turns.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kYaws = 12;
constexpr int kSeeds = 3;
constexpr double kPlaceShare =
    0.4;  // Places lie within this part of the region's size from its middle: clear of its edge.

double lowest(const Part& part, const Pose& T) {
  double z = kInfinity;
  for (const LinkShape& shape : part.shapes)
    z = std::min(z, shape_bounds(shape.shape, T * shape.T_link_shape).min().z());
  return z;
}

}  // namespace

UnloadRegion top_of_bin(const PlaceRegion& bin, const Pose& T_world_root) {
  return {T_world_root * bin.T_base_bin, bin.size, bin.drop_height};
}

std::vector<Pose> places_over(const UnloadRegion& region, const Part& part) {
  const Pose& T_world_region = region.T_world_region;
  std::vector<Pose> places;
  for (const auto& [x, y] : {std::pair{0, 0}, {0, 1}, {0, -1}, {1, 0}, {-1, 0}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
    for (int k = 0; k < kYaws; ++k) {
      Pose T_world_part = Pose::Identity();
      T_world_part.linear() = Eigen::AngleAxisd(kTwoPi * k / kYaws, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                              part.T_world_part.linear();
      Pose T_region_part = T_world_region.inverse() * T_world_part;
      T_region_part.translation() =
          Eigen::Vector3d(kPlaceShare * x * region.size.x(), kPlaceShare * y * region.size.y(), 0);
      T_region_part.translation().z() = region.drop_height - lowest(part, T_region_part);
      places.push_back(T_world_region * T_region_part);
    }
  }
  return places;
}

std::vector<Eigen::VectorXd> release_configurations(const ReachDatabase& database, CollisionChecker& holding,
                                                    const std::vector<Pose>& places, const Pose& T_hand_object,
                                                    const Eigen::VectorXd& from, std::size_t count,
                                                    Rejections& rejections) {
  const Pose T_object_hand = T_hand_object.inverse();
  const JointGroup& arm = holding.group();
  const Pose T_root_world = arm.T_world_root().inverse();
  IkOptions ik;
  IkWorkspace workspace;
  Eigen::MatrixXd seeds;
  std::vector<Eigen::VectorXd> found;
  for (const Pose& T_world_object : places) {
    if (found.size() >= count) break;
    const Pose T_world_hand = T_world_object * T_object_hand;
    const int near = database.nearest(T_root_world * T_world_hand, kSeeds, seeds);
    if (near == 0) rejections.add(Rejection::unreachable);
    for (int i = 0; i < near; ++i) {
      Eigen::VectorXd q = seeds.col(i).head(arm.size());
      const Rejection cause =
          refine_ik(arm, T_world_hand, q, ik, workspace) ? holding.rejection(q) : Rejection::unreachable;
      if (cause == Rejection::none) {
        turn_towards(arm, from, q);
        found.push_back(q);
        break;
      }
      rejections.add(cause);
    }
  }
  std::stable_sort(found.begin(), found.end(), [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a - from).norm() < (b - from).norm();
  });
  return found;
}

}  // namespace mmgrasp::detail
