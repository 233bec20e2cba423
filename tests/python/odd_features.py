"""Scenarios that use everything a scenario can say at once, drawn at random: what `odd_scenarios.py all` plans and checks."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import yaml

import mmgrasp as mg

SCENARIOS = Path(mg.__file__).parent / "assets" / "scenarios"

# Boxes, cylinders, balls, meshes, several shapes; the listed grasps hold the box from above and from the side.
DOWN = {"xyz": [0.0, 0.0, 0.0], "rpy": [0.0, math.pi / 2, 0.0]}
LEVEL = {"xyz": [0.0, 0.0, 0.0]}
PART_TYPES: dict[str, dict[str, Any]] = {
    "bracket": {"box": [0.03, 0.05, 0.07]},
    "listed": {"box": [0.05, 0.04, 0.06], "grasps": [{"pose": DOWN, "opening": 0.04, "quality": 0.9}, {"pose": LEVEL, "opening": 0.04}]},
    "bushing": {"cylinder": {"radius": 0.018, "length": 0.08}},
    "sleeve": {"cylinder": {"radius": 0.028, "length": 0.07}, "grasp_options": {"approaches": 12, "positions": 2, "standoff": 0.005}},
    "ball": {"sphere": 0.025},
    "cone": {"mesh": "cone.stl", "grasp_options": {"max_grasps": 60}},
    "angle": {"mesh": "asset:objects/angle.stl", "grasp_options": {"mesh_samples": 200, "max_grasps": 60}},
    "tee": {
        "shapes": [
            {"box": [0.03, 0.03, 0.06]},
            {"box": [0.03, 0.07, 0.02], "pose": {"xyz": [0.0, 0.0, 0.03]}},
        ]
    },
}  # fmt: skip
# Where the tables of the shipped scenarios have room for a tray: x, y, height, yaw.
PLACES = {
    "storeroom": [(2.78, -1.40, 0.706, 0.0), (2.78, -0.75, 0.706, 0.0), (2.78, 0.15, 0.706, 0.0), (0.0, 1.98, 0.706, math.pi / 2), (0.8, 1.98, 0.706, math.pi / 2)],
    "omni_cell": [(1.68, -0.65, 0.756, 0.0), (1.68, 0.0, 0.756, 0.0), (1.68, 0.65, 0.756, 0.0), (-2.08, 0.3, 0.756, math.pi)],
}  # fmt: skip
ARM = {"storeroom": ("torso_lift_link", "gripper_palm_link"), "omni_cell": ("base_link", "wrist_3_link")}


def full_scenario(seed: int, folder: Path) -> dict[str, Any]:
    """A shipped robot between its walls with two or three drawn trays, and each other feature in one of a few scenarios.

    Files that it names (meshes, maps, clouds, octrees) are written into `folder`.
    """
    draw = Random(seed)
    base = draw.choice(list(PLACES))
    scenario: dict[str, Any] = yaml.safe_load((SCENARIOS / f"{base}.yaml").read_text())
    places = draw.sample(PLACES[base], draw.choice([1, 2, 2, 2, 3]))
    scenario.pop("reach")
    (folder / "cone.stl").write_text(cone(0.024, 0.07))
    scenario.update(
        name=f"full {seed}",
        part_types=PART_TYPES,
        trays=[_tray(f"T{i}", place, draw) for i, place in enumerate(places)],
        options={"grid_resolution": draw.choice([0.05, 0.07, 0.1]), "seed": draw.randint(1, 9), "threads": 1},
    )
    for share, feature in FEATURES:
        if draw.random() < share:
            feature(scenario, draw, folder)
    return scenario


def cone(radius: float, height: float, sides: int = 24) -> str:
    """ASCII STL: a part whose sides stand askew to the pads that hold it [m]."""
    around = [(radius * math.cos(a), radius * math.sin(a), 0.0) for a in (math.tau * i / sides for i in range(sides))]
    facets = ["solid cone"]
    for a, b in zip(around, [*around[1:], around[0]], strict=True):
        for corners in ((a, b, (0.0, 0.0, height)), (b, a, (0.0, 0.0, 0.0))):
            points = "".join(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in corners)
            facets.append(f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet")
    return "\n".join([*facets, "endsolid cone", ""])


def _tray(name: str, place: tuple[float, float, float, float], draw: Random) -> dict[str, Any]:
    x, y, height, yaw = place
    x, y = x + draw.choice([0.0, 0.0, -0.03, 0.02]), y + draw.choice([0.0, 0.0, 0.03])
    tray: dict[str, Any] = {"name": name, "size": [0.30, 0.40, 0.10]}
    kind = draw.choice(["plain", "container", "walls", "shelf", "body", "rack"])
    pitch = 0.0
    if kind == "container":
        tray["size"] = draw.choice(["R-KLT 4315", "R-KLT 4322", "R-KLT 4315 lengthwise"])
        height += 0.035
    elif kind == "walls":
        tray["wall"] = draw.choice([0.01, [0.01, 0.02, 0.015]])
        tray["walls"] = {"front": draw.choice([0.0, 0.03]), "left": draw.choice([0.02, 0.08])}
        height += 0.015
    elif kind == "shelf":
        tray.update(size=[0.32, 0.42, 0.06], wall=0.02, walls={"front": 0.0}, roof=draw.choice([0.3, 0.45]))
        height += 0.02
    elif kind == "body":
        tray["body"] = {
            "shapes": [
                {"box": [0.30, 0.40, 0.01], "pose": {"xyz": [0.0, 0.0, -0.005]}},
                {"box": [0.01, 0.40, 0.06], "pose": {"xyz": [0.145, 0.0, 0.03]}},
            ]
        }
        height += 0.01
    elif kind == "rack":
        pitch = draw.choice([-0.1, -0.2, 0.1])
        tray["walls"] = {"front": 0.04}
        height += 0.06
    tray["pose"] = {"xyz": [x, y, height], "rpy": [0.0, pitch, yaw + draw.choice([0.0, 0.0, 0.1])]}
    if draw.random() < 0.3:
        turns = draw.sample([0.0, 0.4, -0.4, math.pi / 2, -math.pi / 2], draw.randint(1, 3))
        tray["headings"] = [round(yaw + turn, 6) for turn in turns]
    tray.update(_parts(draw))
    return tray


def _parts(draw: Random) -> dict[str, Any]:
    """Parts and targets: a grid or a list; by index, by name, by number, all."""
    kinds = list(PART_TYPES)
    if draw.random() < 0.5:
        kind = draw.choice(kinds)
        rows, columns = draw.choice([(1, 2), (2, 2), (2, 3)])
        parts: Any = {"type": kind, "grid": [rows, columns], "spacing": [0.11, 0.105]}
        if draw.random() < 0.5:
            parts["yaw"] = draw.choice([0.2, -0.5, 1.2])
        targets: Any = [0, rows * columns - 1] if draw.random() < 0.6 else {kind: draw.randint(1, 2)}
    else:
        first, second = draw.choice(kinds), draw.choice(kinds)
        parts = [
            {"type": first, "name": "one", "xyz": [-0.06, 0.09], "rpy": [0.0, 0.0, draw.choice([0.0, 0.5])]},
            {"type": second, "name": "two", "xyz": [-0.06, -0.08]},
            {"type": first, "name": "three", "xyz": [0.06, 0.08, 0.06]},
        ]
        targets = draw.choice([["two", "one"], ["one"], "all", {first: 1}])
    return {"parts": parts, "targets": targets}


def _uncertainty(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["positioning_uncertainty"] = draw.choice([0.0, 0.03, 0.05, 0.15])


def _arrivals(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    x, y, c, t = (draw.choice(row) for row in ([1e-4, 9e-4], [1e-4, 4e-4], [0.0, 5e-5], [0.0, 3e-4, 2e-3]))
    scenario["arrival_covariance"] = [[x, c, 0.0], [c, y, 0.0], [0.0, 0.0, t]]


def _padding(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    fingers = dict.fromkeys(scenario["gripper"].get("finger_links", []), 0.0)
    links = draw.choice([0.0, 0.002, 0.005, 0.01])
    scenario["padding"] = {
        "links": links,
        "attached": draw.choice([0.0, 0.0005]),
        "objects": draw.choice([0.0, 0.0005]),
        "by_name": fingers,
    }


def _lengths(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["options"].update(
        approach_distance=draw.choice([0.02, 0.05, 0.12]),
        lift_height=draw.choice([0.03, 0.08, 0.2]),
        ik_seeds=draw.choice([4, 8, 16]),
    )


def _driving(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["drive_clearance"] = draw.choice([0.02, 0.1, 0.25])


def _searches(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["options"].update(
        route_resolution=draw.choice([0.05, 0.1, 0.25]),
        robustness_samples=draw.choice([0, 200, 2000]),
        grid_max_distance=draw.choice([0.0, 0.9, 1.3]),
    )


def _base(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    limits = scenario["robot"]["base_limits"]
    limits["workspace"] = draw.choice([2.6, 3.0, 5.0])
    limits["linear_velocity"] = draw.choice([0.05, 0.6, 2.0])
    if scenario["robot"]["base"] == "diff_drive":
        limits.update(wheel_velocity=draw.choice([0.3, 0.8]), wheel_separation=0.4)
    elif draw.random() < 0.5:
        limits.update(wheel_velocity=draw.choice([0.4, 1.0]), wheel_separation=0.38, wheelbase=draw.choice([0.3, 0.5]))


def _wheels(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    """A robot's data sheet in place of speeds of the base."""
    robot = scenario["robot"]
    wheels = {"radius": 0.06, "speed": draw.choice([6.0, 17.4]), "track": 0.38}
    if robot["base"] == "omni":
        wheels["wheelbase"] = draw.choice([0.3, 0.48])
    kept = ["workspace", "linear_acceleration", "angular_acceleration"]
    if draw.random() < 0.5:
        wheels["acceleration"] = draw.choice([20.0, 60.0])
        kept = kept[:1]
    robot["wheels"] = wheels
    robot["base_limits"] = {key: value for key, value in robot["base_limits"].items() if key in kept}


def _frames(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    shape: dict[str, Any] = draw.choice(
        [{"sphere": 0.04}, {"box": [0.05, 0.1, 0.03]}, {"cylinder": {"radius": 0.02, "length": 0.2}}]
    )
    scenario["robot"]["frames"] = [
        {"name": "lamp", "parent": "base_link", "pose": {"xyz": [-0.2, 0.25, 0.5], "rpy": [0.1, 0.0, 0.3]}, **shape}
    ]


def _second_hand(scenario: dict[str, Any], _: Random, __: Path) -> None:
    scenario["robot"]["mount"] = [
        {
            "urdf": "asset:grippers/parallel/parallel.urdf",
            "parent_link": "base_link",
            "pose": {"xyz": [-0.1, 0.22, 0.6], "rpy": [0.0, -1.2, 0.0]},
            "prefix": "spare_",
        }
    ]


def _simpler(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["robot"]["mesh_tolerance"] = draw.choice([0.002, 0.01])


def _measured_hand(scenario: dict[str, Any], _: Random, __: Path) -> None:
    scenario["gripper"] = {"from_robot": True, "clearance": 0.008}
    scenario.pop("padding", None)


def _hand(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["gripper"].update(closing_speed=draw.choice([0.02, 0.3]), clearance=draw.choice([0.004, 0.012]))


def _drop(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["place_region"]["drop_height"] = draw.choice([0.01, 0.05, 0.1])


def _floor(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["floor"] = draw.choice([-0.02, "none"])


def _touching(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    names = [o["name"] for o in scenario["obstacles"]]
    scenario["allowed_collisions"] = [
        [scenario["gripper"].get("finger_links", ["base_link"])[0], draw.choice(names)],
        ["base_link", f"tray {scenario['trays'][0]['name']}"],
    ]


def _bodies(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    """One obstacle of each kind of shape, on the floor away from the tables, now and then in the way."""
    shapes: list[dict[str, Any]] = [
        {"sphere": 0.12},
        {"cylinder": {"radius": 0.1, "length": 0.9}},
        {"box": [0.2, 0.3, 0.4]},
        {"mesh": "asset:objects/angle.stl", "scale": [3.0, 3.0, 3.0]},
        {"shapes": [{"box": [0.1, 0.1, 0.8]}, {"sphere": 0.15, "pose": {"xyz": [0.0, 0.0, 0.5]}}]},
    ]
    for i, shape in enumerate(draw.sample(shapes, draw.randint(1, 3))):
        at = [round(draw.uniform(-1.2, 1.6), 2), round(draw.uniform(-1.4, 1.2), 2), 0.5]
        pose = {"xyz": at, "rpy": [0.0, 0.0, draw.choice([0.0, 0.7])]}
        scenario["obstacles"].append({"name": f"thing {i}", "pose": pose, **shape})


def _map(scenario: dict[str, Any], draw: Random, folder: Path) -> None:
    """A room of 8 x 8 m with walls all around, a pillar and cells nobody saw."""
    rows = [[254] * 80 for _ in range(80)]
    for i in range(80):
        for row, column in ((0, i), (79, i), (i, 0), (i, 79)):
            rows[row][column] = 0
    row, column = draw.randint(10, 24), draw.randint(10, 70)
    rows[row][column] = rows[row + 1][column] = 0
    rows[75][40] = 205
    (folder / "room.pgm").write_bytes(b"P5\n80 80\n255\n" + bytes(cell for row in rows for cell in row))
    (folder / "room.yaml").write_text(
        "image: room.pgm\nresolution: 0.1\norigin: [-4.0, -4.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    scenario["obstacles"].append(
        {"name": "room", "map": "room.yaml", "height": 1.0, **({"unknown": "free"} if draw.random() < 0.5 else {})}
    )


def _cloud(scenario: dict[str, Any], draw: Random, folder: Path) -> None:
    points = [(0.02 * i, 0.02 * j, 0.02 * k) for i in range(4) for j in range(4) for k in range(20)]
    head = f"VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\nPOINTS {len(points)}\nDATA ascii\n"
    (folder / "heap.pcd").write_text(head + "".join(f"{x:.3f} {y:.3f} {z:.3f}\n" for x, y, z in points))
    at = [round(draw.uniform(-1.0, 1.4), 2), round(draw.uniform(-1.2, 1.0), 2), 0.3]
    scenario["obstacles"].append(
        {"name": "heap", "cloud": "heap.pcd", "cell": draw.choice([0.02, 0.05]), "pose": {"xyz": at}}
    )


def _octree(scenario: dict[str, Any], draw: Random, folder: Path) -> None:
    octree = mg.mapping.OccupancyMap(resolution=0.05)
    camera = mg.mapping.PinholeCamera(width=40, height=30, fx=50.0, fy=50.0, cx=19.5, cy=14.5)
    scene = [mg.LinkShape(mg.Box([0.3, 0.3, 0.2]), mg.pose([0, 0, 0.1]))]
    octree.integrate(
        mg.mapping.render_depth(scene, camera, mg.mapping.look_down([0.0, 0.0, 1.0])), mg.mapping.DepthCamera(camera)
    )
    octree.save(folder / "corner.bt")
    at = [round(draw.uniform(-1.0, 1.4), 2), round(draw.uniform(-1.2, 1.0), 2), 0.2]
    scenario["obstacles"].append({"name": "corner", "octree": "corner.bt", "pose": {"xyz": at}})


def _small_database(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    scenario["reach"] = {"samples": draw.choice([30_000, 100_000, 300_000])}


def _thin_parts(scenario: dict[str, Any], draw: Random, _: Path) -> None:
    """Parts about as thin as the gap that closed fingers leave, and grasps along one direction alone."""
    thin = draw.choice([0.0004, 0.001, 0.0016, 0.003])
    scenario["part_types"] = scenario["part_types"] | {
        "bushing": {"cylinder": {"radius": thin / 2, "length": 0.07}},
        "bracket": {"box": [thin, 0.05, 0.06]},
        "ball": {
            "cylinder": {"radius": 0.01, "length": 0.07},
            "grasp_options": {"approach_direction": [0.0, 0.0, -1.0]},
        },
    }


Feature = Callable[[dict[str, Any], Random, Path], None]
FEATURES: list[tuple[float, Feature]] = [
    (0.4, _uncertainty),
    (0.25, _arrivals),
    (0.3, _padding),
    (0.4, _lengths),
    (0.4, _searches),
    (0.25, _driving),
    (0.3, _base),
    (0.3, _frames),
    (0.15, _second_hand),
    (0.3, _simpler),
    (0.2, _hand),
    (0.3, _drop),
    (0.25, _floor),
    (0.2, _touching),
    (0.5, _bodies),
    (0.25, _map),
    (0.25, _cloud),
    (0.25, _octree),
    (0.12, _measured_hand),
    (0.25, _small_database),
    (0.25, _wheels),
    (0.15, _thin_parts),
]
"""Features, in this order, each in so large a share of the scenarios."""
