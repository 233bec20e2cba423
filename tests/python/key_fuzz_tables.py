"""What may be read of a file though key_fuzz.py changed it, with the reason; all other changes must be refused."""

from __future__ import annotations

from typing import Any

from field_changes import Harmless

DROPPED, MISSPELT = object(), object()
WRONG: dict[str, Any] = {
    **{"null": None, "true": True, "no text": "", "a word": "x", "an escape": "\x1b[31m", "a long text": "a" * 300},
    **{"-1": -1, "0": 0, "0.5": 0.5, "1e7": 1e7, "-1e-9": -1e-9, "1e-300": 1e-300, "1e300": 1e300, "10**400": 10**400},
    **{"nan": float("nan"), "inf": float("inf"), "no entries": [], "two numbers": [1, 2]},
    **{"texts in a row": [[True, "1"]], "no keys": {}, "another key": {"a": 1}},
    **{"dropped": DROPPED, "misspelt": MISSPELT},
}  # fmt: skip
"""What a value becomes, by the name of the kind."""

ANY_SIGN = "-1, 0, -1e-9, 1e-300"
NO_AMOUNT = "0, 1e-300"
SIGNED = {
    "xyz",
    "rpy",
    "quat_xyzw",
    "start",
    "goal",
    "home",
    "joints",
    "closed",
    "open",
    "origin",
    "centre",
    "axis",
    "angle",
}
"""Coordinates, angles, and what joints stand at: of any sign, or 0. All other numbers are amounts."""
WHOLE = {
    "version",
    "grid",
    "targets",
    "seed",
    "samples",
    "max_evaluations",
    "nodes",
    "node",
    "section",
    "poses",
    "width",
    "height",
    "negate",
}
"""What is counted: there is no half of it."""
DEFAULT, SEVERAL, NONE, NAME = "has a default", "one of several", "there may be none", "any name will do"

HAND: Harmless = {
    "gripper.approach[]": ("-1, -1e-9, 1e-300", "a direction: backwards, or a rounding beside it"),
    "gripper.closing[]": ("-1, -1e-9, 1e-300", "a direction, as approach"),
    "gripper.clearance": (f"{NO_AMOUNT}, dropped", NONE),
    "gripper.joints": ("no entries", "fingers that do not move"),
    "gripper.joints[]": ("dropped", SEVERAL),
}
ROOM: Harmless = {
    "name": ("a word", NAME),
    "obstacles": ("no entries, dropped", NONE),
    "obstacles[]": ("dropped", SEVERAL),
    "obstacles[].name": ("a word", NAME),
    "obstacles[].pose": ("dropped", "stands where the world begins"),
    "options": ("no keys, dropped", DEFAULT),
    "options.seed": ("0, dropped", DEFAULT),
}
"""What scenarios and pipe problems have alike."""
_FINGERS, _TYPES = ("thumb", "finger_1", "finger_2"), ("pinch", "cylindrical", "spherical")
HAND_TYPES: Harmless = {
    "gripper.approach[]": HAND["gripper.approach[]"],
    **{f"gripper.groups.{group}": ("misspelt", NAME) for group in (*_FINGERS, "spread")},
    **{f"gripper.types.{kind}": ("misspelt, dropped", "any name, and one of several") for kind in _TYPES},
    **{f"gripper.types.{kind}.closed.{finger}_{joint}": ("dropped", "a joint that stays where it is")
       for kind, joint, fingers in [("pinch", "distal", _FINGERS[1:])]
       + [(kind, joint, _FINGERS[joint == "proximal" :]) for kind in _TYPES[1:] for joint in ("proximal", "distal")]
       for finger in fingers},
}  # fmt: skip
"""A hand of many joints by its types of grasp."""
SCENARIOS: Harmless = {
    **ROOM,
    **HAND,
    **{f"robot.base_limits{key}": ("no keys, dropped" if not key else "dropped", DEFAULT)
       for key in ("", ".linear_velocity", ".angular_velocity", ".linear_acceleration", ".angular_acceleration")},
    "robot.joints": ("no keys, dropped", "joints of which nothing is said stand at 0"),
    "robot.joints.head_pan_joint": ("dropped", "stands at 0"),
    "robot.joints.head_tilt_joint": ("dropped", "stands at 0"),
    "place_region.drop_height": (f"{NO_AMOUNT}, dropped", NONE),
    "positioning_uncertainty": (NO_AMOUNT, "a base that arrives exactly"),
    "trays[]": ("dropped", SEVERAL),
    "trays[].name": ("a word", NAME),
    "trays[].parts.grid": ("two numbers", "another grid"),
    "trays[].targets": ("no entries, two numbers, dropped", "no part, others, or all"),
    "trays[].targets[]": ("dropped", SEVERAL),
    "trays[].scan.rendered.parts[]": ("dropped", SEVERAL),
    "trays[].scan.rendered.parts[].xyz": ("two numbers", "stands on the tray's floor"),
    "trays[].scan.rendered.parts[].rpy": ("dropped", "not turned"),
    "trays[].scan.rendered.noise": ("dropped", DEFAULT),
    "trays[].scan.rendered.seed": ("0, dropped", DEFAULT),
    "options.grid_resolution": ("dropped", DEFAULT),
    "reach": ("no keys, dropped", DEFAULT),
    "reach.samples": ("dropped", DEFAULT),
}  # fmt: skip
PIPES: Harmless = {
    **ROOM,
    "structure.nodes[][]": (ANY_SIGN, "a coordinate"),
    "structure.sections[].nodes[]": ("0", "another node"),
    "structure.inner_diameter": (f"{NO_AMOUNT}, dropped", "a rod"),
    "structure.loads": ("no entries, dropped", NONE),
    "structure.loads[]": ("dropped", SEVERAL),
    "structure.loads[].node": ("0", "another node"),
    "structure.loads[].mass": (NO_AMOUNT, NONE),
    "start.rpy": ("dropped", "not turned"),
    "path.segments[]": ("dropped", SEVERAL),
    "path.segments[].line.to.rpy": ("dropped", "not turned"),
    "preferences": ("no keys, dropped", DEFAULT),
    "preferences.comparison": ("dropped", DEFAULT),
    "limits": ("no keys, dropped", DEFAULT),
    "limits.stress": ("1e7, dropped", "a pressure [Pa] may be so large; has a default"),
    "limits.sag": ("dropped", DEFAULT),
    "timing": ("no keys, dropped", DEFAULT),
    "timing.speed": ("dropped", DEFAULT),
    "timing.acceleration": ("dropped", DEFAULT),
    "compare": ("no entries, dropped", NONE),
    "compare[]": ("dropped", SEVERAL),
    "compare[].section": ("0", "another section"),
    "compare[].length": (NO_AMOUNT, "where the section begins"),
    "options.max_evaluations": ("dropped", DEFAULT),
}
ASSEMBLIES: Harmless = {
    "name": ("a word", NAME),
    "parts[].pose": ("dropped", "stands where the assembly begins"),
    "parts[].turned[]": ("two numbers, dropped", "another corner, or one less"),
    "parts[].turned[][0]": (NO_AMOUNT, "a corner on the axis"),
    "parts[].turned[][1]": (ANY_SIGN, "a height along the axis"),
    "order[]": ("dropped", SEVERAL),
    "order[].from": ("dropped", "stands there from the beginning"),
    "actuators[]": ("dropped", SEVERAL),
    "actuators[].name": ("a word", NAME),
    "fingers": ("no keys, dropped", DEFAULT),
    **{f"fingers.{key}": ("dropped", DEFAULT) for key in ("thickness", "shortest", "longest", "min_contact")},
    "fingers.width": ("0.5, dropped", "a length; has a default"),
    "fingers.clearance": (f"{NO_AMOUNT}, dropped", NONE),
}
CAMERAS: Harmless = {
    "sensors.left": ("no keys, dropped, misspelt", "cameras have names of their own, and all of one has a default"),
    "sensors.left.folder": (
        "a word, an escape, a long text, dropped",
        "a folder is looked for when its frames are read",
    ),
    "sensors.left.intrinsics.cx": (NO_AMOUNT, "the middle may lie at the border"),
    "sensors.left.intrinsics.cy": (NO_AMOUNT, "the middle may lie at the border"),
    "sensors.left.range": ("two numbers, dropped", "another range; has a default"),
    "sensors.left.depth_scale": ("dropped", DEFAULT),
    "sensors.left.noise": ("dropped", DEFAULT),
    "sensors.left.systematic": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.left.systematic_scale": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.left.mounted_on": ("dropped", "poses are the camera's"),
    "sensors.left.mounted_on.link": ("a word", "a link of a robot that is not known here"),
    "sensors.left.mounted_on.pose.quat_xyzw": ("dropped", "not turned"),
    "sensors.left.poses": ("dropped", DEFAULT),
    "sensors.left.pose_error": ("no keys, dropped", NONE),
    "sensors.left.pose_error.translation": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.left.pose_error.rotation": (f"{NO_AMOUNT}, dropped", NONE),
    "sensors.right": ("no keys, dropped, misspelt", "as sensors.left"),
    "sensors.right.noise": ("dropped", DEFAULT),
    "sensors.right.noise.constant": ("dropped", DEFAULT),
}
MAPS: Harmless = {"free_thresh": (NO_AMOUNT, "a cell is free when nothing speaks against it")}


def each(patterns: str, kinds: str, reason: str) -> Harmless:
    """The same about several places."""
    return dict.fromkeys(patterns.split(), (kinds, reason))


RECORD = "-1, 0, 0.5, 1e7, -1e-9, 1e-300, 1e300, dropped, misspelt"
# What is read of a plan has its form; what it says is for the check (mutation_shares.py).
PLANS: Harmless = {
    **each(
        """
        scenario.name scenario.source scenario.robot.urdf scenario.robot.srdf scenario.robot.urdfs[].urdf
        scenario.arm.joints[] scenario.robot.links[].name scenario.robot.links[].parent_link scenario.arm.tip_link
        scenario.gripper.tool_link scenario.gripper.joints[].name scenario.obstacles[].name scenario.parts[].name
        regions[].explanations[].part picks[].tray
        """,
        "a word, an escape, a long text",
        "a text: what it names is looked for by the check",
    ),
    **each(
        """
        scenario.robot.urdfs[].origin scenario.robot.urdfs[].prefix scenario.robot.urdfs[].parent_link
        """,
        "no text, a word, an escape, a long text",
        "a text, or none for the first robot",
    ),
    "scenario.gripper.finger_links[]": ("a word, an escape, a long text, dropped", "a text; one of several"),
    **each("scenario.robot.urdfs[].mesh_files scenario.robot.base_limits premises.headings", "no keys", NONE),
    **each("scenario.other_joints scenario.reach premises.database", "no keys, another key", "names of their own"),
    **each(
        """
        scenario.robot.links scenario.robot.links[].shapes scenario.robot.meshes scenario.gripper.joints
        scenario.gripper.finger_links scenario.obstacles scenario.parts[].grasps regions[].explanations regions
        intersections[].trays too_small_intersections stops[].trays route picks[].motions obstructions
        drive_by.motions
        """,
        "no entries",
        NONE,
    ),
    **each(
        """
        scenario.robot.links[].shapes[] scenario.robot.links[] scenario.gripper.joints[] scenario.obstacles[]
        scenario.parts[].grasps[] scenario.parts[] regions[].cells.0[] regions[].cells.1[] regions[].explanations[]
        regions[] intersections[].trays[] stops[].trays[] route[].poses[] route[] picks[].motions[] drive_by.motions[]
        """,
        "dropped",
        SEVERAL,
    ),
    **each(
        """
        scenario.robot.base_limits.linear_velocity scenario.robot.base_limits.angular_velocity
        scenario.robot.base_limits.linear_acceleration scenario.robot.base_limits.angular_acceleration
        scenario.robot.base_limits.workspace scenario.robot.base_limits.wheel_separation scenario.arrival_covariance
        stops[].arrivals drive_by.motions[].begins drive_by.motions[].ends drive_by
        """,
        "dropped",
        DEFAULT,
    ),
    **each(
        """
        scenario.gripper.approach[] scenario.gripper.closing[] scenario.arrival_covariance[][]
        scenario.trays[].headings[] grid.headings[] stops[].pose[] picks[].motions[].positions[][]
        picks[].motions[].velocities[][] picks[].motions[].accelerations[][] drive_by.motions[].positions[][]
        drive_by.motions[].velocities[][] drive_by.motions[].accelerations[][]
        """,
        ANY_SIGN,
        "of any sign",
    ),
    "scenario.floor": (f"null, {ANY_SIGN}", "no floor, or one at any height"),
    **each(
        "scenario.other_joints.head_pan_joint scenario.other_joints.head_tilt_joint",
        f"{ANY_SIGN}, dropped, misspelt",
        "of any sign",
    ),
    "route[].poses[][]": (ANY_SIGN, "of any sign; the check follows the way"),
    **each(
        """
        scenario.gripper.max_opening scenario.gripper.clearance scenario.positioning_uncertainty
        scenario.place_region.drop_height scenario.parts[].grasps[].opening scenario.options.grid_max_distance
        intersections[].radius stops[].radius route[].length route[].turning route[].duration
        picks[].motions[].opening picks[].motions[].times[] robustness_rate drive_by.motions[].opening
        drive_by.motions[].close_at drive_by.motions[].closed_at drive_by.motions[].times[]
        """,
        NO_AMOUNT,
        "an amount, or none",
    ),
    **each(
        "scenario.gripper.finger_depth scenario.gripper.finger_width",
        "1e-300",
        "an amount above 0",
    ),
    **each(
        """
        regions[].cells.0[][] regions[].cells.1[][] regions[].explanations[].grasps
        regions[].explanations[].base_poses_tried regions[].explanations[].base_poses_feasible
        regions[].explanations[].rejections.unreachable regions[].explanations[].rejections.limits
        regions[].explanations[].rejections.self_collision regions[].explanations[].rejections.scene
        regions[].explanations[].rejections.grasp_filter intersections[].heading intersections[].cells
        stops[].intersection stops[].arrivals.served lower_bound picks[].stop picks[].grasp premises.grasps
        drive_by.motions[].pick
        """,
        "0",
        "the first one, or none of them",
    ),
    **each("regions[].cells.0 regions[].cells.1", "no entries, dropped", "a heading without cells"),
    "regions[].cells": ("no keys", "a region without cells"),
    **each(
        """
        scenario.place_region.size scenario.trays[].headings grid.origin grid.headings intersections[].centre
        picks[].motions[].times drive_by.motions[].times
        """,
        "two numbers",
        "two others",
    ),
    "scenario.parts[].grasps[].quality": (f"{ANY_SIGN}, 1e7, 1e300", "a measure without bounds"),
    **each(
        """
        scenario.options.grid_resolution scenario.options.positioning_uncertainty scenario.options.motion_time_limit
        scenario.options.route_resolution scenario.reach.samples scenario.reach.position_cell
        scenario.reach.rotation_cell scenario.reach.max_per_cell scenario.reach.min_manipulability
        scenario.reach.thinning scenario.reach.seed premises.database.samples premises.database.position_cell
        premises.database.rotation_cell premises.database.max_per_cell premises.database.min_manipulability
        premises.database.thinning premises.database.seed
        """,
        RECORD,
        "a record of how it was planned, compared by the check",
    ),
    **each(
        "scenario.options.ik_seeds scenario.options.robustness_samples scenario.options.seed",
        "0, dropped, misspelt",
        "a record of how it was planned, compared by the check",
    ),
    **each(
        "premises.headings.A premises.headings.B premises.headings.D",
        "no entries, two numbers, dropped, misspelt",
        "headings that trays were tried with, compared by the check",
    ),
    **each(
        "premises.headings.A[] premises.headings.B[] premises.headings.D[]",
        f"{ANY_SIGN}, 1e7, 1e300, dropped",
        "a heading that a tray was tried with",
    ),
    "premises.cell": ("1e-300, 0.5, 1e7, 1e300", "a premise, compared by the check"),
    **each(
        "premises.positioning_uncertainty premises.max_distance premises.ik_seeds",
        f"{NO_AMOUNT}, 0.5, 1e7, 1e300",
        "a premise, compared by the check",
    ),
}

GRIPPERS: Harmless = {
    **HAND,
    "robot.srdf": ("dropped", DEFAULT),
    "robot.group": (", ".join(kind for kind in WRONG if kind != "misspelt"), "the arm's, for which nobody asks here"),
}
