#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/distance.h>

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "assembly.hpp"
#include "fcl_shapes.hpp"
#include "mmgrasp/collision/checker.hpp"

namespace bench {

/// FCL's smallest distance of a robot as its users set it up: the scene in a dynamic AABB tree manager made once, one
/// running minimum over all links (manager) and over the listed pairs of links (passed over when their boxes are
/// farther apart). What no configuration changes is measured once and starts the minimum, as it does in mmgrasp.
class FclDistanceBaseline {
 public:
  /// Convex meshes become fcl::Convex with `convex`, else triangle trees like all others; `self`: links among
  /// themselves.
  FclDistanceBaseline(const mmgrasp::JointGroup& group, const mmgrasp::World& world, bool convex, bool self)
      : group_(group), convex_(convex) {
    using namespace mmgrasp;
    const Robot& robot = group.robot();
    std::vector<char> moves(robot.links().size(), 0);
    for (const int link : group.moving_links()) moves[link] = 1;
    group_.link_poses(0.5 * (group.sample_lower() + group.sample_upper()), links_);
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      for (const LinkShape& shape : robot.links()[link].collisions) {
        objects_.push_back({static_cast<int>(link), moves[link] != 0, shape.T_link_shape,
                            std::make_unique<fcl::CollisionObjectd>(fcl_geometry(shape.shape, convex_),
                                                                    fcl::Transform3d::Identity())});
        place(objects_.back());
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
    Query still;
    for (const Placed& a : objects_) {
      if (!a.moves) manager_.distance(a.object.get(), &still, &look);
      for (const Placed& b : objects_) {
        if (!self || a.link >= b.link || robot.pair_disabled(a.link, b.link) ||
            assembly_of(robot, a.link) == assembly_of(robot, b.link))
          continue;
        if (a.moves || b.moves) {
          pairs_.emplace_back(a.object.get(), b.object.get());
        } else {
          double unused = 0;
          look(a.object.get(), b.object.get(), &still, unused);
        }
      }
    }
    start_ = still.least;
  }

  /// -1 or less when something touches.
  double distance(const Eigen::VectorXd& q) {
    group_.link_poses(q, links_, true);
    for (Placed& placed : objects_) {
      if (placed.moves) place(placed);
    }
    Query query;
    query.least = start_;
    double least = start_;
    for (const Placed& placed : objects_) {
      if (placed.moves) manager_.distance(placed.object.get(), &query, &look);
      if (query.least <= 0) return query.least;
    }
    for (const auto& [a, b] : pairs_) {
      if (a->getAABB().distance(b->getAABB()) >= query.least) continue;
      if (look(a, b, &query, least)) break;
    }
    return query.least;
  }

 private:
  struct Placed {
    int link;
    bool moves;
    mmgrasp::Pose T_link_shape;
    std::unique_ptr<fcl::CollisionObjectd> object;
  };
  struct Query {
    fcl::DistanceRequestd request{false, false, 0, 0, 1e-9};
    double least = std::numeric_limits<double>::infinity();
  };

  static bool look(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& least) {
    auto* query = static_cast<Query*>(data);
    fcl::DistanceResultd result;
    result.min_distance = query->least;
    query->least = std::min(query->least, fcl::distance(a, b, query->request, result));
    least = query->least;
    return query->least <= 0;
  }

  void place(Placed& placed) {
    placed.object->setTransform(fcl::Transform3d(links_[placed.link] * placed.T_link_shape));
    placed.object->computeAABB();
  }

  mmgrasp::JointGroup group_;
  bool convex_;
  mmgrasp::Poses links_;
  std::vector<Placed> objects_;
  std::vector<std::pair<fcl::CollisionObjectd*, fcl::CollisionObjectd*>> pairs_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> scene_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
  double start_ = std::numeric_limits<double>::infinity();
};

}  // namespace bench
