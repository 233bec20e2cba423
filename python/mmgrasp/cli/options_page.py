"""Writes docs/options.md from the defaults of the C++ structs: python -m mmgrasp.cli.options_page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .. import _core

Table = Callable[[], dict[str, tuple[Any, str]]]

SECTIONS: tuple[tuple[str, str, Table, set[str]], ...] = (
    ("options", "How to plan (`PartSupplyOptions`)", _core._supply_option_table, {"positioning_uncertainty"}),
    ("reach", "The reachability database (`ReachOptions`)", _core._reach_option_table, set()),
    (
        "capability_map",
        "Keywords of `CapabilityMap.build` (`CapabilityOptions`)",
        _core._capability_option_table,
        set(),
    ),
    ("grasp_options", "The grasp sampler of a part type (`GraspSamplerOptions`)", _core._grasp_option_table, set()),
    (
        "suction_grasps",
        "The same for a hand of suction cups; keywords of `sample_suction_grasps` (`SuctionSamplerOptions`)",
        _core._suction_option_table,
        set(),
    ),
    ("ik", "Inverse kinematics, keywords of `JointGroup.ik` and its kin (`IkOptions`)", _core._ik_option_table, set()),
    ("collision_checker", "Keywords of `CollisionChecker` (`CheckerOptions`)", _core._checker_option_table, set()),
    ("check_edge", "Keywords of `CollisionChecker.check_edge` (`EdgeOptions`)", _core._edge_option_table, set()),
    ("plan_motion", "Motions of arm and base, keywords (`MotionOptions`)", _core._motion_option_table, set()),
    (
        "plan_cartesian",
        "Straight Cartesian paths, keywords; those of `plan_straight_line` are all but `max_branches` (`CartesianOptions`)",
        _core._cartesian_option_table,
        set(),
    ),
    (
        "time_parameterize",
        "Timing of paths, keywords; also of `time_parameterize_free` (`TimingOptions`)",
        _core._timing_option_table,
        set(),
    ),
    (
        "follow_object_path",
        "Keywords of `follow_object_path`, `ObjectPathEvaluator` and `optimize_grasp` (`ObjectPathOptions`)",
        _core._object_path_option_table,
        set(),
    ),
    ("optimize_grasp", "The search of `optimize_grasp` (`PopulationOptions`)", _core._population_option_table, set()),
    (
        "optimize_grasp_proof",
        "The proof of `optimize_grasp` (`GraspSearchOptions`)",
        _core._grasp_search_option_table,
        set(),
    ),
    (
        "assembly_grasps",
        "Grasps of an assembly's parts, keywords of `jaw_grasps` and `centric_grasps` (`AssemblyGraspOptions`)",
        _core._assembly_grasp_option_table,
        set(),
    ),
    (
        "plan_grippers",
        "From parts and an order to grippers, keywords (`PlanGrippersOptions`)",
        _core._plan_grippers_option_table,
        set(),
    ),
    (
        "minimal_grippers",
        "The least set of grippers, keywords (`MinimalGrippersOptions`)",
        _core._minimal_grippers_option_table,
        set(),
    ),
    ("roadmap", "Keywords of `Roadmap.build` (`RoadmapOptions`)", _core._roadmap_option_table, set()),
    (
        "plan_manipulation",
        "Carrying an object with any of many grasps, keywords (`ManipulationOptions`)",
        _core._manipulation_option_table,
        set(),
    ),
    (
        "plan_platform_locations",
        "Two base poses for two tool poses, keywords (`PlatformLocationsOptions`)",
        _core._platform_option_table,
        set(),
    ),
    (
        "evaluate_graspability",
        "Grasps from a height map, keywords (`GraspabilityOptions`)",
        _core._graspability_option_table,
        set(),
    ),
    (
        "synthesize_grasps",
        "Grasps of unknown parts in a map, keywords (`SynthesisOptions`, `SuccessOptions`, `ContactPatchOptions`)",
        _core._synthesis_option_table,
        set(),
    ),
    (
        "track_base",
        "A base on its plan, keywords; those of `BaseTracker` are the first eight (`BaseTrackingOptions`, `BaseDisturbance`)",
        _core._tracking_option_table,
        set(),
    ),
    (
        "pipe_grasps",
        "Grasps of a pipe, keywords of `Pipe.sample_grasps` (`PipeGraspOptions`)",
        _core._pipe_grasp_option_table,
        set(),
    ),
    ("push_grasp", "A grasp in passing, keywords (`PushGraspProblem`)", _core._push_option_table, set()),
    (
        "plan_drive_by",
        "Grasping while driving, keywords (`DriveByOptions`, `WholeBodyOptions`)",
        _core._drive_by_option_table,
        set(),
    ),
    ("ProbabilisticSdf", "A map of surfaces, keywords (`SdfOptions`)", _core._sdf_option_table, set()),
    ("OccupancyMap", "An octree of cells, keywords (`OccupancyOptions`)", _core._occupancy_option_table, set()),
    ("fit_cuboids", "Box-shaped parts of a cloud, keywords (`CuboidFitOptions`)", _core._cuboid_option_table, set()),
    (
        "segment_objects",
        "Objects on a plane, keywords also of `segment_depth_image` (`ObjectSegmentationOptions`)",
        _core._segmentation_option_table,
        set(),
    ),
    (
        "segment_mesh",
        "Segments of a part, keywords of `segment_mesh` (`MeshSegmentationOptions`)",
        _core._mesh_segmentation_option_table,
        set(),
    ),
    (
        "shape_diameters",
        "Local thickness, keywords of `shape_diameters` (`ShapeDiameterOptions`)",
        _core._shape_diameter_option_table,
        set(),
    ),
)


def options_page() -> str:
    """docs/options.md."""
    lines = ["# Options of a scenario", "", "Written by `./dev docs` from the library's own defaults.", ""]
    for section, title, table, elsewhere in SECTIONS:
        bounds = _bounds(table)
        head = "| option | default | from, to | meaning |" if bounds else "| option | default | meaning |"
        lines += [f"## `{section}`: {title}", "", head, "|---" * (head.count("|") - 1) + "|"]
        for name, (default, help_) in table().items():
            if name in elsewhere:
                continue
            least_most = bounds.get(name)
            within = f" {least_most[0]:g}, {least_most[1]:g} |" if least_most else " |" if bounds else ""
            lines.append(f"| `{name}` | {default} |{within} {help_} |")
        lines.append("")
    return "\n".join(lines)


def _bounds(table: Callable[[], dict[str, Any]]) -> dict[str, tuple[float, float]]:
    """Those of a table that files may set, by the option's name."""
    of_table = getattr(_core, table.__name__.replace("_option_table", "_option_bounds"), None)
    return of_table() if of_table else {}


if __name__ == "__main__":
    print(options_page(), end="")
