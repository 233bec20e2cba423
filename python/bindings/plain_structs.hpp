#pragma once

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/control/base_tracking.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/point_cloud.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/grasp/assembly_grasps.hpp"
#include "mmgrasp/grasp/contact_patch.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/graspability.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/grasp/keep_off.hpp"
#include "mmgrasp/grasp/line_grasp.hpp"
#include "mmgrasp/grasp/next_view.hpp"
#include "mmgrasp/grasp/push_grasp.hpp"
#include "mmgrasp/grasp/random_placement.hpp"
#include "mmgrasp/grasp/sample_suction_grasps.hpp"
#include "mmgrasp/grasp/success_model.hpp"
#include "mmgrasp/grasp/suction.hpp"
#include "mmgrasp/grasp/surface_draws.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"
#include "mmgrasp/gripper_design/grasp_holding.hpp"
#include "mmgrasp/gripper_design/gripper.hpp"
#include "mmgrasp/gripper_design/minimal_grippers.hpp"
#include "mmgrasp/gripper_design/operation_load.hpp"
#include "mmgrasp/gripper_design/operation_overlap.hpp"
#include "mmgrasp/gripper_design/plan_grippers.hpp"
#include "mmgrasp/gripper_design/segment_requirement.hpp"
#include "mmgrasp/gripper_design/soft_contact.hpp"
#include "mmgrasp/mapping/camera.hpp"
#include "mmgrasp/mapping/depth_camera.hpp"
#include "mmgrasp/mapping/depth_image.hpp"
#include "mmgrasp/mapping/fit_cuboids.hpp"
#include "mmgrasp/mapping/frame_registration.hpp"
#include "mmgrasp/mapping/height_map.hpp"
#include "mmgrasp/mapping/occupancy_map.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"
#include "mmgrasp/mapping/segment_objects.hpp"
#include "mmgrasp/optim/derivative_free.hpp"
#include "mmgrasp/optim/nlp_solver.hpp"
#include "mmgrasp/optim/nonlinear_problem.hpp"
#include "mmgrasp/optim/pairwise_weights.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/optim/shared_tours.hpp"
#include "mmgrasp/optim/tour.hpp"
#include "mmgrasp/plan/cartesian.hpp"
#include "mmgrasp/plan/improvement.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/plan/rrt_star_mg.hpp"
#include "mmgrasp/plan/straight_line.hpp"
#include "mmgrasp/reach/base_placement.hpp"
#include "mmgrasp/robot/detail/group_record.hpp"
#include "mmgrasp/robot/detail/robot_record.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "mmgrasp/robot/joint.hpp"
#include "mmgrasp/robot/planar_base.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "mmgrasp/robot/robot_motion.hpp"
#include "mmgrasp/robot/robot_source.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "mmgrasp/structure/beam_frame.hpp"
#include "mmgrasp/structure/beam_section.hpp"
#include "mmgrasp/structure/object_path.hpp"
#include "mmgrasp/structure/optimize_grasp.hpp"
#include "mmgrasp/structure/pipe.hpp"
#include "mmgrasp/structure/supported_frame.hpp"
#include "mmgrasp/task/base_grid.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "mmgrasp/task/pick.hpp"
#include "mmgrasp/task/platform_locations.hpp"
#include "mmgrasp/task/policies.hpp"
#include "mmgrasp/task/problem.hpp"
#include "mmgrasp/trajopt/optimize_whole_body.hpp"
#include "mmgrasp/verify/path_check.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "plain_fields.hpp"

namespace mmgrasp::python {

// Plain structs that pickle, and those that they hold. (A wrong number of members does not compile.)
template <>
inline constexpr std::size_t kFields<Contact> = 4;
template <>
inline constexpr std::size_t kFields<DistanceResult> = 7;
template <>
inline constexpr std::size_t kFields<EdgeResult> = 4;
template <>
inline constexpr std::size_t kFields<BaseTrackingResult> = 7;
template <>
inline constexpr std::size_t kFields<Rejections> = 5;
template <>
inline constexpr std::size_t kFields<FittedPrimitive> = 7;
template <>
inline constexpr std::size_t kFields<GraspWidth> = 3;
template <>
inline constexpr std::size_t kFields<MeshReport> = 10;
template <>
inline constexpr std::size_t kFields<TriangleMesh> = 5;
template <>
inline constexpr std::size_t kFields<PointCloud> = 6;
template <>
inline constexpr std::size_t kFields<MeshSegment> = 4;
template <>
inline constexpr std::size_t kFields<MeshSegmentation> = 7;
template <>
inline constexpr std::size_t kFields<ScrewThread> = 6;
template <>
inline constexpr std::size_t kFields<Box> = 1;
template <>
inline constexpr std::size_t kFields<Capsule> = 2;
template <>
inline constexpr std::size_t kFields<Cylinder> = 2;
template <>
inline constexpr std::size_t kFields<MeshShape> = 1;
template <>
inline constexpr std::size_t kFields<Plane> = 2;
template <>
inline constexpr std::size_t kFields<Sphere> = 1;
template <>
inline constexpr std::size_t kFields<Voxels> = 2;
template <>
inline constexpr std::size_t kFields<Facet> = 4;
template <>
inline constexpr std::size_t kFields<ContactPatch> = 8;
template <>
inline constexpr std::size_t kFields<AssemblyGrasp> = 9;
template <>
inline constexpr std::size_t kFields<AssemblyOperation> = 6;
template <>
inline constexpr std::size_t kFields<FingerLengthRange> = 5;
template <>
inline constexpr std::size_t kFields<PlacedMesh> = 3;
template <>
inline constexpr std::size_t kFields<ContactPairProvenance> = 4;
template <>
inline constexpr std::size_t kFields<Grasp> = 7;
template <>
inline constexpr std::size_t kFields<HeightMapProvenance> = 5;
template <>
inline constexpr std::size_t kFields<PipeProvenance> = 4;
template <>
inline constexpr std::size_t kFields<QualityFactor> = 3;
template <>
inline constexpr std::size_t kFields<Graspability> = 2;
template <>
inline constexpr std::size_t kFields<GraspabilityCounts> = 5;
template <>
inline constexpr std::size_t kFields<Hand> = 16;
template <>
inline constexpr std::size_t kFields<HandBody> = 4;
template <>
inline constexpr std::size_t kFields<HandJoint> = 4;
template <>
inline constexpr std::size_t kFields<KeepOff> = 5;
template <>
inline constexpr std::size_t kFields<KeepOffBox> = 2;
template <>
inline constexpr std::size_t kFields<LineGrasp> = 2;
template <>
inline constexpr std::size_t kFields<NextView> = 4;
template <>
inline constexpr std::size_t kFields<ViewCandidate> = 5;
template <>
inline constexpr std::size_t kFields<ClosingOutcome> = 11;
template <>
inline constexpr std::size_t kFields<PushGrasp> = 8;
template <>
inline constexpr std::size_t kFields<PlacedPart> = 3;
template <>
inline constexpr std::size_t kFields<RandomPlacement> = 2;
template <>
inline constexpr std::size_t kFields<RestingPose> = 2;
template <>
inline constexpr std::size_t kFields<SampledSuctionGrasps> = 4;
template <>
inline constexpr std::size_t kFields<GraspSuccess> = 7;
template <>
inline constexpr std::size_t kFields<ObjectExtent> = 2;
template <>
inline constexpr std::size_t kFields<Suction> = 5;
template <>
inline constexpr std::size_t kFields<SuctionCup> = 2;
template <>
inline constexpr std::size_t kFields<DrawnSuccess> = 3;
template <>
inline constexpr std::size_t kFields<GraspRating> = 6;
template <>
inline constexpr std::size_t kFields<GraspSynthesis> = 8;
template <>
inline constexpr std::size_t kFields<SynthesisCounts> = 14;
template <>
inline constexpr std::size_t kFields<FingerGrip> = 4;
template <>
inline constexpr std::size_t kFields<GraspHolding> = 4;
template <>
inline constexpr std::size_t kFields<Gripper> = 11;
template <>
inline constexpr std::size_t kFields<GripperActuator> = 5;
template <>
inline constexpr std::size_t kFields<MinimalGrippersResult> = 13;
template <>
inline constexpr std::size_t kFields<HeldLoad> = 4;
template <>
inline constexpr std::size_t kFields<HoldingRequirement> = 3;
template <>
inline constexpr std::size_t kFields<OperationLoad> = 6;
template <>
inline constexpr std::size_t kFields<OperationOverlap> = 4;
template <>
inline constexpr std::size_t kFields<PlanGrippersResult> = 12;
template <>
inline constexpr std::size_t kFields<RefusedGrasp> = 2;
template <>
inline constexpr std::size_t kFields<SegmentFate> = 10;
template <>
inline constexpr std::size_t kFields<SegmentedPart> = 2;
template <>
inline constexpr std::size_t kFields<SegmentRequirement> = 9;
template <>
inline constexpr std::size_t kFields<ContactArea> = 3;
template <>
inline constexpr std::size_t kFields<PinholeCamera> = 8;
template <>
inline constexpr std::size_t kFields<DepthCamera> = 5;
template <>
inline constexpr std::size_t kFields<DepthNoise> = 5;
template <>
inline constexpr std::size_t kFields<DepthImage> = 4;
template <>
inline constexpr std::size_t kFields<CuboidFit> = 5;
template <>
inline constexpr std::size_t kFields<FittedCuboid> = 4;
template <>
inline constexpr std::size_t kFields<FrameRegistration> = 11;
template <>
inline constexpr std::size_t kFields<HeightMap> = 7;
template <>
inline constexpr std::size_t kFields<OccupancyReport> = 4;
template <>
inline constexpr std::size_t kFields<IntegrationReport> = 12;
template <>
inline constexpr std::size_t kFields<SdfHits> = 5;
template <>
inline constexpr std::size_t kFields<ObjectSegmentation> = 5;
template <>
inline constexpr std::size_t kFields<SegmentedObject> = 2;
template <>
inline constexpr std::size_t kFields<SupportingPlane> = 2;
template <>
inline constexpr std::size_t kFields<DerivativeFreeResult> = 7;
template <>
inline constexpr std::size_t kFields<NlpResult> = 7;
template <>
inline constexpr std::size_t kFields<NlpViolations> = 2;
template <>
inline constexpr std::size_t kFields<PairwiseWeights> = 4;
template <>
inline constexpr std::size_t kFields<SetCoverResult> = 5;
template <>
inline constexpr std::size_t kFields<SharedTours> = 5;
template <>
inline constexpr std::size_t kFields<TourResult> = 5;
template <>
inline constexpr std::size_t kFields<CartesianResult> = 10;
template <>
inline constexpr std::size_t kFields<Improvement> = 5;
template <>
inline constexpr std::size_t kFields<GraspReport> = 5;
template <>
inline constexpr std::size_t kFields<ManipulationResult> = 12;
template <>
inline constexpr std::size_t kFields<ManipulationStats> = 14;
template <>
inline constexpr std::size_t kFields<StageReport> = 5;
template <>
inline constexpr std::size_t kFields<MotionResult> = 9;
template <>
inline constexpr std::size_t kFields<MotionStats> = 3;
template <>
inline constexpr std::size_t kFields<SearchTree> = 5;
template <>
inline constexpr std::size_t kFields<StraightLineResult> = 6;
template <>
inline constexpr std::size_t kFields<BasePlacement> = 3;
template <>
inline constexpr std::size_t kFields<IkResult> = 7;
template <>
inline constexpr std::size_t kFields<IkBranches> = 4;
template <>
inline constexpr std::size_t kFields<Joint> = 14;
template <>
inline constexpr std::size_t kFields<Link> = 4;
template <>
inline constexpr std::size_t kFields<LinkShape> = 5;
template <>
inline constexpr std::size_t kFields<BaseLimits> = 8;
template <>
inline constexpr std::size_t kFields<EndEffectorDescription> = 3;
template <>
inline constexpr std::size_t kFields<GroupDescription> = 5;
template <>
inline constexpr std::size_t kFields<RobotReport> = 3;
template <>
inline constexpr std::size_t kFields<GripperEvent> = 5;
template <>
inline constexpr std::size_t kFields<RobotMotion> = 8;
template <>
inline constexpr std::size_t kFields<AddedLink> = 4;
template <>
inline constexpr std::size_t kFields<RobotSource> = 5;
template <>
inline constexpr std::size_t kFields<UrdfSource> = 6;
template <>
inline constexpr std::size_t kFields<JointPath> = 1;
template <>
inline constexpr std::size_t kFields<JointTrajectory> = 5;
template <>
inline constexpr std::size_t kFields<BeamFrame> = 3;
template <>
inline constexpr std::size_t kFields<BeamMember> = 4;
template <>
inline constexpr std::size_t kFields<NodeLoad> = 4;
template <>
inline constexpr std::size_t kFields<BeamMaterial> = 4;
template <>
inline constexpr std::size_t kFields<BeamSection> = 8;
template <>
inline constexpr std::size_t kFields<ObjectPathResult> = 14;
template <>
inline constexpr std::size_t kFields<FeasibleGrasp> = 4;
template <>
inline constexpr std::size_t kFields<GraspOptimum> = 15;
template <>
inline constexpr std::size_t kFields<Pipe> = 3;
template <>
inline constexpr std::size_t kFields<BeamExtreme> = 3;
template <>
inline constexpr std::size_t kFields<BeamState> = 5;
template <>
inline constexpr std::size_t kFields<BeamSupport> = 3;
template <>
inline constexpr std::size_t kFields<BaseGrid> = 5;
template <>
inline constexpr std::size_t kFields<BaseRegion> = 6;
template <>
inline constexpr std::size_t kFields<PartExplanation> = 5;
template <>
inline constexpr std::size_t kFields<BasePath> = 5;
template <>
inline constexpr std::size_t kFields<Intersection> = 5;
template <>
inline constexpr std::size_t kFields<Intersections> = 5;
template <>
inline constexpr std::size_t kFields<Stop> = 6;
template <>
inline constexpr std::size_t kFields<StopSet> = 5;
template <>
inline constexpr std::size_t kFields<DriveByEvent> = 10;
template <>
inline constexpr std::size_t kFields<DriveByResult> = 9;
template <>
inline constexpr std::size_t kFields<PartRef> = 2;
template <>
inline constexpr std::size_t kFields<Obstruction> = 10;
template <>
inline constexpr std::size_t kFields<PartSupplyPlan> = 13;
template <>
inline constexpr std::size_t kFields<StageTime> = 2;
template <>
inline constexpr std::size_t kFields<Unloading> = 3;
template <>
inline constexpr std::size_t kFields<Pick> = 7;
template <>
inline constexpr std::size_t kFields<PickMotion> = 4;
template <>
inline constexpr std::size_t kFields<PlatformLocations> = 8;
template <>
inline constexpr std::size_t kFields<PlatformLocationsCounts> = 5;
template <>
inline constexpr std::size_t kFields<OptimisedOrder> = 4;
template <>
inline constexpr std::size_t kFields<PolicyResult> = 8;
template <>
inline constexpr std::size_t kFields<PolicyRound> = 5;
template <>
inline constexpr std::size_t kFields<Part> = 8;
template <>
inline constexpr std::size_t kFields<PlaceRegion> = 4;
template <>
inline constexpr std::size_t kFields<UnloadRegion> = 3;
template <>
inline constexpr std::size_t kFields<Tray> = 5;
template <>
inline constexpr std::size_t kFields<Violation> = 7;
template <>
inline constexpr std::size_t kFields<verify::PathCheckResult> = 3;
template <>
inline constexpr std::size_t kFields<verify::Fault> = 3;
template <>
inline constexpr std::size_t kFields<verify::PlanCheckResult> = 7;
template <>
inline constexpr std::size_t kFields<verify::StopRate> = 4;
template <>
inline constexpr std::size_t kFields<detail::VirtualJoint> = 4;
template <>
inline constexpr std::size_t kFields<detail::RobotContent> = 14;
template <>
inline constexpr std::size_t kFields<detail::RobotRecord> = 5;
template <>
inline constexpr std::size_t kFields<detail::GroupRecord> = 7;

}  // namespace mmgrasp::python
