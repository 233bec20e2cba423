#include "bindings.hpp"
#include "pickles.hpp"
#include "plain_structs.hpp"

namespace mmgrasp::python {

// Results and descriptions that are data alone pickle member by member.
void bind_plain_pickles(py::module_& m) {
  plain<Rejections>(m, "Rejections");
  plain<Box>(m, "Box");
  plain<Sphere>(m, "Sphere");
  plain<Cylinder>(m, "Cylinder");
  plain<Capsule>(m, "Capsule");
  plain<Plane>(m, "Plane");
  plain<Voxels>(m, "Voxels");
  plain<MeshShape>(m, "Mesh");
  plain<PointCloud>(m, "PointCloud");
  plain<ScrewThread>(m, "ScrewThread");
  plain<MeshSegment>(m, "MeshSegment");
  plain<GraspWidth>(m, "GraspWidth");
  plain<FittedPrimitive>(m, "FittedPrimitive");
  plain<MeshSegmentation>(m, "MeshSegmentation");
  plain<DerivativeFreeResult>(m, "DerivativeFreeResult");
  plain<SetCoverResult>(m, "SetCoverResult");
  plain<TourResult>(m, "TourResult");
  plain<SharedTours>(m, "SharedTours");
  plain<PairwiseWeights>(m, "PairwiseWeights");
  plain<NlpResult>(m, "NlpResult");
  plain<LinkShape>(m, "LinkShape");
  plain<RobotSource>(m, "RobotSource");
  plain<IkResult>(m, "IkResult");
  plain<IkBranches>(m, "IkBranches");
  plain<JointTrajectory>(m, "JointTrajectory");
  plain<RobotMotion>(m, "RobotMotion");
  plain<Contact>(m, "Contact");
  plain<DistanceResult>(m, "DistanceResult");
  plain<EdgeResult>(m, "EdgeResult");
  plain<BasePlacement>(m, "BasePlacement");
  plain<ContactPairProvenance>(m, "ContactPairProvenance");
  plain<PipeProvenance>(m, "PipeProvenance");
  plain<HeightMapProvenance>(m, "HeightMapProvenance");
  plain<Grasp>(m, "Grasp");
  plain<SuctionCup>(m, "SuctionCup");
  plain<Suction>(m, "Suction");
  plain<HandJoint>(m, "HandJoint");
  plain<HandBody>(m, "HandBody");
  plain<Hand>(m, "Hand");
  plain<SampledSuctionGrasps>(m, "SampledSuctionGrasps");
  plain<ClosingOutcome>(m, "ClosingOutcome");
  plain<PushGrasp>(m, "PushGrasp");
  plain<Graspability>(m, "Graspability");
  plain<RestingPose>(m, "RestingPose");
  plain<PlacedPart>(m, "PlacedPart");
  plain<RandomPlacement>(m, "RandomPlacement");
  plain<GraspSuccess>(m, "GraspSuccess");
  plain<ContactPatch>(m, "ContactPatch");
  plain<DrawnSuccess>(m, "DrawnSuccess");
  plain<GraspRating>(m, "GraspRating");
  plain<LineGrasp>(m, "LineGrasp");
  plain<GraspSynthesis>(m, "GraspSynthesis");
  plain<ViewCandidate>(m, "ViewCandidate");
  plain<NextView>(m, "NextView");
  plain<PlacedMesh>(m, "PlacedMesh");
  plain<AssemblyOperation>(m, "AssemblyOperation");
  plain<AssemblyGrasp>(m, "AssemblyGrasp");
  plain<FingerLengthRange>(m, "FingerLengthRange");
  plain<Facet>(m, "Facet");
  plain<KeepOff>(m, "KeepOff");
  plain<MotionStats>(m, "MotionStats");
  plain<MotionResult>(m, "MotionResult");
  plain<StraightLineResult>(m, "StraightLineResult");
  plain<CartesianResult>(m, "CartesianResult");
  plain<SearchTree>(m, "SearchTree");
  plain<Improvement>(m, "Improvement");
  plain<GraspReport>(m, "GraspReport");
  plain<ManipulationStats>(m, "ManipulationStats");
  plain<ManipulationResult>(m, "ManipulationResult");
}

}  // namespace mmgrasp::python
