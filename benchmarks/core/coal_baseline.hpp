#pragma once

#ifdef MMGRASP_WITH_COAL

#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/collision.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <memory>
#include <utility>
#include <vector>

#include "coal_shapes.hpp"
#include "fcl_baseline.hpp"

namespace bench {

/// The same set-up as FclBaseline with coal: dynamic AABB tree manager, convex meshes as coal::Convex, others as
/// BVHModel<OBBRSS>, bounding volumes updated with the links, guess of each pair cached by ComputeCollision.
class CoalBaseline {
 public:
  CoalBaseline(const mmgrasp::JointGroup& group, const mmgrasp::World& world) : group_(group) {
    using namespace mmgrasp;
    const Robot& robot = group.robot();
    std::vector<std::vector<int>> objects_of(robot.links().size());
    std::vector<char> moves(robot.links().size(), 0);
    for (const int link : group.moving_links()) moves[link] = 1;
    group_.link_poses(0.5 * (group.sample_lower() + group.sample_upper()), links_);
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      for (const LinkShape& shape : robot.links()[link].collisions) {
        objects_of[link].push_back(static_cast<int>(robot_.size()));
        robot_.push_back({static_cast<int>(link), shape.T_link_shape,
                          std::make_unique<coal::CollisionObject>(coal_geometry(shape.shape))});
        place(robot_.back());
        if (moves[link]) moving_.push_back(static_cast<int>(robot_.size()) - 1);
      }
    }
    for (const auto& [a, b] : self_pairs(group)) {
      for (const int i : objects_of[a]) {
        for (const int j : objects_of[b]) {
          const coal::CollisionObject *oa = robot_[i].object.get(), *ob = robot_[j].object.get();
          pairs_.push_back(
              {oa, ob,
               std::make_unique<coal::ComputeCollision>(oa->collisionGeometry().get(), ob->collisionGeometry().get())});
        }
      }
    }
    for (const auto& entry : world.objects()) {
      for (const LinkShape& shape : entry.second.shapes) {
        const Pose T = entry.second.T_world_object * shape.T_link_shape;
        scene_.push_back(std::make_unique<coal::CollisionObject>(coal_geometry(shape.shape),
                                                                 coal::Transform3s(T.linear(), T.translation())));
        manager_.registerObject(scene_.back().get());
      }
    }
    manager_.setup();
    request_.num_max_contacts = 1;
    request_.enable_contact = false;
    look_.request = &request_;
  }

  bool is_free(const Eigen::VectorXd& q) {
    group_.link_poses(q, links_, true);
    for (const int i : moving_) place(robot_[i]);
    for (const Pair& pair : pairs_) {
      if (!pair.a->getAABB().overlap(pair.b->getAABB())) continue;
      coal::CollisionResult result;
      if ((*pair.compute)(pair.a->getTransform(), pair.b->getTransform(), request_, result) > 0) return false;
    }
    for (const int i : moving_) {
      look_.hit = false;
      manager_.collide(robot_[i].object.get(), &look_);
      if (look_.hit) return false;
    }
    return true;
  }

 private:
  struct Placed {
    int link;
    mmgrasp::Pose T_link_shape;
    std::unique_ptr<coal::CollisionObject> object;
  };
  struct Pair {
    const coal::CollisionObject *a, *b;
    std::unique_ptr<coal::ComputeCollision> compute;
  };
  struct Look : coal::CollisionCallBackBase {
    bool collide(coal::CollisionObject* a, coal::CollisionObject* b) override {
      coal::CollisionResult result;
      if (coal::collide(a, b, *request, result) > 0) hit = true;
      return hit;
    }
    const coal::CollisionRequest* request = nullptr;
    bool hit = false;
  };

  void place(Placed& placed) {
    const mmgrasp::Pose T = links_[placed.link] * placed.T_link_shape;
    placed.object->setTransform(T.linear(), T.translation());
    placed.object->computeAABB();
  }

  mmgrasp::JointGroup group_;
  mmgrasp::Poses links_;
  coal::CollisionRequest request_;
  std::vector<Placed> robot_;
  std::vector<int> moving_;
  std::vector<Pair> pairs_;
  std::vector<std::unique_ptr<coal::CollisionObject>> scene_;
  coal::DynamicAABBTreeCollisionManager manager_;
  Look look_;
};

}  // namespace bench

#endif
