// Parts that stand in each other: depths and places in closed form.
#include "mmgrasp/gripper_design/operation_overlap.hpp"

#include <gtest/gtest.h>

#include "gripper_design/simple_parts.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using test::at;
using test::block;
using test::turned;

AssemblyOperation down_onto_plate(double end) {
  AssemblyOperation o;
  o.active = {{"cube", block({0.01, 0.01, 0.01})}};
  o.passive = {{"plate", block({0.05, 0.05, 0.005}), at(0, 0, -0.005)}};
  o.motion = {at(0, 0, 0.06), at(0, 0, 0.01 + end)};
  return o;
}

TEST(OperationOverlap, ACubeInAPlateIsAsDeepAsItStandsInIt) {
  const OperationOverlap deep = operation_overlap(down_onto_plate(-0.003));
  EXPECT_NEAR(deep.depth, 0.003, 1e-12);
  EXPECT_EQ(deep.active, "cube");
  EXPECT_EQ(deep.passive, "plate");
  EXPECT_EQ(deep.before_end, 0);
  EXPECT_NEAR(operation_overlap(down_onto_plate(0)).depth, 0, 1e-12);
  EXPECT_EQ(operation_overlap(down_onto_plate(0.001)).depth, 0);
}

TEST(OperationOverlap, TellsWhereOnTheWay) {
  AssemblyOperation o = down_onto_plate(0.0);
  o.motion.front() = at(0, 0, -0.06);  // from below, through the plate
  const OperationOverlap found = operation_overlap(o, 0.0005);
  EXPECT_GT(found.depth, 0.0005);
  EXPECT_NEAR(found.before_end, found.depth, 1e-12);  // as deep as it has yet to rise
  EXPECT_LE(found.before_end, 0.002 + 1e-12);
  EXPECT_LT(operation_overlap(down_onto_plate(0.0), 0.0005).depth, 1e-12);
}

TEST(OperationOverlap, APegInItsHoleIsFreeAndInASmallerOneIsNot) {
  AssemblyOperation o;
  o.passive = {{"peg", turned({{0, 0}, {0.005, 0}, {0.005, 0.04}, {0, 0.04}})}};
  o.motion = {at(0, 0, 0.06), at(0, 0, 0.01)};
  o.active = {{"ring", turned({{0.005, 0}, {0.01, 0}, {0.01, 0.01}, {0.005, 0.01}})}};
  EXPECT_LT(operation_overlap(o).depth, 1e-9);
  o.active = {{"ring", turned({{0.004, 0}, {0.01, 0}, {0.01, 0.01}, {0.004, 0.01}})}};
  EXPECT_NEAR(operation_overlap(o).depth, 0.001, 2e-5);  // 64 corners
}

TEST(OperationOverlap, PartsFarFromTheirFilesOriginTurnInPlace) {
  AssemblyOperation o;
  o.active = {{"bar", block({0.05, 0.01, 0.01}), at(1, 0, 0)}};
  o.passive = {{"wall", block({0.002, 0.1, 0.02}), at(0.94, 0, 0)}};  // 7 mm beside the circle that it turns in
  Pose turned_about_middle = Pose::Identity();
  turned_about_middle.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turned_about_middle.translation() = at(1, 0, 0).translation() - turned_about_middle.linear().col(0);
  o.motion = {turned_about_middle, at(0, 0, 0)};
  EXPECT_EQ(operation_overlap(o).depth, 0);
  o.passive[0].pose = at(0.96, 0, 0);  // as near as its corner comes on the way only
  o.motion = {turned_about_middle, at(0, 0, 0), turned_about_middle};
  const OperationOverlap found = operation_overlap(o, 0.005);
  EXPECT_GT(found.depth, 0.005);
  EXPECT_EQ(found.before_end, 0);  // its middle stays where it is
}

TEST(OperationOverlap, WhatLiesWhollyInsideIsFound) {
  AssemblyOperation o = down_onto_plate(0);
  o.active = {{"bead", block({0.001, 0.001, 0.001})}};
  o.motion = {at(0, 0, -0.005)};
  EXPECT_NEAR(operation_overlap(o).depth, 0.005, 2e-4);  // its middle plane is 5 mm deep
  EXPECT_THROW(operation_overlap(o, -1), InvalidInput);
  o.motion.clear();
  EXPECT_THROW(operation_overlap(o), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
