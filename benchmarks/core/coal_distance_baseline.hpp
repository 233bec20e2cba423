#pragma once

#ifdef MMGRASP_WITH_COAL

#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "assembly.hpp"
#include "coal_shapes.hpp"
#include "mmgrasp/collision/checker.hpp"

namespace bench {

/// The same set-up as FclDistanceBaseline with coal: convex meshes as coal::Convex, others as BVHModel<OBBRSS>; depths
/// are not asked for (enable_signed_distance off).
class CoalDistanceBaseline {
 public:
  CoalDistanceBaseline(const mmgrasp::JointGroup& group, const mmgrasp::World& world, bool self) : group_(group) {
    using namespace mmgrasp;
    const Robot& robot = group.robot();
    std::vector<char> moves(robot.links().size(), 0);
    for (const int link : group.moving_links()) moves[link] = 1;
    group_.link_poses(0.5 * (group.sample_lower() + group.sample_upper()), links_);
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      for (const LinkShape& shape : robot.links()[link].collisions) {
        objects_.push_back({static_cast<int>(link), moves[link] != 0, shape.T_link_shape,
                            std::make_unique<coal::CollisionObject>(coal_geometry(shape.shape))});
        place(objects_.back());
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
    look_.request.enable_signed_distance = false;
    look_.least = std::numeric_limits<double>::infinity();
    for (const Placed& a : objects_) {
      if (!a.moves) manager_.distance(a.object.get(), &look_);
      for (const Placed& b : objects_) {
        if (!self || a.link >= b.link || robot.pair_disabled(a.link, b.link) ||
            assembly_of(robot, a.link) == assembly_of(robot, b.link))
          continue;
        if (a.moves || b.moves) {
          pairs_.emplace_back(a.object.get(), b.object.get());
        } else {
          coal::CoalScalar unused = 0;
          look_.distance(a.object.get(), b.object.get(), unused);
        }
      }
    }
    start_ = look_.least;
  }

  /// 0 or less when something touches.
  double distance(const Eigen::VectorXd& q) {
    group_.link_poses(q, links_, true);
    for (Placed& placed : objects_) {
      if (placed.moves) place(placed);
    }
    look_.least = start_;
    for (const Placed& placed : objects_) {
      if (placed.moves) manager_.distance(placed.object.get(), &look_);
      if (look_.least <= 0) return look_.least;
    }
    coal::CoalScalar unused = 0;
    for (const auto& [a, b] : pairs_) {
      if (a->getAABB().distance(b->getAABB()) >= look_.least) continue;
      if (look_.distance(a, b, unused)) break;
    }
    return look_.least;
  }

 private:
  struct Placed {
    int link;
    bool moves;
    mmgrasp::Pose T_link_shape;
    std::unique_ptr<coal::CollisionObject> object;
  };
  struct Look : coal::DistanceCallBackBase {
    bool distance(coal::CollisionObject* a, coal::CollisionObject* b, coal::CoalScalar& bound) override {
      coal::DistanceResult result;
      result.min_distance = least;
      least = std::min<double>(least, coal::distance(a, b, request, result));
      bound = least;
      return least <= 0;
    }
    coal::DistanceRequest request;
    double least = 0;
  };

  void place(Placed& placed) {
    const mmgrasp::Pose T = links_[placed.link] * placed.T_link_shape;
    placed.object->setTransform(T.linear(), T.translation());
    placed.object->computeAABB();
  }

  mmgrasp::JointGroup group_;
  mmgrasp::Poses links_;
  std::vector<Placed> objects_;
  std::vector<std::pair<coal::CollisionObject*, coal::CollisionObject*>> pairs_;
  std::vector<std::unique_ptr<coal::CollisionObject>> scene_;
  coal::DynamicAABBTreeCollisionManager manager_;
  Look look_;
  double start_ = 0;
};

}  // namespace bench

#endif
