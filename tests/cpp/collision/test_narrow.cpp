#include "collision/narrow/narrow.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/narrow/distance_grid.hpp"
#include "mmgrasp/core/random.hpp"

// Whether two bodies are farther apart than a given clearance, against their distance.

namespace mmgrasp::detail {
namespace {

/// A ring of boxes around z: not convex, of several parts.
TriangleMesh ring(int count, double radius) {
  TriangleMesh mesh;
  const auto box = shape_mesh(Box{{0.05, 0.03, 0.02}});
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    const Eigen::Affine3d T = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(radius, 0, 0);
    const int first = static_cast<int>(mesh.vertices.size());
    for (const auto& v : box->vertices) mesh.vertices.push_back(T * v);
    for (const auto& t : box->triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  mesh.closed = true;
  return mesh;
}

Rigid random_pose(Rng& rng) {
  Pose T = Pose::Identity();
  T.linear() = rng.rotation().toRotationMatrix();
  T.translation() = Eigen::Vector3d(rng.uniform(-0.25, 0.25), rng.uniform(-0.25, 0.25), rng.uniform(-0.25, 0.25));
  return Rigid(T);
}

TEST(Narrow, SaysWhetherTheClearanceExceedsABound) {
  const auto large = std::make_shared<const TriangleMesh>(ring(12, 0.2));
  const auto small = std::make_shared<const TriangleMesh>(ring(5, 0.06));
  const auto a = make_solid(MeshShape{large}), b = make_solid(MeshShape{small}), can = make_solid(Cylinder{0.04, 0.1});
  const DistanceGrid grid(*small, *b);
  Rng rng(5);
  int wider = 0, narrower = 0;
  for (int i = 0; i < 2000; ++i) {
    const Rigid T_a = random_pose(rng), T_b = random_pose(rng);
    for (const Solid* other : {b.get(), can.get()}) {
      const double distance = solids_distance(*a, T_a, *other, T_b).distance;
      if (distance <= 0) continue;
      for (const double share : {0.2, 0.999, 1.001, 5.0}) {
        const double clearance = share * distance;
        const bool within = solids_collide(*a, T_a, *other, T_b, clearance);
        EXPECT_EQ(within, share > 1) << "distance " << distance << ", asked for " << clearance;
        Closing closing;
        closing.most = clearance;
        if (other == b.get()) {
          EXPECT_EQ(meshes_collide(*b, T_b, grid, *a, T_a, closing), within) << distance;
        }
        ++(within ? narrower : wider);
      }
    }
  }
  EXPECT_GT(wider, 2000);
  EXPECT_GT(narrower, 2000);
}

// The triangle that a convex body is said to hit is hit, and where the bodies do not meet none is.
TEST(Narrow, TheNamedPieceIsHit) {
  const auto mesh = std::make_shared<const TriangleMesh>(ring(12, 0.2));
  const auto a = make_solid(MeshShape{mesh}), padded = make_solid(MeshShape{mesh}, 0.01);
  const auto can = make_solid(Cylinder{0.04, 0.1}), box = make_solid(Box{{0.1, 0.06, 0.08}});
  Rng rng(7);
  int named = 0, missed = 0;
  for (int i = 0; i < 2000; ++i) {
    const Rigid T_a = random_pose(rng), T_b = random_pose(rng), T_elsewhere = random_pose(rng);
    for (const Solid* rings : {a.get(), padded.get()}) {
      for (const Solid* other : {can.get(), box.get()}) {
        int piece = -1;
        const bool hit = i % 2 == 0 ? solids_collide(*rings, T_a, *other, T_b, 0, false, &piece)
                                    : solids_collide(*other, T_b, *rings, T_a, 0, false, &piece);
        if (piece < 0) continue;
        ASSERT_TRUE(hit);
        ASSERT_TRUE(piece_collides(*rings, T_a, *other, T_b, piece));
        ASSERT_TRUE(piece_collides(*other, T_b, *rings, T_a, piece));
        ++named;
        if (solids_collide(*rings, T_a, *other, T_elsewhere)) continue;
        ASSERT_FALSE(piece_collides(*rings, T_a, *other, T_elsewhere, piece));
        ++missed;
      }
    }
  }
  EXPECT_GT(named, 500);
  EXPECT_GT(missed, 200);
  EXPECT_FALSE(piece_collides(*can, Rigid(), *box, Rigid(), 0));
  EXPECT_FALSE(piece_collides(*a, Rigid(), *padded, Rigid(), 0));
}

// A ring that slides and turns beside another one: what is said to stay apart does, at every point of the way.
TEST(Narrow, WhatStaysApartOnTheWayDoesNotMeet) {
  const auto large = std::make_shared<const TriangleMesh>(ring(12, 0.2));
  const auto small = std::make_shared<const TriangleMesh>(ring(5, 0.06));
  const auto a = make_solid(MeshShape{large}), b = make_solid(MeshShape{small});
  const DistanceGrid grid(*small, *b);
  Rng rng(6);
  int proven = 0, only_directed = 0, meet = 0;
  for (int i = 0; i < 3000; ++i) {
    const Rigid T_a = random_pose(rng), T_b = random_pose(rng);
    const bool a_moves = i % 2 == 0;
    const Rigid& start = a_moves ? T_a : T_b;
    Closing closing;
    closing.directed = true;
    closing.first_moves = !a_moves;  // b comes first below
    closing.centre = start.t;
    closing.radius = a_moves ? a->sphere_radius : b->sphere_radius;
    const Eigen::Vector3d axis = rng.rotation() * Eigen::Vector3d::UnitZ();
    const double angle = rng.uniform(0, 0.08);
    closing.turn = angle * axis;
    closing.shift = rng.uniform(0, 0.02) * (rng.rotation() * Eigen::Vector3d::UnitX());
    closing.bend = 0.5 * angle * angle * closing.radius;
    closing.most = closing.shift.norm() + angle * closing.radius + closing.bend;
    const bool apart = !meshes_collide(*b, T_b, grid, *a, T_a, closing);
    Closing plain;
    plain.most = closing.most;
    only_directed += apart && meshes_collide(*b, T_b, grid, *a, T_a, plain);
    proven += apart;
    for (int k = -10; k <= 10; ++k) {
      Rigid moved = start;
      moved.R = Eigen::AngleAxisd(0.1 * k * angle, axis).toRotationMatrix() * start.R;
      moved.t += 0.1 * k * closing.shift;
      const bool hit = a_moves ? solids_collide(*a, moved, *b, T_b) : solids_collide(*a, T_a, *b, moved);
      meet += hit;
      ASSERT_FALSE(apart && hit) << i << " " << k;
    }
  }
  EXPECT_GT(proven, 500);
  EXPECT_GT(only_directed, 50);
  EXPECT_GT(meet, 500);
}

}  // namespace
}  // namespace mmgrasp::detail
