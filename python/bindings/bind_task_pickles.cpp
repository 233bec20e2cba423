#include "bindings.hpp"
#include "pickles.hpp"
#include "plain_structs.hpp"

namespace mmgrasp::python {

// Results and descriptions that are data alone pickle member by member, from structures on.
void bind_task_pickles(py::module_& m) {
  auto v = py::reinterpret_borrow<py::module_>(m.attr("verify"));
  plain<BaseTrackingResult>(m, "BaseTrackingResult");
  plain<Part>(m, "Part");
  plain<Tray>(m, "Tray");
  plain<PlaceRegion>(m, "PlaceRegion");
  plain<UnloadRegion>(m, "UnloadRegion");
  plain<BaseGrid>(m, "BaseGrid");
  plain<PartExplanation>(m, "PartExplanation");
  plain<BaseRegion>(m, "BaseRegion");
  plain<Intersection>(m, "Intersection");
  plain<Intersections>(m, "Intersections");
  plain<Stop>(m, "Stop");
  plain<StopSet>(m, "StopSet");
  plain<BasePath>(m, "BasePath");
  plain<OptimisedOrder>(m, "OptimisedOrder");
  plain<PolicyRound>(m, "PolicyRound");
  plain<PolicyResult>(m, "PolicyResult");
  plain<PickMotion>(m, "PickMotion");
  plain<Pick>(m, "Pick");
  plain<Unloading>(m, "Unloading");
  plain<Obstruction>(m, "Obstruction");
  plain<PartSupplyPlan>(m, "PartSupplyPlan");
  plain<DriveByResult>(m, "DriveByResult");
  plain<PlatformLocations>(m, "PlatformLocations");
  plain<PinholeCamera>(m, "PinholeCamera");
  plain<DepthImage>(m, "DepthImage");
  plain<HeightMap>(m, "HeightMap");
  plain<FittedCuboid>(m, "FittedCuboid");
  plain<CuboidFit>(m, "CuboidFit");
  plain<DepthNoise>(m, "DepthNoise");
  plain<DepthCamera>(m, "DepthCamera");
  plain<IntegrationReport>(m, "IntegrationReport");
  plain<SdfHits>(m, "SdfHits");
  plain<FrameRegistration>(m, "FrameRegistration");
  plain<OccupancyReport>(m, "OccupancyReport");
  plain<SupportingPlane>(m, "SupportingPlane");
  plain<SegmentedObject>(m, "SegmentedObject");
  plain<ObjectSegmentation>(m, "ObjectSegmentation");
  plain<Pipe>(m, "Pipe");
  plain<BeamMaterial>(m, "BeamMaterial");
  plain<BeamSection>(m, "BeamSection");
  plain<BeamMember>(m, "BeamMember");
  plain<NodeLoad>(m, "NodeLoad");
  plain<BeamSupport>(m, "BeamSupport");
  plain<BeamExtreme>(m, "BeamExtreme");
  plain<BeamState>(m, "BeamState");
  plain<BeamFrame>(m, "BeamFrame");
  plain<ObjectPathResult>(m, "ObjectPathResult");
  plain<FeasibleGrasp>(m, "FeasibleGrasp");
  plain<GraspOptimum>(m, "GraspOptimum");
  plain<SegmentRequirement>(m, "SegmentRequirement");
  plain<Gripper>(m, "Gripper");
  plain<GripperActuator>(m, "GripperActuator");
  plain<MinimalGrippersResult>(m, "MinimalGrippersResult");
  plain<ContactArea>(m, "ContactArea");
  plain<FingerGrip>(m, "FingerGrip");
  plain<GraspHolding>(m, "GraspHolding");
  plain<HoldingRequirement>(m, "HoldingRequirement");
  plain<OperationLoad>(m, "OperationLoad");
  plain<HeldLoad>(m, "HeldLoad");
  plain<OperationOverlap>(m, "OperationOverlap");
  plain<SegmentedPart>(m, "SegmentedPart");
  plain<SegmentFate>(m, "SegmentFate");
  plain<PlanGrippersResult>(m, "PlanGrippersResult");
  plain<verify::PathCheckResult>(v, "PathCheckResult");
  plain<verify::Fault>(v, "Fault");
  plain<verify::StopRate>(v, "StopRate");
  plain<verify::PlanCheckResult>(v, "PlanCheckResult");
}

}  // namespace mmgrasp::python
