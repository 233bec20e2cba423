"""docs/limits.md is true: each of its rows is tried at the limit, where that is cheap, and beyond it, or tested where it says."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS, REPOSITORY
from mmgrasp.documents.reading import read_json, read_yaml
from mmgrasp.documents.yaml_text import parse_yaml

Tried = Callable[[dict[str, Any], Path], None]

BEYOND: dict[str, list[tuple[tuple[str | int, ...], Any, str]]] = {
    "names in scenarios": [
        (("name",), "x" * 201, "200 characters"),
        (("trays", 0, "name"), "a\x1b", "control characters"),
    ],
    "parts in one tray given as a grid": [(("trays", 0, "parts", "grid"), [11, 91], "1000")],
    "base grid": [
        (("options",), {"grid_resolution": 0.0009}, "grid_resolution"),
        (("options",), {"grid_resolution": 10.1}, "grid_resolution"),
        (("options",), {"grid_max_distance": 1001}, "grid_max_distance"),
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
    "`approach_distance`, `lift_height`": [
        (("options",), {"approach_distance": 0.0009}, "approach_distance"),
        (("options",), {"approach_distance": 10.1}, "approach_distance"),
        (("options",), {"lift_height": 0.009}, "lift_height"),
        (("options",), {"lift_height": 10.1}, "lift_height"),
    ],
    "`reach.samples`": [(("reach",), {"samples": 9999}, "10000")],
    "`robustness_samples`, `verify --samples`": [(("options",), {"robustness_samples": 1_000_001}, "base poses")],
    "`motion_time_limit`": [(("options",), {"motion_time_limit": 86_401}, "86400")],
    "threads": [(("options",), {"threads": 1025}, "1024")],
    "grasp sampler": [
        (("part_types", "bracket", "grasp_options"), {"approaches": 361}, "360"),
        (("part_types", "bracket", "grasp_options"), {"positions": 101}, "100"),
        (("part_types", "bracket", "grasp_options"), {"mesh_samples": 100_001}, "100000"),
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
    (("robot", "base_limits", "linear_velocity"), 0.001),
]
"""Values at the limit, which are read."""

ELSEWHERE = {
    "files that are read": "test_module_files.py: test_what_is_no_file_is_not_read",
    "folders of databases and capability maps": "test_module_files.py: test_a_database_does_not_replace_a_folder_with_more_in_it",
    "places that are written": "test_output_places.py: test_places_that_cannot_be_written_are_found_at_once",
    "what others write in the meantime": "test_output_places.py: test_what_somebody_writes_in_the_meantime_is_not_replaced",
    "maps of a floor": "test_floor_map.py: test_bad_images_are_refused",
    "route search": "test_base_route.cpp: ASearchThatRanOutSaysSo",
    "set cover": "test_interrupt.py: test_a_set_cover_is_interrupted_at_any_moment",
    "reachability database": "test_reach_file.cpp: ChangedConfigurationsNeverAnswer",
    "depth images": "test_frames.py: test_a_bad_image_is_named_and_the_others_are_read",
    "lists of poses": "test_frames.py: test_bad_trajectories",
    "`mmgrasp scan`": "test_scan_refusals.py: test_options_out_of_range",
    "`mmgrasp segment`, `segment_mesh`": "test_segment_command.py: test_units_that_cannot_be_right",
    "cache": "test_output_places.py: test_the_cache_is_optional",
    "memory": "test_small_processes.py: test_little_memory_is_one_message",
    "checked distances": "test_plan_check.cpp: too-long",
    "speed of a joint": "test_scenario.py: test_joints_that_crawl_are_refused",
    "coordinates, sizes, distances, poses, joint values": "test_largest_lengths.cpp: TEST(LargestLengths",
    "pixels of a camera": "test_numbers.py: test_numbers_that_are_none_are_refused_or_end",
    "`plan_drive_by`": "test_numbers.py: test_numbers_that_are_none_are_refused_or_end",
    "reach queries": "test_numbers.py: test_numbers_that_are_none_are_refused_or_end",
    "`plane_iterations`; set cover's `elements`; `track_base`": "test_numbers.py: test_numbers_that_are_none_are_refused_or_end",
    "`fit_cuboids`": "test_numbers.py: test_numbers_that_are_none_are_refused_or_end",
    "samples of a motion": "test_time_parameterization.cpp: RefusesMoreSamplesThanMemoryHolds",
}
"""Rows that are tested in another file: its name and the test's, or a word of it."""


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
