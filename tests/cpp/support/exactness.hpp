#pragma once

// Free, self-collision or scene for a whole robot, answered by FCL called directly on the loaded shapes, and the count
// of answers that equal the checker's. Half of the configurations are drawn at random, half are pushed to within about
// a millimetre of touching.

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fcl_reference.hpp"
#include "support/mesh_robots.hpp"

namespace exactness {

using namespace mmgrasp;
using testing_support::MeshArm;
using testing_support::shared;

struct Scene {
  std::string name;
  World world;
};

inline Pose random_place(Rng& rng, const MeshArm& arm, double keep_out) {
  const double angle = rng.uniform(-M_PI, M_PI), r = rng.uniform(keep_out, arm.reach);
  Pose T = Pose::Identity();
  T.translation() << r * std::cos(angle), r * std::sin(angle), rng.uniform(arm.low, arm.high);
  T.linear() = rng.rotation().toRotationMatrix();
  return T;
}

inline World boxes(const MeshArm& arm) {
  Rng rng(1);
  World world;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d size(rng.uniform(0.04, 0.2), rng.uniform(0.04, 0.2), rng.uniform(0.04, 0.2));
    world.add("box" + std::to_string(i), Box{size}, random_place(rng, arm, 0.5));
  }
  return world;
}

inline World primitives(const MeshArm& arm) {
  Rng rng(2);
  World world;
  for (int i = 0; i < 16; ++i) {
    const double size = rng.uniform(0.03, 0.1);
    const std::string name = "body" + std::to_string(i);
    const Pose T = random_place(rng, arm, 0.5);
    if (i % 4 == 0) world.add(name, Capsule{size, 2 * size}, T);
    if (i % 4 == 1) world.add(name, Cylinder{size, 3 * size}, T);
    if (i % 4 == 2) world.add(name, Sphere{size}, T);
    if (i % 4 == 3) world.add(name, Box{{size, 2 * size, 3 * size}}, T);
  }
  world.add("wall", Plane{Eigen::Vector3d(-0.8, 0.6, 0), -0.75}, Pose::Identity());
  return world;
}

inline World meshes(const MeshArm& arm) {
  Rng rng(3);
  World world;
  const auto add = [&](const std::string& file, double scale) {
    const MeshShape shape{load_mesh(shared("meshes/" + file), Eigen::Vector3d::Constant(scale))};
    for (int i = 0; i < 3; ++i) world.add(file + std::to_string(i), shape, random_place(rng, arm, 0.5));
  };
  add("ycb/YcbBanana/collision_vhacd.obj", 1.5);
  add("trimesh/featuretype.STL", 0.04);
  add("trimesh/fandisk.obj", 0.12);
  add("bullet_dinnerware/cup/Cup/textured-0008192.obj", 1.5);  // an open shell
  add("o2ac_wrs/01-BASE.stl", 0.001);
  add("trimesh/torus.STL", 0.08);
  return world;
}

/// Cells of a real building's map that lie around the arm, and a patch of single cells as a point cloud gives them.
inline World voxels(const MeshArm& arm) {
  octomap::OcTree tree(0.1);
  tree.readBinary(shared("clouds/octomap/geb079.bt"));
  // The densest of a few places: there the walls stand.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::vector<std::pair<Eigen::Vector3d, double>> leaves, kept;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (tree.isNodeOccupied(*leaf))
      leaves.emplace_back(Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ()), leaf.getSize());
  }
  std::size_t most = 0;
  for (std::size_t i = 0; i < leaves.size(); i += leaves.size() / 40) {
    std::size_t count = 0;
    for (const auto& leaf : leaves) count += (leaf.first - leaves[i].first).norm() < 0.8;
    if (count > most) most = count, middle = leaves[i].first;
  }
  Pose T = Pose::Identity();
  T.translation() << 0.75, 0, 0.5 * (arm.low + arm.high);
  T.translation() -= middle;
  std::map<double, std::shared_ptr<std::vector<Eigen::Vector3d>>> by_size;
  for (const auto& [centre, size] : leaves) {
    const Eigen::Vector3d at = T * centre;
    if (at.head<2>().norm() < (arm.group.has_base() ? 0.9 : 0.45) || at.norm() > 1.6) continue;
    auto& cells = by_size[size];
    if (!cells) cells = std::make_shared<std::vector<Eigen::Vector3d>>();
    cells->push_back(centre);
  }
  WorldObject map;
  map.T_world_object = T;
  for (const auto& [size, cells] : by_size) {
    LinkShape shape;
    shape.shape = Voxels{cells, size};
    map.shapes.push_back(shape);
  }
  World world;
  if (!map.shapes.empty()) world.add("map", map);
  Rng rng(4);
  auto cells = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = 0; i < 300; ++i) {
    const double angle = rng.uniform(2, 4), height = rng.uniform(arm.low, arm.high);
    cells->emplace_back(0.02 * std::floor(30 * std::cos(angle)) + 0.01, 0.02 * std::floor(30 * std::sin(angle)) + 0.01,
                        0.02 * std::floor(height / 0.02) + 0.01);
  }
  world.add("scan", Voxels{cells, 0.02}, Pose::Identity());
  return world;
}

/// Boards of 12 mm around the arm's work space: floors, walls and a back.
inline World shelf(const MeshArm& arm) {
  World world;
  const double middle = 0.5 * (arm.low + arm.high);
  const auto board = [&](const std::string& name, const Eigen::Vector3d& size, const Eigen::Vector3d& at) {
    Pose T = pose_from_planar({0, 0, 0.2});
    T.translation() = T.linear() * at;
    world.add(name, Box{size}, T);
  };
  for (int i = -1; i <= 2; ++i)
    board("floor" + std::to_string(i), {0.35, 1.0, 0.012}, {0.62, 0, middle + 0.3 * i - 0.15});
  for (int i = -2; i <= 2; ++i) board("wall" + std::to_string(i), {0.35, 0.012, 0.9}, {0.62, 0.25 * i, middle});
  board("back", {0.012, 1.0, 0.9}, {0.8, 0, middle});
  return world;
}

inline std::vector<Scene> scenes(const MeshArm& arm) {
  return {{"boxes", boxes(arm)},
          {"primitives", primitives(arm)},
          {"meshes", meshes(arm)},
          {"voxels", voxels(arm)},
          {"shelf", shelf(arm)}};
}

/// One vertex of each part of a mesh whose triangles hang together.
inline std::vector<Eigen::Vector3d> one_of_each_part(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto top = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh.triangles) {
    parent[top(t[0])] = top(t[1]);
    parent[top(t[1])] = top(t[2]);
  }
  std::vector<Eigen::Vector3d> out;
  for (int v = 0; v < static_cast<int>(parent.size()); ++v) {
    if (parent[v] == v) out.push_back(mesh.vertices[v]);
  }
  return out;
}

/// FCL's answer for a group in a world without attached objects. Its objects are made once: FCL goes over all triangles
/// whenever one is made.
class Reference {
 public:
  Reference(const JointGroup& group, const World& world) : group_(group) {
    const Robot& robot = group.robot();
    for (std::size_t i = 0; i < robot.links().size(); ++i) {
      for (const LinkShape& shape : robot.links()[i].collisions)
        links_.push_back(make_placed(shape.shape, shape.T_link_shape, static_cast<int>(i)));
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
      for (std::size_t j = i + 1; j < links_.size(); ++j) {
        const int a = links_[i].link, b = links_[j].link;
        if (a != b && !robot.pair_disabled(a, b) && top(a) != top(b)) pairs_.emplace_back(i, j);
      }
    }
    for (const auto& entry : world.objects()) {
      for (const LinkShape& shape : entry.second.shapes)
        scene_.push_back(make_placed(shape.shape, entry.second.T_world_object * shape.T_link_shape, -1));
    }
    for (Placed& body : scene_) {
      place(body, body.T);
      for (const auto& object : body.objects) {
        if (object->getNodeType() == fcl::GEOM_HALFSPACE) {
          planes_.push_back(object.get());
        } else {
          manager_.registerObject(object.get());
        }
      }
    }
    manager_.setup();
  }

  Rejection answer(const Eigen::VectorXd& q) {
    const Poses T = group_.robot().link_poses(group_.full_values(q), group_.root_pose(q));
    for (Placed& link : links_) place(link, T[link.link] * link.T);
    for (const auto& [i, j] : pairs_) {
      if (touch(links_[i], links_[j])) return Rejection::self_collision;
    }
    for (const Placed& link : links_) {
      if (touches_scene(link)) return Rejection::scene;
    }
    return Rejection::none;
  }

  /// True when some pair is within 1e-6 m of changing its answer.
  bool on_the_edge(const Eigen::VectorXd& q) const {
    const Poses T = group_.robot().link_poses(group_.full_values(q), group_.root_pose(q));
    const auto at = [&](std::size_t i) { return T[links_[i].link] * links_[i].T; };
    for (const auto& [i, j] : pairs_) {
      if (fcl_reference::on_the_edge(links_[i].body, at(i), links_[j].body, at(j))) return true;
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
      for (const Placed& object : scene_) {
        if (fcl_reference::on_the_edge(links_[i].body, at(i), object.body, object.T)) return true;
      }
    }
    return false;
  }

 private:
  struct Placed {
    fcl_reference::Body body;
    std::vector<std::shared_ptr<fcl::CollisionObjectd>> objects;
    Pose T = Pose::Identity();      ///< In the link, or the world.
    Pose T_now = Pose::Identity();  ///< In the world.
    int link = -1;
  };

  static Placed make_placed(const Shape& shape, const Pose& T, int link) {
    Placed placed;
    placed.body = fcl_reference::make_body(shape);
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) placed.body.probes = one_of_each_part(*mesh->mesh);
    for (const fcl_reference::Part& part : placed.body.parts)
      placed.objects.push_back(std::make_shared<fcl::CollisionObjectd>(part.geometry));
    placed.T = T;
    placed.link = link;
    return placed;
  }

  static void place(Placed& placed, const Pose& T) {
    placed.T_now = T;
    for (std::size_t i = 0; i < placed.objects.size(); ++i) {
      placed.objects[i]->setTransform(Pose(T * placed.body.parts[i].T));
      placed.objects[i]->computeAABB();
    }
  }

  int top(int link) const {
    const Robot& robot = group_.robot();
    while (robot.links()[link].parent_joint >= 0 &&
           robot.joints()[robot.links()[link].parent_joint].type == JointType::fixed)
      link = robot.joints()[robot.links()[link].parent_joint].parent_link;
    return link;
  }

  static bool look(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    auto* hit = static_cast<bool*>(data);
    fcl::CollisionResultd result;
    *hit = *hit || fcl::collide(a, b, fcl::CollisionRequestd(1, false), result) > 0;
    return *hit;
  }

  static bool one_inside(const Placed& a, const Placed& b) {
    return fcl_reference::inside(a.body, a.T_now, b.body, b.T_now) ||
           fcl_reference::inside(b.body, b.T_now, a.body, a.T_now);
  }

  static bool touch(const Placed& a, const Placed& b) {
    bool hit = false;
    for (const auto& oa : a.objects) {
      for (const auto& ob : b.objects) {
        if (oa->getAABB().overlap(ob->getAABB()) && look(oa.get(), ob.get(), &hit)) return true;
      }
    }
    return one_inside(a, b);
  }

  bool touches_scene(const Placed& link) const {
    bool hit = false;
    for (const auto& object : link.objects) {
      manager_.collide(object.get(), &hit, &look);
      for (fcl::CollisionObjectd* plane : planes_) look(object.get(), plane, &hit);
      if (hit) return true;
    }
    for (const Placed& other : scene_) {
      if (one_inside(link, other)) return true;
    }
    return false;
  }

  JointGroup group_;
  std::vector<Placed> links_, scene_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<fcl::CollisionObjectd*> planes_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

struct Count {
  int free = 0, self = 0, scene = 0;     ///< Agreed on.
  std::vector<std::string> band, wrong;  ///< What was not: within 1e-6 m of touching, or plainly.
};

inline std::string words(const std::string& where, const Eigen::VectorXd& q, Rejection ours, Rejection fcl) {
  std::string out = where + ": mmgrasp " + to_string(ours) + ", FCL " + to_string(fcl) + ", q =";
  char number[40];
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    std::snprintf(number, sizeof number, " %.17g", q[i]);
    out += number;
  }
  return out;
}

/// Moves a free configuration towards a colliding one until less than `gap` (largest joint motion) lies between the
/// free and the colliding side; returns either.
inline Eigen::VectorXd near_touching(CollisionChecker& checker, Eigen::VectorXd free, Eigen::VectorXd hit, double gap,
                                     bool want_free) {
  while ((hit - free).cwiseAbs().maxCoeff() > gap) {
    const Eigen::VectorXd middle = 0.5 * (free + hit);
    (checker.is_free(middle) ? free : hit) = middle;
  }
  return want_free ? free : hit;
}

inline void compare(const MeshArm& arm, const Scene& scene, int queries, unsigned seed, Count& count) {
  CollisionChecker checker(arm.group, scene.world);
  Reference reference(arm.group, scene.world);
  Rng rng(seed);
  Eigen::VectorXd lower = arm.group.sample_lower(), upper = arm.group.sample_upper();
  if (arm.group.has_base()) {
    lower.head<2>().setConstant(-0.4);
    upper.head<2>().setConstant(0.4);
  }
  Eigen::VectorXd last_free, last_hit;
  for (int n = 0; n < queries; ++n) {
    Eigen::VectorXd q = rng.uniform(lower, upper);
    (checker.is_free(q) ? last_free : last_hit) = q;
    if (n % 2 == 1 && last_free.size() > 0 && last_hit.size() > 0)
      q = near_touching(checker, last_free, last_hit, 1e-3, n % 4 == 1);
    const Rejection ours = checker.rejection(q), fcl = reference.answer(q);
    const bool same = ours == fcl && checker.is_free(q) == (fcl == Rejection::none);
    if (same) {
      ++(fcl == Rejection::none ? count.free : fcl == Rejection::scene ? count.scene : count.self);
    } else {
      (reference.on_the_edge(q) ? count.band : count.wrong)
          .push_back(words(arm.name + ", " + scene.name, q, ours, fcl));
    }
  }
}

inline std::vector<MeshArm> six_arms() {
  using namespace testing_support;
  return {panda_arm(), ur5_arm(), ur5e_arm(), iiwa_arm(), tiago_arm(), omni6_arm()};
}

}  // namespace exactness
