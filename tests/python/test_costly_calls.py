"""Every call whose cost grows with its arguments lets other threads run and hears Ctrl-C; which calls do not, is said with the reason."""

from __future__ import annotations

import pytest

from argument_calls import CALLS
from costly_calls import COSTLY, measured

GAP_CAP, REACTION_CAP = (
    1.0,
    5.0,
)  # [s] of processor time: far above what is promised (0.2), far below what the calls take
QUICK = ["robust_intersections", "paired_order", "optimised_order", "planar_facets", "shortest_visiting_tour", "share_stops", "random_placement", "verify.overlapping_bodies"]  # fmt: skip

CHEAP = {
    "a value or a record is made of the arguments, in proportion to their size": """
        Suction SuctionCup
        AssemblyGrasp AssemblyOperation HoldingRequirement KeepOff BaseGrid BaseRegion BaseTracker BeamFrame BeamMaterial BeamMember BeamSection BeamSupport Box
        Capsule Cylinder DepthCamera DepthImage DepthNoise DepthNoise.stereo DepthNoise.structured_light DepthNoise.time_of_flight
        DriveByTask FingerGrip Grasp GridDistanceField Gripper GripperActuator Hand HandBody HandJoint HeightMap IkSeedDatabase
        JointTrajectory LineGrasp LinkShape ManipulationProblem NodeLoad ObjectPathEvaluator ObjectPathProblem OccupancyMap
        OrientationConstraint Part PartSupplyProblem PinholeCamera Pipe PlaceRegion PlacedMesh Plane ProbabilisticSdf RobotMotion
        RobotSource RobotSource.add_link RobotSource.add_urdf SegmentRequirement Sphere SupportingPlane ToolRegion Tray UnloadRegion World
        NonlinearProblem copper beam_frame round_section rectangular_section default_grasp_search eigengrasp_hand tray_shapes
        joint_limit_objective singularity_objective camera_view_objective self_distance_objective pose look_down
        verify.PlanToCheck verify.Fault _from_pickle _PlacedBodies
        """,
    "a text or arrays are made of a result": """
        write_plan segment_names
        BaseRegion.cells BaseRegion.part_cells RobotMotion.to_csv RobotMotion.to_joint_trajectory JointTrajectory.to_joint_trajectory
        ObjectRegions.base_region ObjectRegions.parts ObjectRegions.region GraspSynthesis.summary GraspOptimum.sag_candidates
        Robot.to_srdf Robot.to_urdf Gripper.to_urdf Gripper.finger_mesh Gripper.hand Hand.shapes Pipe.shapes FittedCuboid.shape
        CapabilityMap.slice World.copy World.shapes_of World.pose_of CollisionChecker.clone BeamFrame.split
        """,
    "a closed form of a few numbers": """
        held_load operation_load _suction_used _straight_approach _ik_seeds_of_a_grasp suction_share Hand.of_cups Hand.with_payload Hand.with_finger_depth
        BaseGrid.centre BasePath.duration BaseTracker.command BaseTracker.reset DepthNoise.sigma Gripper.holds Hand.joint_values
        Hand.opening_at Hand.posture_values Hand.pregrasp_opening Hand.share_open LineGrasp.probability LineGrasp.success
        PinholeCamera.project Pipe.grasp centric_grasps closing_outcome drive_arc flat_contact grasp_holding joint_velocity
        line_contact platform_velocity pose_to_xyz_quat pose_to_xyz_rpy push_grasp push_speed_limit quat_xyzw_from_rotation
        soft_finger_torque wheel_speeds make_base_grid pairwise_weights
        """,
    "one configuration, one pose, one time, one place or one body": """
        verify.pads_unlike_grasp verify.broken_seal seal_gap _centre_of_mass _closing_line _PlacedBodies.distance
        CapabilityMap.configuration CapabilityMap.index_at CollisionChecker.contacts CollisionChecker.distance
        CollisionChecker.distances CollisionChecker.first_contact CollisionChecker.is_free CollisionChecker.rejection
        IkObjective.evaluate IkSeedDatabase.add IkSeedDatabase.seeds JointGroup.at JointGroup.fk JointGroup.force_manipulability
        JointGroup.jacobian JointGroup.link_poses JointGroup.manipulability JointGroup.q JointGroup.state
        JointGroup.velocity_manipulability JointGroup.with_acceleration_limits JointGroup.with_reference JointGroup.within_limits
        JointTrajectory.at ReachDatabase.difference ReachDatabase.nearest ReachDatabase.query ReachDatabase.solve
        ReachDatabase.part_count Roadmap.near Robot.collisions Robot.group Robot.link_poses Robot.mount Robot.values
        Robot.velocity_scale Robot.with_disabled_pairs Robot.with_link RobotMotion.append RobotMotion.command_gripper
        RobotMotion.wait WholeBodyTrajectory.at WholeBodyTrajectory.drive_at World.add World.add_box World.add_cylinder World.add_field
        World.add_floor World.add_sphere World.allow World.attach World.detach World.disallow World.forget World.move World.remove
        SupportedFrame.displacement SupportedFrame.largest_displacement SupportedFrame.section_forces SupportedFrame.state
        BeamFrame.deflection BeamFrame.stiffness
        """,
    "at most a thousand waypoints or postures, or 4,096 seeds": """
        Hand.from_robot
        WholeBodyProgram.trajectory WholeBodyProgram.violations drive_by_program _first_drive_by_guess
        IkSeedDatabase.load IkSeedDatabase.save
        """,
    "a file of what another call took long to make, hundreds of megabytes in a second: that call is measured": """
        CapabilityMap.load CapabilityMap.save OccupancyMap.load OccupancyMap.save ReachDatabase.load ReachDatabase.save
        ReachDatabase.verify Roadmap.load Roadmap.save
        """,
    "one gripper: its links, some hundred grasps of one segment, or one operation (0.3 s for a path of 300,000 poses, 0.6 s with two meshes of 180,000 triangles)": """
        free_gripper rehearse_operation assembly_grasps
        """,
    "lists names, or looks up one": """
        _allowed_bodies cache_folder derivative_free_solver_names find_package grasp_search_names manipulation_planner_names
        nlp_solver_names planner_names population_search_names
        """,
    "checks options, or hands on to Python's own methods": """
        _check_arrival_covariance _check_options NonlinearProblem.constraint_bounds NonlinearProblem.constraint_name
        NonlinearProblem.constraints NonlinearProblem.gradient NonlinearProblem.hessian NonlinearProblem.hessian_pattern
        NonlinearProblem.jacobian NonlinearProblem.jacobian_pattern NonlinearProblem.objective NonlinearProblem.variable_bounds
        NonlinearProblem.variable_name
        """,
    "needs a whole problem, and ends by its progress callback and by Ctrl-C in tests of its own (test_interrupt.py, test_scenario.py, ...)": """
        CapabilityMap.restricted JointGroup.ik_branches ObjectRegions.remove RobotMotion.of_drive finger_length_range
        minimal_grippers plan_grippers preferred_grippers next_view optimize_grasp plan_drive_by plan_manipulation plan_object_pick
        plan_part_supply plan_pick plan_platform_locations plan_stop_picks share_headings shorten_drive_by solve_nonlinear
        verify.check_plan verify.check_schedule _drive_along
        """,
}


def test_every_call_is_costly_or_said_to_be_cheap() -> None:
    ends = ("_option_table", "_option_bounds", "._from_state", ".to_dict")
    shown = {
        call.function
        for call in CALLS
        if not call.is_setter and not call.function.endswith(ends) and not call.function.startswith("verify.Checked")
    }
    cheap = [name for names in CHEAP.values() for name in names.split()]
    costly = {name.partition(",")[0] for name in COSTLY}
    assert sorted(cheap) == sorted(set(cheap))
    assert set(cheap) & costly == set()
    assert shown - set(cheap) - costly == set()
    assert (set(cheap) | costly) - shown == set()


def check(names: list[str]) -> None:
    found = list(measured(names))
    assert [one.name for one in found] == names
    assert [
        one for one in found if one.how != "interrupted" and not (one.how == "returned" and one.name in SHORT)
    ] == []
    assert [one for one in found if one.gap > GAP_CAP or one.reaction > REACTION_CAP] == []


def test_some_costly_calls_hear_ctrl_c() -> None:
    check(QUICK)


SHORT = """
    JointGroup.jacobian_batch Voxels MeshDistanceField DistanceField.distances DistanceField.distances_and_gradients
    CollisionChecker.are_free CapabilityMap.score CapabilityMap.best_base_distance DepthImage.points ProbabilisticSdf.cast_rays
    ProbabilisticSdf.distances ProbabilisticSdf.points ProbabilisticSdf.save ProbabilisticSdf.load OccupancyMap.integrate
    OccupancyMap.query read_pcd run_policy WholeBodyTrajectory.sampled
    """.split()
"""They take 0.2 to 0.8 s: on a fast machine they may return before Ctrl-C comes."""
PARTS = 4


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_costly_calls_hear_ctrl_c(part: int) -> None:
    check(list(COSTLY)[part::PARTS])
