#pragma once

#include <cmath>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/grasp/graspability.hpp"
#include "mmgrasp/grasp/random_placement.hpp"
#include "mmgrasp/mapping/height_map.hpp"
#include "support/free_body.hpp"

/// Trays seen by a camera above, and the hand's own body beside the true shapes.
namespace tray_scene {

using namespace mmgrasp;
using Eigen::Vector3d;

inline Hand gripper() {
  Hand g;
  g.tool_link = "tcp";
  g.max_opening = 0.1;
  g.finger_depth = 0.04;
  g.finger_width = 0.022;
  g.clearance = 0.01;
  return g;
}

inline LinkShape at(const Shape& shape, const Pose& T = Pose::Identity()) {
  LinkShape out;
  out.shape = shape;
  out.T_link_shape = T;
  return out;
}

inline Pose flat(double x, double y, double z, double yaw = 0) {
  Pose T = Pose(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  T.translation() << x, y, z;
  return T;
}

inline HeightMap map_of(const std::vector<PlacedShape>& scene, const Eigen::Vector2d& size, double resolution = 0.002,
                        const RenderOptions& render = {}, DepthImage* image = nullptr) {
  PinholeCamera camera;
  const DepthImage seen = render_depth(scene, camera, look_down({0, 0, 0.8}), render);
  if (image) *image = seen;
  HeightMapOptions options;
  options.resolution = resolution;
  return make_height_map(seen, Pose::Identity(), size, options);
}

/// The hand as boxes in the tool frame, approach x, closing y, as HandBody describes it.
inline std::vector<LinkShape> hand_body(const Hand& g, double opening) {
  const HandBody& hand = g.body;
  std::vector<LinkShape> shapes;
  const double tip = g.finger_depth / 2, middle = tip - hand.finger_length / 2;
  for (const double side : {-1.0, 1.0}) {
    shapes.push_back(at(Box{{hand.finger_length, hand.finger_thickness, g.finger_width}},
                        Pose(Eigen::Translation3d(middle, side * (opening + hand.finger_thickness) / 2, 0))));
  }
  shapes.push_back(at(Box{{0.05, hand.palm_length, hand.palm_width}},
                      Pose(Eigen::Translation3d(tip - hand.finger_length - 0.025, 0, 0))));
  return shapes;
}

/// Asks the collision checker whether the open hand at a grasp touches the true bodies.
inline bool hand_is_free(const Grasp& grasp, const Hand& g, const World& world) {
  CollisionChecker checker(free_body::group(hand_body(g, g.pregrasp_opening(grasp.opening))), world);
  const Vector3d rpy = rpy_from_rotation(grasp.T_object_hand.linear());
  Eigen::VectorXd q(6);
  q << grasp.T_object_hand.translation(), rpy.z(), rpy.y(), rpy.x();
  return checker.is_free(q);
}

inline World world_of(const std::vector<PlacedShape>& scene) {
  World world;
  for (std::size_t i = 0; i < scene.size(); ++i)
    world.add("body " + std::to_string(i), scene[i].shape, scene[i].T_world_shape);
  return world;
}

inline void add(std::vector<PlacedShape>& scene, const std::vector<LinkShape>& body, const Pose& T) {
  for (const LinkShape& shape : body) scene.push_back({shape.shape, T * shape.T_link_shape});
}

}  // namespace tray_scene
