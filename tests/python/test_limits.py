"""docs/limits.md is true: each of its rows is tried at the limit, where that is cheap, and beyond it, or tested where it says."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from argument_objects import ARM, BOX, GRID, OBJECTS, POSE, ROBOT, drive_by
from conftest import ASSETS, REPOSITORY
from mmgrasp.cli import main
from mmgrasp.cli.arguments import build_parser
from mmgrasp.documents.reading import read_json, read_yaml
from mmgrasp.documents.yaml_text import parse_yaml
from mmgrasp.frames import poses, redwood, tum
from mmgrasp.scenario import floor_map
from number_tables import drive

Tried = Callable[[dict[str, Any], Path], None]

BEYOND: dict[str, list[tuple[tuple[str | int, ...], Any, str]]] = {
    "names in scenarios": [
        (("name",), "x" * 201, "200 characters"),
        (("trays", 0, "name"), "a\x1b", "control characters"),
    ],
    "parts in one tray": [
        (("trays", 0, "parts"), {"type": "bracket", "grid": [11, 91], "spacing": [0.2, 0.2]}, "1000"),
        (("trays", 0, "parts"), [{"type": "bracket", "xyz": [0, 0]}] * 1001, "1000"),
    ],
    "size and place of a tray": [
        (("trays", 0, "size"), [0.3, 100.1, 0.1], "metres"),
        (("trays", 0, "pose"), {"xyz": [0, 110.1, 0.5]}, "metres"),
    ],
    "trays of a scenario": [(("trays",), [{"name": "a"}] * 1001, "1000 trays")],
    "obstacles of a scenario": [(("obstacles",), [{"name": "a", "sphere": 0.1}] * 10_001, "10000 obstacles")],
    "size and place of an obstacle": [
        (("obstacles",), [{"name": "a", "box": [1500, 80, 900]}], "metres"),
        (("obstacles",), [{"name": "a", "sphere": 0.1, "pose": {"xyz": [0, 1001, 0]}}], "metres"),
    ],
    "headings of a tray": [(("trays", 0, "headings"), [0.017 * i for i in range(361)], "360 headings")],
    "base grid": [
        (("options",), {"grid_resolution": 0.0009}, "grid_resolution"),
        (("options",), {"grid_resolution": 10.1}, "grid_resolution"),
        (("options",), {"grid_max_distance": 1001}, "grid_max_distance"),
        (("options",), {"grid_resolution": 0.01, "grid_max_distance": 23}, "20 million cells"),
    ],
    "speed of a base": [
        (("robot", "base_limits", "linear_velocity"), 0.0009, "0.001"),
        (("robot", "base_limits", "angular_acceleration"), 0.0009, "0.001"),
    ],
    "base workspace": [(("start",), [101.0, 0, 0], "workspace"), (("goal",), [0, -101.0, 0], "workspace")],
    "`route_resolution`": [
        (("options",), {"route_resolution": 0.0009}, "route_resolution"),
        (("options",), {"route_resolution": 101}, "route_resolution"),
    ],
    "`drive_clearance`": [
        (("drive_clearance",), value, "0, or lie between 0.001 and 10") for value in (-0.01, 0.0009, 10.1)
    ],
    "`approach_distance`, `lift_height`": [
        (("options",), {"approach_distance": 0.0009}, "approach_distance"),
        (("options",), {"approach_distance": 10.1}, "approach_distance"),
        (("options",), {"lift_height": 0.009}, "lift_height"),
        (("options",), {"lift_height": 10.1}, "lift_height"),
    ],
    "`reach`": [
        (("reach",), {"samples": 9999}, "10000"),
        (("reach",), {"samples": 2_000_000_001}, "samples"),
        (("reach",), {"max_per_cell": 1_000_001}, "max_per_cell"),
        (("reach",), {"position_cell": 0.0009}, "position_cell"),
    ],
    "`robustness_samples`, `verify --samples`": [(("options",), {"robustness_samples": 1_000_001}, "base poses")],
    "`motion_time_limit`": [(("options",), {"motion_time_limit": 86_401}, "86400")],
    "threads": [(("options",), {"threads": 1025}, "1024")],
    "grasp sampler": [
        (("part_types", "bracket", "grasp_options"), {"approaches": 361}, "360"),
        (("part_types", "bracket", "grasp_options"), {"positions": 101}, "100"),
        (("part_types", "bracket", "grasp_options"), {"mesh_samples": 100_001}, "100000"),
        (("part_types", "bracket", "grasp_options"), {"max_grasps": 1_000_001}, "max_grasps"),
        (("part_types", "bracket", "grasp_options"), {"standoff": 10.1}, "standoff"),
        (("part_types", "bracket", "grasp_options"), {"friction": 10.1}, "friction"),
    ],
}
"""Values of a scenario just beyond a row's limit, and a piece of what is said of them."""

AT: list[tuple[tuple[str | int, ...], Any]] = [
    (("name",), "x" * 200),
    (("start",), [-1.6, -1.6, 0.0]),
    (
        ("options",),
        {"grid_resolution": 0.001, "route_resolution": 0.001, "approach_distance": 0.001, "lift_height": 0.01},
    ),
    (("options",), {"grid_resolution": 10, "grid_max_distance": 1000, "route_resolution": 100, "lift_height": 10}),
    (("options",), {"robustness_samples": 1_000_000, "motion_time_limit": 86_400, "threads": 1024}),
    (("reach",), {"samples": 10_000, "threads": 1024}),
    (("reach",), {"samples": 2_000_000_000, "max_per_cell": 1_000_000, "position_cell": 0.001}),
    (("part_types", "bracket", "grasp_options"), {"max_grasps": 1_000_000, "standoff": 0.01, "friction": 10}),
    (("trays", 0, "headings"), [0.017 * i for i in range(360)]),
    (("options",), {"grid_resolution": 0.01, "grid_max_distance": 22}),
    (("robot", "base_limits", "linear_velocity"), 0.001),
]
"""Values at the limit, which are read."""

ELSEWHERE = {
    "what is counted (iterations, restarts, draws, evaluations)": "test_far_out.py: a_budget_beyond_the_largest",
    "steps that paths and edges are walked in, sample periods": "test_far_out.py: steps_that_cannot_be_counted",
    "COLLADA meshes (.dae)": "test_mesh_fuzz.py: def test_collada_that_is_refused(",
    "folders of databases and capability maps": "test_module_files.py: def test_a_database_does_not_replace_a_folder_with_more_in_it(",
    "places that are written": "test_output_places.py: def test_places_that_cannot_be_written_are_found_at_once(",
    "what others write in the meantime": "test_output_folder.py: def test_what_somebody_writes_in_the_meantime_is_not_replaced(",
    "route search": "test_base_route.cpp: TEST(BaseRoute, ASearchThatRanOutSaysSo)",
    "`mmgrasp grippers`": "test_assembly_meshes.py: def test_mesh_files_that_cannot_be_parts(",
    "`plan_grippers`": "test_rehearsed_set.cpp: EndsAfterSoManyRehearsalsAndWhenItIsStopped)",
    "`minimal_grippers`, `solve_set_cover`": "test_minimal_grippers.cpp: RefusesCostsThatTheProofWouldNotTellApart)",
    "set cover": "test_interrupt.py: def test_a_set_cover_is_interrupted_at_any_moment(",
    "reachability database": "test_file_copy.cpp: TEST(FileCopy, WhatWasCutOffIsMissedAndWhatWasReadStays)",
    "depth images": "test_frames.py: def test_a_bad_image_is_named_and_the_others_are_read(",
    "`unload_region`": "test_carried_parts.py: def test_odd_regions_are_refused(",
    "suction cups of a gripper": "test_suction.py: def test_what_cups_do_not_hold_is_refused(",
    "cache": "test_output_places.py: def test_the_cache_is_optional(",
    "memory": "test_small_processes.py: def test_little_memory_is_one_message(",
    "checked distances": 'test_plan_check.cpp: codes_of(plan).count("too-long")',
    "speed of a joint": "test_scenario.py: def test_joints_that_crawl_are_refused(",
    "samples of a motion": "test_time_parameterization.cpp: RefusesMoreSamplesThanMemoryHolds)",
    "other numbers of calls": "test_bad_arguments.py: def test_bad_arrays_are_refused_by_name(",
    "options of scenarios, pipe problems and commands": "test_option_bounds.py: def test_a_scenario_is_refused_at_the_line(",
}
"""Rows that are no number to step over, or that only the library's own tests can: the file and the test's opening."""


def put(document: dict[str, Any], place: tuple[str | int, ...], value: Any) -> dict[str, Any]:
    out = copy.deepcopy(document)
    inner: Any = out
    for key in place[:-1]:
        inner = inner.setdefault(key, {}) if isinstance(key, str) else inner[key]
    inner[place[-1]] = value
    return out


def text_refused(text: str, words: str) -> None:
    with pytest.raises(mg.InvalidInput, match=words):
        parse_yaml(text, "file")


def try_yaml(small: dict[str, Any], folder: Path) -> None:
    parse_yaml("- x\n" * 99_999, "file")
    text_refused("- x\n" * 100_001, "more than 100000 values")
    text_refused("a: &a [" + "x," * 999 + "]\nb: [" + "*a," * 101 + "]", "more than 100000 values")
    parse_yaml("[" * 50 + "]" * 50, "file")
    text_refused("[" * 51 + "]" * 51, "more than 50 deep")
    text_refused("a: 1\n---\nb: 2\n", "one document")
    text_refused("a: !!str 1\n--- \n", "one document")
    text_refused("a: !x 1", "the tag")
    file = folder / "large.yaml"
    file.write_text("#" * 4_000_001)
    with pytest.raises(mg.IoError, match="4000000 bytes"):
        read_yaml(file)
    for text in ("1000001", "-1000001", "1e-7"):
        with pytest.raises(mg.InvalidInput):
            box = put(small, ("obstacles", 0, "box"), [float(text), 1.0, 1.0])
            file.write_text(yaml.safe_dump(box))
            mg.load_scenario(file)


def try_json(small: dict[str, Any], folder: Path) -> None:
    file = folder / "plan.json"
    for text, words in [
        ('{"a": 1, "a": 2}', "given twice"),
        ('{"a": NaN}', "no number"),
        ('{"a": ' + "9" * 301 + "}", "301 digits"),
        ("[" * 51 + "]" * 51, "more than 50 deep"),
        ("[" + "[]," * 25_000_000 + "[]]", "50,000,000"),
        ("{" + "".join(f'"{i}":0,' for i in range(100_000)) + '"0":0}', "given twice"),
    ]:
        file.write_text(text)
        with pytest.raises(mg.InvalidInput, match=words):
            read_json(file)
    file.write_text("[" * 50 + "9" * 300 + "]" * 50)
    read_json(file)
    with open(file, "wb") as large:
        large.truncate(1_000_000_001)  # a hole: no byte of it is on the disk
    with pytest.raises(mg.IoError, match="1000000000 bytes"):
        read_json(file)


def try_files(small: dict[str, Any], folder: Path) -> None:
    doors: list[tuple[str, int, Callable[[Path], Any]]] = [
        ("robot.urdf", 256_000_000, lambda path: mg.Robot.load(path)),
        ("mesh.stl", 4_000_000_000, lambda path: mg.Mesh.load(path)),
        ("map.bt", 4_000_000_000, lambda path: mg.World().add_octree("map", path)),
    ]
    for name, most, read in doors:
        with open(folder / name, "wb") as large:
            large.truncate(most + most // 10)
        with pytest.raises(mg.Error, match=name):
            read(folder / name)


def chain(links: int) -> str:
    """A robot of so many links in a row."""
    names = "".join(f"<link name='l{i}'/>" for i in range(links))
    joints = "".join(
        f"<joint name='j{i}' type='fixed'><parent link='l{i}'/><child link='l{i + 1}'/></joint>"
        for i in range(links - 1)
    )
    return f"<robot name='long'>{names}{joints}</robot>"


Taken = Callable[[Any], Any]


def step_over(call: Taken, most: Any, beyond: Any, words: str = "must") -> None:
    """The limit is taken, and what is beyond it refused."""
    call(most)
    with pytest.raises(mg.Error, match=words):
        call(beyond)


def try_kinds(small: dict[str, Any], folder: Path) -> None:
    for place in ("/dev/zero", folder):
        for read in (mg.load_scenario, mg.Robot.load, mg.Mesh.load, mg.verify_plan, mg.mapping.read_pcd):
            with pytest.raises(mg.Error):
                read(place)


def try_lengths(small: dict[str, Any], folder: Path) -> None:
    def size_of(x: float) -> None:
        mg.World().add_box("box", [x, 1, 1])

    step_over(size_of, 1e6, 1.000001e6)
    step_over(size_of, 1e-9, 0.9e-9)
    step_over(lambda x: mg.World().add_box("box", [1, 1, 1], mg.pose([x, 0, 0])), -1e6, -1.000001e6)
    step_over(lambda x: mg.Mesh.from_arrays([[x, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2]]), 1e6, 1.000001e6)


def try_pixels(small: dict[str, Any], folder: Path) -> None:
    step_over(lambda width: mg.mapping.PinholeCamera(width=width, height=5000), 10_000, 10_001)


def try_drive_by(small: dict[str, Any], folder: Path) -> None:
    given = drive()
    for name, beyond in (("waypoints", 1001), ("goal_configurations", 10_001)):
        with pytest.raises(mg.InvalidInput, match=name):
            mg.plan_drive_by(**{**given, name: beyond})
    mg.plan_drive_by(**{**given, "goal_configurations": 10_000})
    found = drive_by()
    steps = 1_000_000 // len(found.trajectory.times)
    step_over(found.trajectory.rolled_out, steps, steps + 1, "steps")
    duration = found.trajectory.times[-1]
    period = max(duration / 1e6, 1e-4)
    step_over(lambda p: mg.planning.RobotMotion.of_drive_by(found, period=p), 1.001 * period, 0.9e-4, "period")


def try_reach_queries(small: dict[str, Any], folder: Path) -> None:
    reach = OBJECTS["ReachDatabase"]()
    step_over(lambda count: reach.nearest(POSE, count), 1_000_000, 1_000_001, "count")
    for name in ("count", "candidates"):
        step_over(lambda most, name=name: reach.solve(ARM, POSE, **{name: most}), 1_000_000, 1_000_001, name)  # type: ignore[misc]
    with pytest.raises(mg.InvalidInput, match="seeds"):
        reach.base_poses_for(ARM, POSE, seeds=1_000_001)


def try_iterations(small: dict[str, Any], folder: Path) -> None:
    cloud = np.random.default_rng(1).uniform(-1, 1, (100, 3)) * [1, 1, 0.001]
    with pytest.raises(mg.InvalidInput, match="plane_iterations"):
        mg.mapping.segment_objects(cloud, plane_iterations=1_000_001)
    step_over(lambda most: mg.optim.solve_set_cover(most, [[0]], time_limit=1), 10_000_000, 10_000_001, "elements")
    still = mg.planning.JointTrajectory(["x", "y", "theta"], [0.0, 100.0], np.zeros((2, 3)))
    with pytest.raises(mg.InvalidInput, match="period"):
        mg.base.track_base(ROBOT, still, period=0.9e-4)


def try_leaf(small: dict[str, Any], folder: Path) -> None:
    cube = np.random.default_rng(1).uniform(0, 1, (3000, 3))
    cube[:2000, 2] = 0  # the plane that carries the rest
    cube[2000:, 2] *= 0.25
    mg.mapping.fit_cuboids(cube, leaf=1 / 700)
    with pytest.raises(mg.InvalidInput, match="leaf"):
        mg.mapping.fit_cuboids(cube, leaf=1 / 800)


def try_capability(small: dict[str, Any], folder: Path) -> None:
    """A cube of 200 voxels a side with 50 poses is at the limit; one pose more, or the default 200, is refused at once."""
    given: Any = {"lower": (-1, -1, -1), "upper": (1, 1, 1), "voxel": 0.01}
    for each in (51, 200):
        with pytest.raises(mg.InvalidInput, match="4e8 tool poses"):
            mg.base.CapabilityMap.build(ARM, poses=each, **given)
    with pytest.raises(mg.InvalidInput, match="rolls"):  # looked at after the number of poses
        mg.base.CapabilityMap.build(ARM, poses=50, rolls=3, **given)


def try_masks(small: dict[str, Any], folder: Path) -> None:
    """The hand's masks reach hypot(half its width, half its length) / resolution cells."""
    with pytest.raises(mg.InvalidInput, match="10000 cells"):
        mg.grasping.hand_masks(OBJECTS["Hand"](), 0.05, 0.3, 1e-7)
    with pytest.raises(mg.InvalidInput, match="at most 65535"):
        mg.grasping.hand_masks(OBJECTS["Hand"](), 0.05, 0.3, 1e-4)
    mg.grasping.hand_masks(OBJECTS["Hand"](), 0.05, 0.3, 1e-3)


def try_floor_map(small: dict[str, Any], folder: Path) -> None:
    """A chessboard of 200 x 200 black cells, none beside another, and one more."""
    image = np.full((400, 402), 254, np.uint8)
    image[::2, :400:2] = 0

    def read(cells: np.ndarray) -> None:
        (folder / "room.pgm").write_bytes(b"P5\n%d %d\n255\n" % cells.shape[::-1] + cells.tobytes())
        (folder / "room.yaml").write_text(
            "image: room.pgm\nresolution: 0.05\norigin: [30.0, 30.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
        )
        (folder / "obstacles.yaml").write_text("map: room.yaml\nheight: 1.0\n")
        floor_map.read_floor_map(read_yaml(folder / "obstacles.yaml").root)

    more = image[:202].copy()
    more[201, 0] = 0
    read(image[:200])
    for cells in (image, np.zeros((5001, 5000), np.uint8)):
        with pytest.raises(mg.InvalidInput, match=r"20000|25"):
            read(cells)


def try_scan(small: dict[str, Any], folder: Path) -> None:
    parser = build_parser()
    for option, least, most in (("--voxel", 1e-4, 10.0), ("--truncation", 1e-4, 10.0), ("--max-memory", 1.0, 1e7)):
        for value in (least, most):
            parser.parse_args(["scan", "frames", "-o", "map", f"{option}={value!r}"])
        for value in (0.99 * least, 1.01 * most):
            with pytest.raises(SystemExit):
                parser.parse_args(["scan", "frames", "-o", "map", f"{option}={value!r}"])


def try_segment(small: dict[str, Any], folder: Path) -> None:
    for across, is_taken in ((0.00101, True), (0.00099, False), (2.99, True), (3.01, False)):
        x = across / 3**0.5
        lines = "".join(f"v {x * i} {x * j} {x * k}\n" for i in (0, 1) for j in (0, 1) for k in (0, 1))
        faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
        (folder / "cube.obj").write_text(lines + faces)
        assert (main(["segment", str(folder / "cube.obj"), "--unit", "m", "--json"]) == 0) == is_taken, across


def try_poses(small: dict[str, Any], folder: Path) -> None:
    def read(x: float) -> None:
        poses.pose_of_quaternion([x, 0, 0], [0, 0, 0, 1], "pose")

    step_over(read, 1e6, 1.000001e6, "1e6")
    path = folder / "trajectory.log"
    with open(path, "wb") as large:
        large.truncate(500_000_001)  # a hole: no byte of it is on the disk
    for reader in (redwood._read_trajectory, tum._read_rows):
        with pytest.raises(mg.IoError, match="500000000 bytes"):
            reader(path)


def try_robust_sets(small: dict[str, Any], folder: Path) -> None:
    regions = [mg.base.BaseRegion("tray", np.ones((1, 3, 4), np.uint8), GRID)]
    step_over(lambda most: mg.base.robust_intersections(GRID, regions, 0.01, most), 10_000_000, 10_000_001, "max_sets")
    with pytest.raises(mg.InvalidInput, match="max_sets"):
        mg.base.robust_intersections(GRID, regions, 0.01, 0)


def try_draws(small: dict[str, Any], folder: Path) -> None:
    step_over(
        lambda most: mg.mapping.random_placement([BOX], [0.3, 0.4, 0.1], count=1, draws=most),
        1_000_000,
        1_000_001,
        "draws",
    )


def try_robot(small: dict[str, Any], folder: Path) -> None:
    file = folder / "long.urdf"
    file.write_text(chain(2000))
    assert len(mg.Robot.load(file).links) == 2000
    file.write_text(chain(2001))
    with pytest.raises(mg.Error, match=r"long\.urdf.*2000"):
        mg.Robot.load(file)
    file.write_text("<robot name='deep'>" + "<a>" * 300 + "</a>" * 300 + "</robot>")
    with pytest.raises(mg.Error, match="200"):
        mg.Robot.load(file)


def try_world(small: dict[str, Any], folder: Path) -> None:
    """As many bodies as memory holds: ten thousand are read, checked, and cost what lies near."""
    world = mg.World()
    for i in range(10_000):
        world.add_box(f"box {i}", size=(0.02, 0.02, 0.02), pose=mg.pose([5 + 0.05 * (i % 100), 0.05 * (i // 100), 0.5]))
    assert len(world.objects) == 10_000
    robot = mg.Robot.load(
        ASSETS / "robots" / "kr6like" / "kr6like.urdf", ASSETS / "robots" / "kr6like" / "kr6like.srdf"
    )
    arm = robot.group("arm", tip="gripper_tcp")
    checker = mg.CollisionChecker(robot, world, group=arm)
    home = 0.5 * (arm.lower + arm.upper)
    assert checker.is_free(home) == mg.CollisionChecker(robot, mg.World(), group=arm).is_free(home)


TRIED: dict[str, Tried] = {
    "files that are read": try_kinds,
    "coordinates, sizes, distances, poses, joint values": try_lengths,
    "pixels of a camera": try_pixels,
    "`plan_drive_by`": try_drive_by,
    "reach queries": try_reach_queries,
    "`plane_iterations`; set cover's `elements`; `track_base`": try_iterations,
    "`fit_cuboids`": try_leaf,
    "`CapabilityMap.build`": try_capability,
    "masks of a hand (`hand_masks`, `graspability_map`, `evaluate_graspability`)": try_masks,
    "maps of a floor": try_floor_map,
    "`mmgrasp scan`": try_scan,
    "`mmgrasp segment`, `segment_mesh`": try_segment,
    "lists of poses": try_poses,
    "`robust_intersections`": try_robust_sets,
    "`random_placement`": try_draws,
    "scenario or profile (YAML)": try_yaml,
    "plan (JSON)": try_json,
    "URDF, SRDF, xacro; mesh, point cloud, octree, roadmap; map of surfaces": try_files,
    "robot": try_robot,
    "world": try_world,
}


def rows() -> list[str]:
    table = [line for line in (REPOSITORY / "docs" / "limits.md").read_text().splitlines() if line.startswith("| ")]
    return [line.split("|")[1].strip() for line in table[1:]]


def test_every_row_is_tried() -> None:
    assert set(rows()) == BEYOND.keys() | TRIED.keys() | ELSEWHERE.keys()


@pytest.mark.parametrize("row", ELSEWHERE)
def test_what_is_tested_elsewhere_is_there(row: str) -> None:
    name, _, word = ELSEWHERE[row].partition(": ")
    found = [path for path in (REPOSITORY / "tests").rglob(name) if word in path.read_text()]
    assert found, ELSEWHERE[row]


@pytest.mark.parametrize("row", TRIED)
def test_rows(row: str, small: dict[str, Any], tmp_path: Path) -> None:
    TRIED[row](small, tmp_path)


@pytest.mark.parametrize(
    ("place", "value", "words"), [entry for entries in BEYOND.values() for entry in entries], ids=lambda x: str(x)[:40]
)
def test_values_beyond(
    place: tuple[str | int, ...], value: Any, words: str, small: dict[str, Any], tmp_path: Path
) -> None:
    file = tmp_path / "scenario.yaml"
    file.write_text(yaml.safe_dump(put(small, place, value), sort_keys=False, allow_unicode=True))
    with pytest.raises(mg.InvalidInput, match=rf"scenario\.yaml:\d+: .*{words}"):
        mg.load_scenario(file)


@pytest.mark.parametrize(("place", "value"), AT, ids=lambda x: str(x)[:40])
def test_values_at_the_limit(place: tuple[str | int, ...], value: Any, small: dict[str, Any], tmp_path: Path) -> None:
    file = tmp_path / "scenario.yaml"
    file.write_text(yaml.safe_dump(put(small, place, value), sort_keys=False))
    mg.load_scenario(file)
