"""P3 3.9.2 and 3.9.3: capability maps in free space, before a table at two distances, and before a shelf.

The grid is the thesis': 2 x 2 x 2.6 m around the robot, voxels of 10 cm, 200 tool poses each. Robot, table, shelf and
camera are not described there by numbers; ours are stated in each result's set-up.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from .._core import Box, CapabilityMap, PinholeCamera, Robot, World, pose
from .._files import shipped
from ..viz.capability import draw_cut, figure_of, map_figure, map_values
from .entry import Context, Entry, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LIFT = 0.2  # where the torso stands while the arm alone moves, and for the camera [m]
TILT = 0.3  # of the head, down [rad]
CAMERA = PinholeCamera(640, 480, 525.0, 525.0, 319.5, 239.5, 0.1, 5.0)
TABLE_TOP = {"height": 0.75, "thickness": 0.04, "depth": 0.8, "width": 1.6}  # [m]
NEAR, FAR = 0.40, 1.25  # from the robot's middle to the table's edge [m]
OBJECT_BEHIND_EDGE = 0.15  # [m]
UP_TO_THE_FAR_OBJECT = (1.6, 1.0, 2.6)  # the grid's upper corner, so that its end takes nothing away there [m]


class ShelfSizes(TypedDict):
    """Sizes of the shelf and where it stands [m]."""

    boards: list[float]  # heights
    depth: float
    width: float
    thickness: float
    front: float  # from the robot's middle


SHELF: ShelfSizes = {"boards": [0.40, 0.75, 1.10, 1.45], "depth": 0.40, "width": 0.90, "thickness": 0.02, "front": 0.60}


def _robot() -> Robot:
    return Robot.load(
        shipped("asset:robots/fetchlike/fetchlike.urdf"), shipped("asset:robots/fetchlike/fetchlike.srdf")
    )


JOINTS = {"torso_lift_joint": LIFT, "head_tilt_joint": TILT}


def _options(context: Context) -> dict[str, Any]:
    options: dict[str, Any] = {"approach": (1.0, 0.0, 0.0), "seed": context.seed}
    return {**options, "voxel": 0.2, "poses": 50} if context.quick else options


def _world(boxes: list[dict[str, Any]]) -> World:
    world = World()
    for box in boxes:
        world.add(box["name"], Box(box["size"]), pose(box["centre"]))
    return world


def _build(
    context: Context, robot: Robot, group: str, boxes: list[dict[str, Any]], **more: Any
) -> tuple[CapabilityMap, float]:
    begun = time.perf_counter()
    arm = robot.group(group).with_reference(JOINTS)
    made = CapabilityMap.build(arm, _world(boxes), progress=context.progress, **_options(context), **more)
    return made, time.perf_counter() - begun


def _setup(made: CapabilityMap, **more: Any) -> dict[str, Any]:
    return {
        "robot": "the shipped Fetch-like robot",
        "lift of the arm alone [m]": LIFT,
        "voxel [m]": made.voxel,
        "voxels": [int(n) for n in made.shape],
        "poses a voxel": len(made.tool_poses),
        **more,
    }


def _free(context: Context) -> Result:
    result, robot = Result(), _robot()
    best = {}
    for name, group in (("arm", "arm"), ("arm and lift", "arm_with_torso")):
        made, seconds = _build(context, robot, group, [])
        best[name] = made
        row = result.row({"joints": name})
        row["maximal index [%]"] = (85, 100 * made.maximum)
        row["poses"] = (2080000, made.classes.size)
        row["poses reached"] = (None, made.reached)
        row["time [s]"] = (1800, seconds)
        row["us a pose"] = (1e6 * 1800 / 2080000, 1e6 * seconds / made.classes.size)
        for cause in ("unreachable", "limits", "self_collision"):
            row[f"refused: {cause.replace('_', '-')}"] = (None, getattr(made.rejections, cause))
        if not context.quick:
            result.trend(f"{name}: at least 30 times faster than the paper's 30 minutes", seconds < 60, clock=True)
    if not context.quick:
        sizes = {m.classes.size for m in best.values()} | {np.prod(m.shape) * 200 for m in best.values()}
        result.exact("2,080,000 tool poses in 20 x 20 x 26 voxels", sizes == {2_080_000})
    result.trend(
        "more joints reach more: the arm with its lift a larger maximum than alone",
        best["arm and lift"].maximum >= best["arm"].maximum,
    )
    if not context.quick:
        result.near_paper("maximal index [%]", 0.1)
    result.setup = _setup(best["arm"])
    result.notes.append(
        "P3's arm and its mounting are not the shipped robot's, so the maxima differ; P3 says nothing of rolls about the"
        " approach, ours go round evenly from pose to pose."
    )
    result.drawing = map_values(best["arm and lift"], robot, JOINTS, [])
    return result


def _draw_free(stored: dict[str, Any]) -> Figure:
    return map_figure(stored["drawing"], 0.75, "Capability map in free space (P3 figures 3.31 and 3.32)")


def _table(edge: float) -> list[dict[str, Any]]:
    depth, thickness = TABLE_TOP["depth"], TABLE_TOP["thickness"]
    centre = [edge + depth / 2, 0.0, TABLE_TOP["height"] - thickness / 2]
    return [{"name": "table", "centre": centre, "size": [depth, TABLE_TOP["width"], thickness]}]


def _camera_pose(robot: Robot) -> np.ndarray:
    return robot.link_poses(JOINTS)["head_camera_optical_frame"]


def _seen(T_root_camera: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which points (n, 3) of the root frame the camera's field of view holds; nothing hides anything."""
    local = (points - T_root_camera[:3, 3]) @ T_root_camera[:3, :3]
    return np.array([CAMERA.project(p) is not None for p in local])


def _two_distances(context: Context) -> Result:
    result, robot = Result(), _robot()
    T = _camera_pose(robot)
    maps, figures = {}, []
    for name, edge in (("near (a)", NEAR), ("far (b)", FAR)):
        boxes = _table(edge)
        made, seconds = _build(context, robot, "arm_with_torso", boxes, upper=UP_TO_THE_FAR_OBJECT)
        maps[name] = made
        centres, index = made.centres.reshape(-1, 3), made.index.ravel()
        above = (
            (centres[:, 0] > edge)
            & (centres[:, 0] < edge + TABLE_TOP["depth"])
            & (np.abs(centres[:, 1]) < TABLE_TOP["width"] / 2)
            & (centres[:, 2] > TABLE_TOP["height"])
            & (centres[:, 2] < TABLE_TOP["height"] + 0.3)
        )
        target = np.array([edge + OBJECT_BEHIND_EDGE, 0.0, TABLE_TOP["height"] + 0.06])
        row = result.row({"robot": name, "table edge [m]": edge})
        row["object in view"] = ("no" if name == "near (a)" else "yes", "yes" if _seen(T, target[None])[0] else "no")
        row["index at the object [%]"] = (None if name == "near (a)" else 0, 100 * made.index_at(target))
        row["mean index above the table [%]"] = (None, 100 * index[above].mean() if above.any() else 0.0)
        row["reached voxels above the table"] = (None, int((index[above] > 0).sum()))
        row["in view of the space above the table [%]"] = (None, 100 * _part_in_view(T, edge))
        row["time [s]"] = (None, seconds)
        figures.append({**map_values(made, robot, JOINTS, boxes), "name": name, "object": target.tolist()})
    values = [values for _, values in result.rows]
    result.trend(
        "nearer to the table, more of what is above it is reached",
        values[0]["reached voxels above the table"][1] > values[1]["reached voxels above the table"][1],
    )
    result.trend("near: the object lies outside the field of view", values[0]["object in view"][1] == "no")
    result.trend(
        "near: the object is within reach, by other poses of the arm", values[0]["index at the object [%]"][1] > 0
    )
    result.trend("far: the object lies in the field of view", values[1]["object in view"][1] == "yes")
    result.trend("far: the object is out of reach", values[1]["index at the object [%]"][1] == 0)
    result.trend(
        "farther away, more of the space above the table is in view",
        values[1]["in view of the space above the table [%]"][1]
        > values[0]["in view of the space above the table [%]"][1],
    )
    result.setup = _setup(
        maps["near (a)"],
        **{"joints": "arm and lift", "head tilt [rad]": TILT, "camera": repr(CAMERA), "table [m]": str(TABLE_TOP)},
    )
    result.drawing = {"maps": figures, "camera": T[:3, 3].tolist(), "rays": _rays(T)}
    return result


def _part_in_view(T: np.ndarray, edge: float) -> float:
    """Share of the 0.3 m above the table that the camera sees, wherever the map's grid ends."""
    xs = edge + TABLE_TOP["depth"] * (np.arange(16) + 0.5) / 16
    ys = TABLE_TOP["width"] * ((np.arange(32) + 0.5) / 32 - 0.5)
    zs = TABLE_TOP["height"] + 0.3 * (np.arange(6) + 0.5) / 6
    return float(_seen(T, np.stack(np.meshgrid(xs, ys, zs), axis=-1).reshape(-1, 3)).mean())


def _rays(T: np.ndarray) -> list[list[float]]:
    """Directions in the root frame of the upper and lower border of the picture's middle column."""
    rows = np.array([-0.5, CAMERA.height - 0.5])
    return [(T[:3, :3] @ [0, (v - CAMERA.cy) / CAMERA.fy, 1]).tolist() for v in rows]


def _draw_two_distances(stored: dict[str, Any]) -> Figure:
    drawing = stored["drawing"]
    largest = max(v[3] for values in drawing["maps"] for v in values["voxels"])
    figure, axes = figure_of(12.5, 6.4, 2)
    eye = np.array(drawing["camera"])
    for axis, values in zip(axes, drawing["maps"], strict=True):
        image = draw_cut(axis, values, "y", 0.0, largest)
        ends = [eye + 3.0 * np.array(ray) for ray in drawing["rays"]]
        axis.fill(
            [eye[0], ends[0][0], ends[1][0]], [eye[2], ends[0][2], ends[1][2]], color="#F0C419", alpha=0.22, zorder=0,
            label="field of view",
        )  # fmt: skip
        for end in ends:
            axis.plot([eye[0], end[0]], [eye[2], end[2]], color="#B8860B", linewidth=1.0, zorder=4)
        x, _, z = values["object"]
        axis.plot([x], [z], "s", color="#C1121F", markersize=8, zorder=5, label="object")
        axis.set_xlim(-1, 2.1)
        axis.set_title(f"{values['name']}: table's edge at {values['boxes'][0]['centre'][0] - 0.4:.2f} m")
        axis.legend(loc="upper left", frameon=False)
    figure.colorbar(image, ax=list(axes), label="reachability index at y = 0 [%]", shrink=0.8)
    figure.suptitle("A table at two distances (P3 figure 3.33)")
    return figure


def _shelf_boxes() -> list[dict[str, Any]]:
    front, depth, width, thick = SHELF["front"], SHELF["depth"], SHELF["width"], SHELF["thickness"]
    top = SHELF["boards"][-1]
    middle = front + depth / 2
    boxes = [
        {"name": f"board {i + 1}", "centre": [middle, 0.0, z], "size": [depth, width, thick]}
        for i, z in enumerate(SHELF["boards"])
    ]
    for name, side in (("right side", -1), ("left side", 1)):
        boxes.append({"name": name, "centre": [middle, side * width / 2, top / 2], "size": [depth, thick, top + thick]})
    back = [front + depth + thick / 2, 0.0, top / 2]
    return [*boxes, {"name": "back", "centre": back, "size": [thick, width + thick, top + thick]}]


def _shelf(context: Context) -> Result:
    result, robot = Result(), _robot()
    boxes = _shelf_boxes()
    inside_of = {}
    maps = {}
    for name, scene in (("free space", []), ("before the shelf", boxes)):
        made, seconds = _build(context, robot, "arm_with_torso", scene)
        centres, index = made.centres.reshape(-1, 3), made.index.ravel()
        inside = (
            (centres[:, 0] > SHELF["front"])
            & (centres[:, 0] < SHELF["front"] + SHELF["depth"])
            & (np.abs(centres[:, 1]) < SHELF["width"] / 2)
            & (centres[:, 2] > SHELF["boards"][0])
            & (centres[:, 2] < SHELF["boards"][-1])
        )
        maps[name], inside_of[name] = made, index[inside]
        row = result.row({"scene": name})
        row["maximal index inside [%]"] = (None if name == "free space" else 20, 100 * index[inside].max(initial=0))
        row["mean index inside [%]"] = (None, 100 * index[inside].mean())
        row["voxels inside reached at all"] = (None, int((index[inside] > 0).sum()))
        row["voxels inside"] = (None, int(inside.sum()))
        row["refused: scene"] = (None, made.rejections.scene)
        row["time [s]"] = (None, seconds)
    result.trend(
        "the shelf takes most of the index away",
        inside_of["before the shelf"].mean() < 0.5 * inside_of["free space"].mean(),
    )
    result.trend(
        "the shelf adds nothing anywhere",
        bool((maps["before the shelf"].index <= maps["free space"].index + 1e-6).all()),
    )
    if not context.quick:
        result.near_paper("maximal index inside [%]", 0.25)
    result.setup = _setup(maps["free space"], **{"joints": "arm and lift", "shelf [m]": str(SHELF)})
    result.notes.append("P3 prints neither the shelf's measures nor where the robot stands before it.")
    result.drawing = map_values(maps["before the shelf"], robot, JOINTS, boxes)
    return result


def _draw_shelf(stored: dict[str, Any]) -> Figure:
    return map_figure(stored["drawing"], 0.95, "Capability map before a shelf (P3 figure 3.34)")


ENTRIES = (
    Entry("p3-figure-3.31", "Capability map of the arm (P3 figures 3.31 and 3.32)", _free, _draw_free),
    Entry("p3-figure-3.33", "Capability maps at two distances from a table", _two_distances, _draw_two_distances),
    Entry("p3-figure-3.34", "Capability map before a shelf", _shelf, _draw_shelf),
)
