"""`mmgrasp grasp`: ranked grasps of the objects that `mmgrasp scan` found, each with its probability."""

from __future__ import annotations

import argparse
import json
import os
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from .. import _core
from .._core import InvalidInput, IoError, Outcome
from .._files import check_new_file, printable, write_result
from ..documents.reading import Node, read_json
from ..scan.objects import FORMAT as OBJECTS_FORMAT
from ..scan.objects import VERSION as OBJECTS_VERSION
from ..scan.objects import pose_to_dict
from ..scan.progress_file import PROGRESS_FILE, read_scan
from ..scan.surroundings import Surroundings
from ..scenario import HandTypes, read_hand_types
from .console import Reporter
from .exit_codes import DONE, NOT_FOUND

FORMAT, VERSION = "mmgrasp-grasps", 1
_LEVEL = 0.17  # the table may be that far from level [rad]
_ROOM = 0.01  # around an object's points, within which its surface is taken from the map [m]
_TRIED = {"drawn": "surface points drawn", "evaluated": "grasps evaluated"}
_DEFAULTS: dict[str, Any] = {name: value for name, (value, _) in _core._synthesis_option_table().items()}
_LESS_CAUTIOUS = (1.0, 0.0)  # standard deviations kept free where the default leaves no grasp, in turn
_SHARES = ("angle", "placement", "centring", "certainty")


def run_grasp(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp grasp`: ranked grasps of the objects in a map; the exit code."""
    if arguments.out is not None:
        check_new_file(arguments.out)
    if arguments.png is not None:
        check_new_file(arguments.png)
        if arguments.out is not None and os.path.realpath(arguments.out) == os.path.realpath(arguments.png):
            raise InvalidInput(f"--png {printable(str(arguments.png))}: is the file of -o, too: give another name")
    types = _read_hand(arguments)
    objects, plane = _read_objects(arguments.map)
    chosen = _chosen(objects, arguments.object, arguments.map)
    sdf = _read_map(arguments.map)
    tried = (_DEFAULTS["sigmas"], *_LESS_CAUTIOUS) if arguments.sigmas is None else (arguments.sigmas,)
    around = Surroundings(sdf, tried[0]) if types.arms else None
    rows = []
    with Reporter(console) as report:
        for k, thing in enumerate(chosen):
            report("grasps", k / len(chosen))
            rows.append(_first_with_grasps(partial(_grasps_of, thing, plane, sdf, types, around, arguments), tried))
        report("grasps", 1.0)
    content = {"format": FORMAT, "version": VERSION, "gripper": arguments.gripper or arguments.robot, "objects": rows}
    content |= {"samples": arguments.samples, "seed": arguments.seed}
    if types.arms:
        content |= {"robot": arguments.robot, "base": arguments.base or [0.0] * 4}
    if arguments.out is not None:
        write_result(arguments.out, _text(content))
    if arguments.png is not None:
        from ..viz.grasp_pictures import write_grasp_picture

        points, _, sigmas = sdf.points()
        panels = [{**row, "bounds": thing["bounds"]} for row, thing in zip(rows, chosen, strict=True)]
        write_grasp_picture(panels, points, sigmas, arguments.png)
    if arguments.json:
        print(json.dumps(content, indent=1, allow_nan=False))
    else:
        _print(rows, {"grasps": arguments.out, "picture": arguments.png}, console)
    return DONE if any(row["grasps"] for row in rows) else NOT_FOUND


def _read_hand(arguments: argparse.Namespace) -> HandTypes:
    """The gripper by its types of grasp and, with --robot, the arm that carries it, where its robot stands."""
    if arguments.robot is None:
        if arguments.gripper is None:
            raise InvalidInput("--gripper: must be given, or --robot with a gripper of its own")
        if arguments.base is not None:
            raise InvalidInput("--base: goes with --robot")
        return read_hand_types(arguments.gripper)
    own = read_hand_types(arguments.robot, arm=True)
    given = own if arguments.gripper is None else read_hand_types(arguments.gripper)
    x, y, z, heading = arguments.base or (0.0, 0.0, 0.0, 0.0)
    T_world_root = _core.pose([x, y, z], rpy=[0, 0, heading])
    arms = {}
    for kind, hand in given.hands.items():
        arm = own.arms.get(kind, next(iter(own.arms.values())))
        if hand.tool_link != arm.tip:
            raise InvalidInput(
                f"--gripper {arguments.gripper}: its tool link {hand.tool_link} is not the tip of --robot's arm, {arm.tip}"
            )
        arms[kind] = arm.at(T_world_root)
    return HandTypes(given.hands, given.robot, arms)


def _read_map(folder: Path) -> _core.ProbabilisticSdf:
    """The map of the frames that the folder lists."""
    listed = folder / PROGRESS_FILE
    return read_scan(listed).sdf if listed.exists() else _core.ProbabilisticSdf.load(str(folder / "map.sdf"))


def _text(content: dict[str, Any]) -> str:
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def _read_objects(folder: Path) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    path = folder / "objects.json"
    if not path.exists():
        raise IoError(
            f"{printable(str(folder))}: holds no objects.json: not a folder that mmgrasp scan wrote to its end"
        )
    root = read_json(path).root
    if "format" not in root or root["format"].raw != OBJECTS_FORMAT:
        raise InvalidInput(f"{path}: is no list of objects of mmgrasp scan: its format is not {OBJECTS_FORMAT}")
    root.read_version(OBJECTS_VERSION)
    root.mapping("format version plane objects", "up")
    objects = [_read_object(node) for node in root["objects"].elements()]
    if not objects or root["plane"].raw is None:
        raise InvalidInput(f"{path}: lists no objects: there is nothing to grasp")
    plane = root["plane"].mapping("normal offset", "points")
    normal = plane["normal"].numbers(3)
    if abs(np.linalg.norm(normal) - 1) > 1e-6:
        plane["normal"].fail("must have length 1")
    tilt = float(np.arccos(np.clip(normal[2], -1, 1)))
    if tilt > _LEVEL:
        plane["normal"].fail(
            f"the supporting plane is tilted by {np.degrees(tilt):.0f} degrees against the world's z, at most "
            f"{np.degrees(_LEVEL):.0f} will do: give the frames' poses in a world whose z is up"
        )
    return objects, {"normal": normal, "offset": plane["offset"].number()}


def _read_object(node: Node) -> dict[str, Any]:
    bounds = node.mapping("name bounds", "pose size fill points sigma")["bounds"].mapping("lower upper")
    corners = np.array([bounds[key].numbers(3) for key in ("lower", "upper")])
    if not (corners[0] < corners[1]).all():
        bounds.fail("lower must be below upper")
    return {"name": node["name"].label(), "bounds": corners}


def _chosen(objects: list[dict[str, Any]], name: str | None, folder: Path) -> list[dict[str, Any]]:
    if name is None:
        return objects
    found = [thing for thing in objects if thing["name"] == name]
    if not found:
        names = ", ".join(thing["name"] for thing in objects[:8])
        raise InvalidInput(f"--object {name}: is no object of {printable(str(folder))}; it has {names}")
    return found


def _first_with_grasps(row_of: Callable[[float], dict[str, Any]], tried: Sequence[float]) -> dict[str, Any]:
    """The row of the first of the `tried` standard deviations kept free that leaves a grasp; where none does, of the first one."""
    rows: list[dict[str, Any]] = []
    for sigmas in tried:
        row = row_of(sigmas)
        if row["grasps"]:
            if rows:
                row["summary"] += (
                    f"; kept free: {sigmas:g} standard deviations of the map; with {rows[-1]['sigmas']:g} there is none"
                )
            return row
        rows.append(row)
    return rows[0]


def _grasps_of(
    thing: dict[str, Any],
    plane: dict[str, Any],
    sdf: _core.ProbabilisticSdf,
    types: HandTypes,
    around: Surroundings | None,
    arguments: argparse.Namespace,
    sigmas: float,
) -> dict[str, Any]:
    """An object's row: the most probable grasps of all types of the hand, and what became of the others."""
    box = thing["bounds"].copy()
    middle, normal = box.mean(axis=0), np.array(plane["normal"])
    table = float((plane["offset"] - normal[:2] @ middle[:2]) / normal[2])
    world = None if around is None else around.around(box, table)
    box += [[-_ROOM], [_ROOM]]
    grasps: list[dict[str, Any]] = []
    counts: Counter[str] = Counter()
    said: dict[str, str] = {}
    for kind, hand in types.hands.items():
        arm = types.arms.get(kind)
        found = _core.synthesize_grasps(
            sdf,
            hand,
            robot=types.robot,
            table=table,
            object=box,
            arm=arm,
            world=world,
            samples=arguments.samples,
            sigmas=sigmas,
            seed=arguments.seed,
            max_grasps=arguments.grasps,
        )
        if found.outcome == Outcome.stopped:
            raise KeyboardInterrupt
        counts.update(found.counts)
        said[kind] = found.summary()
        for grasp, rating in zip(found.grasps, found.ratings, strict=True):
            grasps.append(({"type": kind} if kind else {}) | _grasp(grasp, rating, hand, arm))
    grasps.sort(key=lambda grasp: -float(grasp["probability"]))
    kept = grasps[: arguments.grasps]
    counts["near_better"] += len(grasps) - len(kept)
    summary = "; ".join(f"{kind}: {text}" if kind else text for kind, text in said.items())
    if len(grasps) > len(kept):
        summary += f"; kept are the best {len(kept)}"
    if not grasps and counts["collision"] and sigmas > 0:
        summary += (
            f"; {counts['collision']} touch the map, with {sigmas:g} standard deviations of it kept free (--sigmas)"
        )
    return {"name": thing["name"], "sigmas": sigmas, "summary": summary, "counts": dict(counts), "grasps": kept}


def _grasp(
    grasp: _core.Grasp, rating: _core.GraspRating, hand: _core.Hand, arm: _core.JointGroup | None
) -> dict[str, Any]:
    success = rating.success.to_dict()
    reached = {} if arm is None else {"q": dict(zip(arm.names, np.asarray(rating.q).tolist(), strict=True))}
    jointed = {}
    if rating.pretouch_posture:
        jointed["pretouch_joints"] = hand.posture_values(rating.pretouch_posture)
        jointed["joints"] = hand.joint_values(grasp)
    return {
        **reached,
        **jointed,
        "T_world_hand": pose_to_dict(grasp.T_object_hand),
        "opening": grasp.opening,
        "pretouch_opening": rating.pretouch_opening,
        "probability": success["probability"],
        "criteria": {name: success[name] for name in _SHARES},
        "approach": (grasp.T_object_hand[:3, :3] @ np.array(hand.approach)).tolist(),
        "patches": [
            {"point": list(patch.point), "normal": list(patch.normal), "sigma": patch.sigma} for patch in rating.patches
        ],
    }


def _lost(row: dict[str, Any]) -> str:
    """What became of all that were tried beside the grasps that were found; the summary says it where there are none."""
    named = {"near_better": "near a better one or not among the best"}
    causes = [
        (named.get(name, name.replace("_", " ")), n) for name, n in row["counts"].items() if n and name not in _TRIED
    ]
    if not row["grasps"] or not causes:
        return ""
    causes.sort(key=lambda cause: -cause[1])
    tried = ", ".join(f"{row['counts'][name]} {what}" for name, what in _TRIED.items())
    return f"; of {tried} the others fell at: " + ", ".join(f"{name} {n}" for name, n in causes)


def _shown(name: str) -> str:
    """A name in a table, whose brackets are no markup."""
    return escape(printable(name))


def _print(rows: list[dict[str, Any]], written: dict[str, Path | None], console: Console) -> None:
    typed = any("type" in grasp for row in rows for grasp in row["grasps"])
    table = Table(title="the best grasp of each object; its probability weighs the criteria")
    texts = ("object", "type") if typed else ("object",)
    for column in (*texts, "grasps", "prob.", "angle", "place", "centre", "sure", "mm"):
        table.add_column(column, justify="left" if column in texts else "right", no_wrap=True)
    for row in rows:
        best = row["grasps"][0] if row["grasps"] else {}
        cells = [_shown(row["name"])] + [_shown(best.get("type", "-"))] * typed + [str(len(row["grasps"]))]
        if best:
            cells.append(f"{best['probability']:.2f}")
            cells += [f"{best['criteria'][share]:.2f}" for share in _SHARES] + [f"{1e3 * best['opening']:.0f}"]
        else:
            cells += ["-"] * (2 + len(_SHARES))
        table.add_row(*cells)
    console.print(table)
    for row in rows:
        console.print(printable(f"{row['name']}: {row['summary']}{_lost(row)}"), markup=False, soft_wrap=True)
    for what, path in written.items():
        if path is not None:
            console.print(f"{what}: {printable(str(path))}", markup=False, soft_wrap=True)
