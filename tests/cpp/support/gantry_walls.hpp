#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "mmgrasp/plan/manipulation.hpp"

namespace mmgrasp::test {

/// A box in the plane whose sides are parallel to the axes.
struct Rectangle {
  double low_x, high_x, low_y, high_y;
};

/// A gantry that moves a cube past walls, and the exact cost of the best path. With `wrist` four more joints turn and
/// lift the hand, which touches nothing: a path's cost is then that of its first two joints and of the straight line of
/// the others at right angles to it.
struct GantryWalls {
  ManipulationProblem problem;
  double optimum;
};

namespace gantry_walls {

constexpr double kWidth = 2, kDepth = 1.2, kHalfCube = 0.02;

inline std::string urdf(bool wrist) {
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& axis, double lower, double upper) {
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" +
           child + "\"/><axis xyz=\"" + axis + "\"/><limit lower=\"" + std::to_string(lower) + "\" upper=\"" +
           std::to_string(upper) + "\" velocity=\"1\" effort=\"1\"/></joint>";
  };
  const std::string cube = std::to_string(2 * kHalfCube);
  std::string out =
      "<robot name=\"gantry\"><link name=\"frame\"/><link name=\"bridge\"/><link name=\"stage\"><collision><geometry>"
      "<box size=\"" +
      cube + " " + cube + " " + cube + "\"/></geometry></collision></link>" +
      joint("x", "prismatic", "frame", "bridge", "1 0 0", 0, kWidth) +
      joint("y", "prismatic", "bridge", "stage", "0 1 0", 0, kDepth);
  if (wrist)
    out += "<link name=\"lift\"/><link name=\"w1\"/><link name=\"w2\"/><link name=\"hand\"/>" +
           joint("z", "prismatic", "stage", "lift", "0 0 1", -0.5, 0.5) +
           joint("r1", "revolute", "lift", "w1", "0 0 1", -2, 2) +
           joint("r2", "revolute", "w1", "w2", "0 1 0", -1.2, 1.2) +
           joint("r3", "revolute", "w2", "hand", "1 0 0", -2, 2);
  return out + "</robot>";
}

/// Whether the segment from a to b runs through the inside of a rectangle.
inline bool crosses(const Rectangle& r, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  constexpr double kTouching = 1e-9;
  double first = 0, last = 1;
  const double low[] = {r.low_x, r.low_y}, high[] = {r.high_x, r.high_y};
  for (int k = 0; k < 2; ++k) {
    const double from = a[k], along = b[k] - a[k];
    if (std::abs(along) < 1e-15) {
      if (from <= low[k] + kTouching || from >= high[k] - kTouching) return false;
      continue;
    }
    const double enter = (low[k] + kTouching - from) / along, leave = (high[k] - kTouching - from) / along;
    first = std::max(first, std::min(enter, leave));
    last = std::min(last, std::max(enter, leave));
  }
  return first < last;
}

/// Length of the shortest path of a point, by Dijkstra over the visibility graph of the rectangles' corners; `weights`
/// scale x and y.
inline double shortest(const std::vector<Rectangle>& walls, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                       const Eigen::Vector2d& weights) {
  std::vector<Eigen::Vector2d> points{from, to};
  for (const Rectangle& r : walls)
    for (const double x : {r.low_x, r.high_x})
      for (const double y : {r.low_y, r.high_y})
        if (x > 0 && x < kWidth && y > 0 && y < kDepth) points.emplace_back(x, y);
  std::vector<double> distance(points.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> settled(points.size(), false);
  distance[0] = 0;
  for (;;) {
    std::size_t next = points.size();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!settled[i] && (next == points.size() || distance[i] < distance[next])) next = i;
    if (next == 1) return distance[1];
    settled[next] = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool blocked = std::any_of(walls.begin(), walls.end(),
                                       [&](const Rectangle& r) { return crosses(r, points[next], points[i]); });
      if (!blocked)
        distance[i] = std::min(distance[i], distance[next] + (points[i] - points[next]).cwiseProduct(weights).norm());
    }
  }
}

}  // namespace gantry_walls

inline GantryWalls gantry_walls_problem(const std::vector<Rectangle>& walls, bool wrist,
                                        const Eigen::VectorXd& joint_weights = {}) {
  using namespace gantry_walls;
  const JointGroup group = Robot::from_strings(urdf(wrist), "").chain("frame", wrist ? "hand" : "stage");
  Eigen::VectorXd start(group.size()), goal(group.size());
  start.head(2) << 0.4, 0.3;
  goal.head(2) << 1.6, 0.35;
  if (wrist) {
    start.tail(4) << 0, 0.4, -0.5, -0.6;
    goal.tail(4) << 0, -0.3, 0.4, 0.5;
  }
  LinkShape part;
  part.shape = Box{{0.02, 0.02, 0.02}};
  ManipulationProblem problem{group, {}, {part}, group.fk(start), group.fk(goal), {Grasp{Pose::Identity(), 0, 0}}};
  problem.touch_links = {"stage"};
  std::vector<Rectangle> grown;  // By half of the cube: obstacles of its centre.
  for (const Rectangle& r : walls) {
    Pose T = Pose::Identity();
    T.translation() << (r.low_x + r.high_x) / 2, (r.low_y + r.high_y) / 2, 0;
    problem.world.add("wall " + std::to_string(grown.size()), Shape(Box{{r.high_x - r.low_x, r.high_y - r.low_y, 0.2}}),
                      T);
    grown.push_back({r.low_x - kHalfCube, r.high_x + kHalfCube, r.low_y - kHalfCube, r.high_y + kHalfCube});
  }
  const Eigen::VectorXd weights = joint_weights.size() > 0 ? joint_weights : Eigen::VectorXd::Ones(group.size());
  const double planar = shortest(grown, start.head<2>(), goal.head<2>(), weights.head<2>());
  return {problem, std::hypot(planar, (goal - start).cwiseProduct(weights).tail(group.size() - 2).norm())};
}

/// A wall of this thickness across the gantry with a door.
inline std::vector<Rectangle> wall_with_door(double thickness) {
  const double low = 1 - thickness / 2, high = 1 + thickness / 2;
  return {{low, high, -0.5, 0.75}, {low, high, 0.9, 1.7}};
}
/// Two walls, a thin and a thick one, with doors at opposite ends.
inline std::vector<Rectangle> two_walls() {
  return {{0.699, 0.701, -0.5, 0.8}, {0.699, 0.701, 0.9, 1.7}, {1.26, 1.34, -0.5, 0.15}, {1.26, 1.34, 0.3, 1.7}};
}
/// Boxes with several ways between them; no two overlap when grown by half of the cube.
inline std::vector<Rectangle> boxes() {
  return {{0.6, 0.8, 0.1, 0.5},
          {0.9, 1.0, 0.35, 0.9},
          {1.15, 1.4, 0.15, 0.42},
          {1.2, 1.3, 0.55, 0.9},
          {0.55, 0.7, 0.6, 0.8}};
}

}  // namespace mmgrasp::test
