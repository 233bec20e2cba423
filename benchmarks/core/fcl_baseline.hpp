#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "assembly.hpp"
#include "fcl_shapes.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/disabled_pairs.hpp"

namespace bench {

/// The pairs of links that a checker of the group looks at because they can move against each other.
inline std::vector<std::pair<int, int>> self_pairs(const mmgrasp::JointGroup& group) {
  const mmgrasp::Robot& robot = group.robot();
  std::vector<char> moves(robot.links().size(), 0);
  for (const int link : group.moving_links()) moves[link] = 1;
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < static_cast<int>(robot.links().size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(robot.links().size()); ++b) {
      if (robot.links()[a].collisions.empty() || robot.links()[b].collisions.empty()) continue;
      if ((!moves[a] && !moves[b]) || robot.pair_disabled(a, b) || assembly_of(robot, a) == assembly_of(robot, b))
        continue;
      pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

/// FCL as its users set it up for one moving robot in a scene that stands still: the scene in a dynamic AABB tree
/// manager, made once; the links' objects moved for every configuration; pairs of links listed once and looked at when
/// their boxes overlap; stop at the first contact.
class FclBaseline {
 public:
  /// Convex meshes become fcl::Convex with `convex`, else triangle trees (OBBRSS) like all other meshes.
  FclBaseline(const mmgrasp::JointGroup& group, const mmgrasp::World& world, bool convex)
      : group_(group), convex_(convex) {
    using namespace mmgrasp;
    request_ = fcl::CollisionRequestd(1, false);
    const Robot& robot = group.robot();
    objects_of_.resize(robot.links().size());
    std::vector<char> moves(robot.links().size(), 0);
    for (const int link : group.moving_links()) moves[link] = 1;
    group_.link_poses(0.5 * (group.sample_lower() + group.sample_upper()), links_);
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      for (const LinkShape& shape : robot.links()[link].collisions) {
        objects_of_[link].push_back(static_cast<int>(robot_.size()));
        robot_.push_back({static_cast<int>(link), shape.T_link_shape,
                          std::make_unique<fcl::CollisionObjectd>(fcl_geometry(shape.shape, convex_),
                                                                  fcl::Transform3d::Identity())});
        place(robot_.back());
        if (moves[link]) moving_.push_back(static_cast<int>(robot_.size()) - 1);
      }
    }
    for (const auto& [a, b] : self_pairs(group)) {
      for (const int i : objects_of_[a]) {
        for (const int j : objects_of_[b]) pairs_.emplace_back(robot_[i].object.get(), robot_[j].object.get());
      }
    }
    for (const auto& entry : world.objects()) {
      for (const LinkShape& shape : entry.second.shapes) {
        scene_.push_back(std::make_unique<fcl::CollisionObjectd>(
            fcl_geometry(shape.shape, convex_), fcl::Transform3d(entry.second.T_world_object * shape.T_link_shape)));
        manager_.registerObject(scene_.back().get());
      }
    }
    manager_.setup();
  }

  /// One more object of the scene, e.g. an octree.
  void add(const std::shared_ptr<fcl::CollisionGeometryd>& geometry) {
    scene_.push_back(std::make_unique<fcl::CollisionObjectd>(geometry, fcl::Transform3d::Identity()));
    manager_.registerObject(scene_.back().get());
    manager_.setup();
  }

  bool is_free(const Eigen::VectorXd& q) {
    group_.link_poses(q, links_, true);
    for (const int i : moving_) place(robot_[i]);
    for (const auto& [a, b] : pairs_) {
      if (!a->getAABB().overlap(b->getAABB())) continue;
      fcl::CollisionResultd result;
      if (fcl::collide(a, b, request_, result) > 0) return false;
    }
    for (const int i : moving_) {
      Query query{&request_, false};
      manager_.collide(robot_[i].object.get(), &query, &look);
      if (query.hit) return false;
    }
    return true;
  }

  /// Both ends, then the steps between from one end to the other.
  bool edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step) {
    const int count = static_cast<int>(std::ceil((q1 - q0).cwiseAbs().maxCoeff() / step - 1e-9));
    for (int i = 0; i <= count; ++i) {
      if (!is_free(q0 + (q1 - q0) * (static_cast<double>(i) / count))) return false;
    }
    return true;
  }

 private:
  struct Placed {
    int link;
    mmgrasp::Pose T_link_shape;
    std::unique_ptr<fcl::CollisionObjectd> object;
  };
  struct Query {
    const fcl::CollisionRequestd* request;
    bool hit;
  };

  static bool look(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    auto* query = static_cast<Query*>(data);
    fcl::CollisionResultd result;
    if (fcl::collide(a, b, *query->request, result) > 0) query->hit = true;
    return query->hit;
  }

  void place(Placed& placed) {
    placed.object->setTransform(fcl::Transform3d(links_[placed.link] * placed.T_link_shape));
    placed.object->computeAABB();
  }

  mmgrasp::JointGroup group_;
  bool convex_;
  mmgrasp::Poses links_;
  fcl::CollisionRequestd request_;
  std::vector<Placed> robot_;
  std::vector<std::vector<int>> objects_of_;
  std::vector<int> moving_;
  std::vector<std::pair<fcl::CollisionObjectd*, fcl::CollisionObjectd*>> pairs_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> scene_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

}  // namespace bench
