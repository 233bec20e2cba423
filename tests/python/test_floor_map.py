"""Maps as ROS's map_server writes them: which cells are walls, how boxes cover them, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp import Box
from mmgrasp.documents.reading import read_yaml
from mmgrasp.scenario.floor_map import read_floor_map

HEADER = {
    "image": "room.pgm",
    "resolution": 0.1,
    "origin": [-1.0, 2.0, 0.0],
    "negate": 0,
    "occupied_thresh": 0.65,
    "free_thresh": 0.196,
}
WHITE, GREY, BLACK = 254, 205, 0


def write_map(
    folder: Path, cells: np.ndarray, kind: str = "P5", white: int = 255, unknown: str | None = None, **changed: Any
) -> Any:
    """The node of an obstacle with this map, (rows downwards, columns)."""
    rows, columns = cells.shape
    if kind == "P2":
        body = "\n".join(" ".join(map(str, row)) for row in cells.tolist()).encode()
    else:
        body = cells.astype(np.uint8 if white < 256 else ">u2").tobytes()
    (folder / "room.pgm").write_bytes(f"{kind}\n# a comment\n{columns} {rows}\n{white}\n".encode() + body)
    lines = [f"{key}: {value}" for key, value in (HEADER | changed).items() if value is not None]
    (folder / "room.yaml").write_text("\n".join(lines) + "\n")
    more = "" if unknown is None else f", unknown: {unknown}"
    (folder / "obstacle.yaml").write_text(f"walls: {{name: walls, map: room.yaml, height: 1.5{more}}}\n")
    return read_yaml(folder / "obstacle.yaml").root["walls"]


def covered(shapes: Any, rows: int, columns: int, yaw: float = 0.0) -> np.ndarray:
    """How often each cell's middle lies in a box, (rows downwards, columns), by the boxes' own poses."""
    x = -1.0 + np.array([[0.1 * (c + 0.5) * np.cos(yaw) - 0.1 * (rows - r - 0.5) * np.sin(yaw) for c in range(columns)] for r in range(rows)])  # fmt: skip
    y = 2.0 + np.array([[0.1 * (c + 0.5) * np.sin(yaw) + 0.1 * (rows - r - 0.5) * np.cos(yaw) for c in range(columns)] for r in range(rows)])  # fmt: skip
    points = np.stack([x, y, np.full_like(x, 0.75), np.ones_like(x)], -1)
    count = np.zeros((rows, columns), dtype=int)
    for shape in shapes:
        local = points @ np.linalg.inv(shape.pose).T
        count += (np.abs(local[..., :3]) < 0.5 * shape.shape.size).all(-1)
    return count


@pytest.mark.parametrize("kind, white", [("P5", 255), ("P2", 255), ("P5", 65535)])
@pytest.mark.parametrize("unknown", [None, "occupied", "free"])
def test_each_wall_cell_lies_in_one_box_and_no_other_cell(
    tmp_path: Path, kind: str, white: int, unknown: str | None
) -> None:
    rng = np.random.default_rng(5)
    image = rng.choice([WHITE, GREY, BLACK], size=(23, 31), p=[0.6, 0.2, 0.2])
    scaled = image * (white // 255)
    shapes = read_floor_map(write_map(tmp_path, scaled, kind, white, unknown))
    solid = image == BLACK if unknown == "free" else image != WHITE
    assert (covered(shapes, 23, 31) == solid).all()
    assert all(abs(s.pose[2, 3] - 0.75) < 1e-12 and isinstance(s.shape, Box) and s.shape.size[2] == 1.5 for s in shapes)


def test_origin_turns_and_negate_swaps(tmp_path: Path) -> None:
    image = np.full((4, 6), WHITE)
    image[0, :2] = BLACK  # at the upper left: low x, high y
    shapes = read_floor_map(write_map(tmp_path, image, origin=[-1.0, 2.0, 0.7]))
    assert len(shapes) == 1
    assert (covered(shapes, 4, 6, yaw=0.7) == (image == BLACK)).all()
    swapped = read_floor_map(write_map(tmp_path, 255 - image, negate=1))
    assert (covered(swapped, 4, 6) == (image == BLACK)).all()


def test_straight_walls_are_few_boxes(tmp_path: Path) -> None:
    image = np.full((60, 80), WHITE)
    image[0], image[-1], image[:, 0], image[:, -1] = BLACK, BLACK, BLACK, BLACK
    assert len(read_floor_map(write_map(tmp_path, image))) == 4


BAD: list[tuple[dict[str, Any], list[str]]] = [
    ({"resolution": 0}, ["room.yaml:2", "resolution = 0", ">= 0.001"]),
    ({"resolution": None}, ["room.yaml", "resolution is missing"]),
    ({"origin": "[0, 0]"}, ["room.yaml:3", "origin", "3 numbers"]),
    ({"negate": 2}, ["room.yaml:4", "negate = 2", "0 or 1"]),
    ({"free_thresh": 0.7}, ["room.yaml:6", "free_thresh = 0.7", "below occupied_thresh"]),
    ({"occupied_thresh": 65}, ["room.yaml:5", "occupied_thresh = 65"]),
    ({"mode": "raw"}, ["room.yaml:7", "mode", "trinary or scale"]),
    ({"image": "other.pgm"}, ["room.yaml:1", "other.pgm", "no such file"]),
    ({"image": "room.yaml"}, ["room.yaml:1", "must be a PGM"]),
    ({"image": "."}, ["room.yaml:1", "image"]),
    ({"resolutoin": 0.1}, ["room.yaml:7", "resolutoin", "did you mean resolution"]),
]


@pytest.mark.parametrize("changed, words", BAD)
def test_bad_maps_are_refused_at_their_line(tmp_path: Path, changed: dict[str, Any], words: list[str]) -> None:
    node = write_map(tmp_path, np.full((4, 6), BLACK), **changed)
    with pytest.raises(mg.InvalidInput) as error:
        read_floor_map(node)
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(
    "content, words",
    [
        (b"P5\n6 4\n255\n" + bytes(23), "truncated: 23 of 24 cells"),
        (b"P2\n6 4\n255\n" + b"0 " * 23, "truncated: 23 of 24 cells"),
        (b"P2\n6 4\n255\n" + b"x " * 24, "whole numbers"),
        (b"P2\n6 4\n100\n" + b"101 " * 24, "above its white"),
        (b"P5\n999999 999999\n255\n", "at most 25000000 cells"),
        (b"P5\n6 4\n0\n" + bytes(24), "white in"),
        (b"P6\n6 4\n255\n" + bytes(72), "must be a PGM"),
        (b"", "must be a PGM"),
        (b"P5" + b" " * 100_000 + b"x", "must be a PGM"),  # an expression that backtracks would not end
        (b"P5" + b"#\n " * 50_000 + b"6 x", "must be a PGM"),
        (b"P5\n6 4\n255\n" + bytes([WHITE]) * 24, "no occupied cell"),
    ],
)
def test_bad_images_are_refused(tmp_path: Path, content: bytes, words: str) -> None:
    node = write_map(tmp_path, np.full((4, 6), BLACK))
    (tmp_path / "room.pgm").write_bytes(content)
    with pytest.raises(mg.InvalidInput, match=words):
        read_floor_map(node)


def test_speckles_are_refused_with_their_number(tmp_path: Path) -> None:
    image = np.full((300, 300), WHITE)
    image[::2, ::2] = BLACK
    with pytest.raises(mg.InvalidInput, match="makes 22500 boxes, at most 20000"):
        read_floor_map(write_map(tmp_path, image))


@pytest.mark.slow
def test_a_room_from_a_map_is_planned_as_one_of_boxes(small: dict[str, Any], write: Any) -> None:
    """The same walls, once as boxes and once as cells of a map: the same plan, and verify compares the map's cells."""
    image = np.full((60, 60), WHITE)
    image[:2] = BLACK  # y from 4.8 to 5 m: behind everything
    wall = {"name": "wall", "box": [6.0, 0.2, 1.5], "pose": {"xyz": [2.0, 4.9, 0.75]}}
    by_boxes = mg.plan_part_supply(write({**small, "obstacles": [*small["obstacles"], wall]}))
    path = write({**small, "obstacles": [*small["obstacles"], {"name": "wall", "map": "room.yaml", "height": 1.5}]})
    write_map(path.parent, image, origin=[-1.0, -1.0, 0.0])
    by_map = mg.plan_part_supply(path)
    assert by_map.outcome == by_boxes.outcome == mg.Outcome.solved
    assert np.allclose([s.pose for s in by_map.stops], [s.pose for s in by_boxes.stops])
    plan = by_map.to_dict()
    assert mg.verify_plan(plan, scenario=path, samples=100).ok
    image[2] = BLACK
    write_map(path.parent, image, origin=[-1.0, -1.0, 0.0])
    assert "scenario-changed" in {f.code for f in mg.verify_plan(plan, scenario=path, samples=100).faults}


@pytest.mark.parametrize(
    "entry, words",
    [
        ({"map": "room.yaml"}, "height is missing"),
        ({"map": "room.yaml", "height": 1.0, "box": [1, 1, 1]}, "a map has no other shape"),
        ({"box": [1, 1, 1], "height": 1.0}, "only a map or a floor_plan has it"),
        ({"map": "room.yaml", "height": 1.0, "unknown": "maybe"}, "must be one of occupied, free"),
        ({"map": "nowhere.yaml", "height": 1.0}, "no such file"),
    ],
)
def test_bad_entries_are_refused(small: dict[str, Any], write: Any, entry: dict[str, Any], words: str) -> None:
    path = write({**small, "obstacles": [*small["obstacles"], {"name": "walls", **entry}]})
    write_map(path.parent, np.full((4, 6), BLACK))
    with pytest.raises(mg.InvalidInput, match=words):
        mg.load_scenario(path)
