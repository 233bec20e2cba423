"""The calls of same_answers.py. Each returns what is compared, by part, and a few figures for people.

Names of the package are looked up by find(), names of fields by get(), both with all names a thing had or may get; keywords
that have two names stand in KEYWORDS. After a rename add the new name there, and old and new builds run the same script.
"""

from __future__ import annotations

import importlib
import itertools
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

THREADS = 0
PATIENT = 3600.0  # a time limit that never decides [s]
PLACES = (
    "",
    ".robot",
    ".collision",
    ".planning",
    ".grasping",
    ".base",
    ".mapping",
    ".optim",
    ".problems",
    ".pipe_cells",
)
PLACES += (".problems.pipe_cells", "._core")
KEYWORDS: dict[str, tuple[str, ...]] = {
    "shorten": ("shortcut", "smooth"),
    "T_world_to": ("T_world_goal",),
    "near": ("seed",),
    "neighbours": ("neighbors",),
    "stands": ("goal_configurations",),
    "min_radius": ("least_radius",),
}
SHARED = Path(__file__).resolve().parents[2] / "shared/data"

Answer = tuple[dict[str, Any], dict[str, Any]]
CALLS: dict[str, Callable[[], Answer]] = {}


class Skipped(Exception):  # noqa: N818 - it is no error
    """What a call needs is not there."""


def call(function: Callable[[], Answer]) -> Callable[[], Answer]:
    """Puts a function on the list."""
    CALLS[function.__name__] = function
    return function


def find(*names: str) -> Any:
    """The first of these names that the package has: in its root, in its facades, in the binary module."""
    for name, place in itertools.product(names, PLACES):
        try:
            module = importlib.import_module(f"mmgrasp{place}")
        except ModuleNotFoundError:
            continue
        if hasattr(module, name):
            return getattr(module, name)
    raise AttributeError(f"mmgrasp has none of {', '.join(names)}")


def get(thing: Any, *names: str) -> Any:
    """The first of these attributes, or keys of a dict."""
    for name in names:
        if isinstance(thing, dict) and name in thing:
            return thing[name]
        if not isinstance(thing, dict) and hasattr(thing, name):
            return getattr(thing, name)
    raise AttributeError(f"{type(thing).__name__} has none of {', '.join(names)}")


def ask(function: Callable[..., Any], *values: Any, **keywords: Any) -> Any:
    """Calls it, where keywords are refused with their other names."""
    first = None
    for chosen in itertools.product(*((key, *KEYWORDS.get(key, ())) for key in keywords)):
        try:
            return function(*values, **dict(zip(chosen, keywords.values(), strict=True)))
        except (TypeError, ValueError) as refused:
            first = first or refused
    raise first


# What results have in common.


def rejections(of: Any) -> list[int]:
    return [
        get(of, "grasp_filter"),
        get(of, "unreachable", "reach"),
        get(of, "limits"),
        get(of, "self_collision"),
        get(of, "scene"),
    ]


def timed(trajectory: Any) -> list[np.ndarray]:
    return [get(trajectory, name) for name in ("times", "positions", "velocities", "accelerations")]


def motion(found: Any) -> Answer:
    parts = {"outcome": found.outcome, "path": found.path, "cost": found.cost, "goal": found.goal_index}
    parts["rejections"] = rejections(found.rejections)
    shown = {
        "outcome": found.outcome.name,
        "cost": found.cost,
        "waypoints": 0 if found.path is None else len(found.path),
    }
    return parts, shown | {"queries": get(found.stats, "collision_queries")}


def line(found: Any) -> Answer:
    parts = {"outcome": found.outcome, "path": found.path, "fraction": found.fraction, "cause": found.cause}
    shown = {"outcome": found.outcome.name, "waypoints": 0 if found.path is None else len(found.path)}
    return parts, shown | {"fraction": found.fraction}


def manipulation(found: Any) -> Answer:
    ends = ("start_solutions", "goal_solutions", "searched")
    parts = {
        "outcome": found.outcome,
        "path": found.path,
        "cost": [found.cost, found.lower_bound],
        "grasp": found.grasp_index,
        "rejections": rejections(found.rejections),
        "grasps": [[get(g, end) for end in ends] + rejections(g.start) + rejections(g.goal) for g in found.grasps],
        "improvements": [[better.cost, better.grasp, better.path] for better in found.improvements],
    }
    shown = {"outcome": found.outcome.name, "cost": found.cost, "grasp": found.grasp_index}
    return parts, shown | {"waypoints": 0 if found.path is None else len(found.path), "of grasps": len(found.grasps)}


def stop(of: Any) -> list[Any]:
    return [of.pose, of.radius, list(of.trays)]


def stops(found: Any) -> Answer:
    parts = {"outcome": found.outcome, "stops": [stop(s) for s in found.stops], "bound": found.lower_bound}
    return parts, {"outcome": found.outcome.name, "stops": len(found.stops), "bound": found.lower_bound}


def shared_cells(found: Any) -> list[Any]:
    return [
        [s.trays, s.heading, s.centre, s.radius, s.cells]
        for s in itertools.chain(get(found, "robust"), get(found, "lost", "not_robust"))
    ]


# Robots, worlds, configurations.


def asset(name: str) -> Path:
    return Path(importlib.import_module("mmgrasp").__file__).parent / "assets" / name


@cache
def robot(name: str, base: str = "fixed") -> Any:
    folder = asset("robots") / name
    return find("Robot").load(folder / f"{name}.urdf", folder / f"{name}.srdf", base=base)


@cache
def group(name: str, base: str = "fixed", with_base: bool = False) -> Any:
    fetch = name == "fetchlike"
    return robot(name, base).group(
        "arm_with_torso" if fetch else "arm", tip="gripper_tcp" if fetch else None, with_base=with_base
    )


ROBOTS = [("fetchlike", "diff_drive"), ("omni6", "omni"), ("tm14like", "fixed"), ("kr6like", "fixed")]


def pose(*xyz: float, rpy: Any = None) -> np.ndarray:
    return find("pose")(xyz, rpy=rpy)


def world(seed: int = 1) -> Any:
    """Boxes, cylinders and balls around a robot in the middle."""
    rng = np.random.default_rng(seed)
    scene = find("World")()
    for i in range(12):
        angle, away, height = rng.uniform([-np.pi, 0.6, 0.2], [np.pi, 1.0, 1.4])
        at = pose(away * np.cos(angle), away * np.sin(angle), height, rpy=rng.uniform(-1, 1, 3))
        if i % 3 == 0:
            scene.add_cylinder(f"obstacle {i}", 0.05, 0.4, at)
        elif i % 3 == 1:
            scene.add_sphere(f"obstacle {i}", 0.08, at)
        else:
            scene.add_box(f"obstacle {i}", [0.1, 0.2, 0.3], at)
    return scene


def drawn(arm: Any, count: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).uniform(arm.sample_lower, arm.sample_upper, (count, len(arm.names)))


def free_ends(arm: Any, scene: Any, seed: int) -> np.ndarray:
    """Two free configurations that no straight line joins."""
    checker = find("CollisionChecker")(arm.robot, scene, arm)
    first, *others = (q for q in drawn(arm, 1000, seed) if checker.is_free(q))
    return np.array([first, next(q for q in others if not checker.edge_is_free(first, q))])


def tucked(name: str, base: str) -> list[float]:
    """The arm's state of that name."""
    arm = group(name, base)
    state = arm.robot.group_states["arm_with_torso" if name == "fetchlike" else "arm"]["tucked"]
    return [state[joint] for joint in arm.names]


def hand() -> Any:
    return find("Gripper", "Hand")(
        "gripper_tcp", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.04, finger_width=0.022
    )


def shape(of: str, *measures: Any) -> Any:
    return find("LinkShape")(find(of)(*measures))


def body(*size: float) -> list[Any]:
    return [shape("Box", size)]


@cache
def reach_database() -> Any:
    return find("ReachDatabase").build(group("fetchlike", "diff_drive"), samples=100_000, seed=1, threads=THREADS)


# Robots and collisions.


@call
def forward_kinematics() -> Answer:
    parts = {}
    for name, base in ROBOTS:
        arm = group(name, base, with_base=base != "fixed")
        Q = drawn(arm, 300)
        parts[name] = [arm.fk_batch(Q), arm.jacobian_batch(Q), arm.manipulability_batch(Q)]
        parts[f"{name}, one by one"] = [[arm.fk(q), arm.jacobian(q), *arm.link_poses(q).values()] for q in Q[:20]]
    return parts, {"robots": len(ROBOTS), "rank of the last": float(parts[name][2][-1])}


@call
def inverse_kinematics() -> Answer:
    parts, solved, iterations = {}, 0, 0
    for name, base in ROBOTS:
        arm, answers = group(name, base), []
        for q, scene in zip(drawn(arm, 40, 2), itertools.cycle([None, world()]), strict=False):
            found = arm.ik(arm.fk(q), world=scene, rng_seed=3, time_limit=PATIENT)
            errors = [found.position_error, found.rotation_error]
            answers.append([found.outcome, found.q, errors, found.iterations, rejections(found.rejections)])
            solved, iterations = solved + (found.q is not None), iterations + found.iterations
        parts[name] = answers
    return parts, {"solved": solved, "iterations": iterations}


@call
def inverse_kinematics_all() -> Answer:
    parts, count = {}, 0
    for name, base in ROBOTS:
        arm, answers = group(name, base), []
        for q in drawn(arm, 8, 4):
            every = arm.ik_all(arm.fk(q), count=8, rng_seed=1, time_limit=PATIENT)
            branches = arm.ik_branches(arm.fk(q), world=world(), rng_seed=1, time_limit=PATIENT)
            answers.append([every, branches.solutions, branches.complete, rejections(branches.rejections)])
            count += len(every) + len(branches.solutions)
        parts[name] = answers
    return parts, {"solutions": count}


@call
def inverse_kinematics_objectives() -> Answer:
    arm = group("fetchlike", "diff_drive", with_base=True)
    wanted, answers = pose(3, 2, 0.9, rpy=[0, 0, 1.5]), []
    for objective in (find("joint_limit_objective")(arm, soft_fraction=0.3), find("singularity_objective")(arm, 0.1)):
        found = arm.ik(wanted, rng_seed=1, objectives=[objective], time_limit=PATIENT)
        answers.append([found.outcome, found.q, found.objective, *objective.evaluate(found.q)])
    return {"answers": answers}, {"objective": found.objective}


@call
def collisions() -> Answer:
    parts, free = {}, 0
    for name, base in ROBOTS:
        arm = group(name, base)
        checker, Q = find("CollisionChecker")(arm.robot, world(), arm), drawn(arm, 1500)
        parts[f"{name}, free"] = checker.are_free(Q, threads=THREADS)
        parts[f"{name}, one by one"] = [
            [checker.is_free(q), checker.rejection(q), len(checker.contacts(q))] for q in Q[:150]
        ]
        free += int(parts[f"{name}, free"].sum())
    return parts, {"free": free}


@call
def distances() -> Answer:
    parts, total = {}, 0.0
    for name, base in ROBOTS:
        arm = group(name, base)
        checker, answers = find("CollisionChecker")(arm.robot, world(), arm), []
        for q in drawn(arm, 100):
            one = checker.distance(q, gradient=True)
            near = [[d.value, d.point_a, d.point_b] for d in checker.distances(q, within=0.1)]
            answers.append([one.value, one.gradient, one.point_a, one.point_b, near])
            total += one.value
        parts[name] = answers
    return parts, {"sum": total}


@call
def edges() -> Answer:
    parts, free = {}, 0
    for name, base in ROBOTS:
        arm = group(name, base)
        checker, Q, answers = find("CollisionChecker")(arm.robot, world(), arm), drawn(arm, 200), []
        for a, b in itertools.pairwise(Q):
            b = a + (b - a) * min(1, 0.5 / abs(b - a).max())
            steps, smooth = checker.check_edge(a, b), checker.check_edge(a, b, continuous=True)
            answers.append(
                [checker.edge_is_free(a, b), steps.free, steps.fraction, steps.checks, smooth.free, smooth.fraction]
            )
            free += steps.free
        parts[name] = answers
    return parts, {"free": free}


@call
def attached_and_padded() -> Answer:
    arm, scene = group("fetchlike", "diff_drive"), world()
    scene.add_box("part", [0.05, 0.05, 0.25], pose(2, 2, 2))
    scene.attach("part", link="gripper_link", pose=pose(0.15, 0, 0))
    Q, answers = drawn(arm, 300), []
    for options in ({}, {"padding": 0.03}, {"held_only": True}, {"check_self": False}):
        answers.append(find("CollisionChecker")(arm.robot, scene, arm, **options).are_free(Q, threads=THREADS))
    return {"free": answers}, {"free": [int(a.sum()) for a in answers]}


@call
def disabled_pairs() -> Answer:
    parts = {}
    for name, base in ROBOTS[:2]:
        bare = find("Robot").load(asset("robots") / name / f"{name}.urdf", base=base)
        found = find("compute_disabled_pairs")(bare, samples=2000, seed=1, threads=THREADS)
        index = {link: i for i, link in enumerate(found.links)}
        reasons = sorted({reason for _, _, reason in found.disabled_pairs})
        parts[name] = [[index[a], index[b], reasons.index(reason)] for a, b, reason in found.disabled_pairs]
    return parts, {name: len(pairs) for name, pairs in parts.items()}


# Motions.


def planned(planner: str, name: str, base: str, iterations: int = 20000, seed: int = 1) -> Answer:
    """A base is moved among three walls, an arm alone among obstacles."""
    if base == "fixed":
        arm, scene = group(name), world()
        start, goal = free_ends(arm, scene, 5)
    else:
        arm, scene = group(name, base, with_base=True), find("World")()
        for i in range(3):
            scene.add_box(f"wall {i}", [0.1, 2.0, 1.6], pose(1.5 + 1.5 * i, 0.6 * (-1) ** i, 0.8))
        home = tucked(name, base)
        start, goal = [0, 0, 0, *home], [6.0, 0.3, 1.0, *home]
    options = {"planner": planner, "seed": seed, "max_iterations": iterations, "time_limit": PATIENT}
    return motion(find("plan_motion")(arm.robot, arm, scene, start=start, goal=goal, **options))


# Name of the call: planner, robot, base, budget in iterations.
MOTIONS: dict[str, tuple[Any, ...]] = {
    "rrt_connect_fetch": ("rrt_connect", "fetchlike", "fixed"),
    "rrt_connect_tm14": ("rrt_connect", "tm14like", "fixed"),
    "rrt_connect_diff_drive": ("rrt_connect", "fetchlike", "diff_drive"),
    "rrt_connect_omni": ("rrt_connect", "omni6", "omni"),
    "ompl_rrt_connect_kr6": ("ompl_rrt_connect", "kr6like", "fixed"),
    "ompl_rrt_connect_diff_drive": ("ompl_rrt_connect", "fetchlike", "diff_drive"),
    "ompl_rrt_connect_omni": ("ompl_rrt_connect", "omni6", "omni"),
    **{
        f"{planner}_kr6": (planner, "kr6like", "fixed", 1500)
        for planner in ("rrt", "est", "bi_est", "kpiece", "bkpiece", "prm", "prm_star", "lazy_prm_star")
    },
    **{
        f"{planner}_tm14": (planner, "tm14like", "fixed", 1500)
        for planner in ("rrt_star", "informed_rrt_star", "bit_star", "abit_star", "ait_star")
    },
}
for key, given in MOTIONS.items():
    CALLS[key] = lambda given=given: planned(*given)


@call
def goals_by_pose() -> Answer:
    """Goals as tool poses and regions, a cone held on the way."""
    arm, scene = group("tm14like"), find("World")()
    scene.add_box("wall", [0.5, 0.1, 0.6], pose(0.6, 0, 0.3))
    start = arm.ik(pose(0.5, 0.4, 0.4, rpy=[0, np.pi / 2, 0]), world=scene, rng_seed=1, time_limit=PATIENT).q
    wanted = pose(0.5, -0.4, 0.4, rpy=[0, np.pi / 2, 0])
    region = find("ToolRegion")(wanted, position=[0.1, 0.1, 0], rotation=[0, 0, 0.3])
    cone = find("ToolCone", "OrientationConstraint")([1, 0, 0], [0, 0, -1], 0.6)
    options = {"planner": "rrt_connect", "seed": 1, "time_limit": PATIENT, "start": start}
    by_pose = find("plan_motion")(arm.robot, arm, scene, tool_poses=wanted, **options)
    by_region = find("plan_motion")(arm.robot, arm, scene, regions=[region], **options)
    upright = ask(find("plan_motion"), arm.robot, arm, scene, tool_poses=wanted, tool_cone=cone, **options)
    answers = [motion(found) for found in (by_pose, by_region, upright)]
    parts = {
        f"{what}, {key}": part
        for what, answer in zip(("pose", "region", "cone"), answers, strict=True)
        for key, part in answer[0].items()
    }
    return parts, {"costs": [round(found.cost, 9) for found in (by_pose, by_region, upright)]}


@call
def straight_line() -> Answer:
    arm = group("tm14like")
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    q = arm.ik(pose(0.5, 0.3, 0.4, rpy=[0, np.pi / 2, 0]), rng_seed=1, time_limit=PATIENT).q
    return line(find("plan_straight_line")(checker, q, pose(0.5, -0.2, 0.5, rpy=[0, np.pi / 2, 0.5])))


@call
def cartesian() -> Answer:
    arm = group("kr6like")
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    corners = [pose(x, y, 0.35, rpy=[0, np.pi / 2, 0]) for x, y in ((0.4, 0.2), (0.4, -0.2), (0.5, -0.2), (0.5, 0.2))]
    found = find("plan_cartesian")(checker, np.array(corners))
    parts, shown = line(found)
    return parts | {"corners": found.corners, "branches": [found.branches, found.tried]}, shown | {
        "branches": found.branches
    }


@call
def timing() -> Answer:
    arm = group("kr6like")
    path = np.cumsum(0.3 * drawn(arm, 8, 6) / abs(drawn(arm, 8, 6)).max(), axis=0)
    limits = [arm.velocity_limits, np.full(len(arm.names), 6.0)]
    plain = find("time_parameterize")(path, *limits)
    jerk = find("time_parameterize")(path, *limits, jerk_limits=np.full(len(arm.names), 60.0))
    arm = arm.with_acceleration_limits(limits[1])
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    free = find("time_parameterize_free")(checker, path)
    parts = {"plain": timed(plain), "jerk": timed(jerk), "free": timed(free)}
    return parts, {"seconds": plain.duration, "with jerk limits": jerk.duration, "samples": len(plain)}


# Reach.


@call
def reach() -> Answer:
    arm, database = group("fetchlike", "diff_drive"), reach_database()
    checker = find("CollisionChecker")(arm.robot, world(), arm)
    poses = arm.fk_batch(drawn(arm, 30, 7))
    bases = database.base_poses_for(arm, pose(2, 1, 0.75, rpy=[0, np.pi / 2, 0]), count=10, threads=THREADS)
    targets = np.array([pose(1.9, 1, 0.75, rpy=[0, np.pi / 2, 0]), pose(1.8, 0.8, 0.8, rpy=[0, np.pi / 2, 0.4])])
    placed = database.find_base_placement(arm, targets, threads=THREADS)
    arrays = database.arrays
    parts = {
        "database": [arrays[key] for key in sorted(arrays)],
        "query": [[database.query(T), get(database, "nearest")(T)] for T in poses],
        "solve": list(database.solve_batch(arm, poses, checker=checker, count=4, threads=THREADS)),
        "base poses": list(bases),
        "placement": [placed.base_pose, placed.reached, list(placed.configurations)],
    }
    return parts, {"size": len(database), "solutions": sum(map(len, parts["solve"])), "base poses": len(bases[0])}


@call
def capability_map() -> Answer:
    table = find("World")()
    table.add_box("table", [0.8, 1.6, 0.05], pose(0.9, 0, 0.7))
    parts, reached = {}, {}
    for name, scene in (("fetchlike", None), ("kr6like", table)):
        arm = group(name)
        made = find("CapabilityMap").build(arm, scene, voxel=0.2, poses=10, approach=(1.0, 0.0, 0.0), threads=THREADS)
        parts[name] = [made.index, made.classes, made.configurations, made.tool_poses, rejections(made.rejections)]
        reached[name] = made.reached
    return parts, reached


@call
def platform_locations() -> Answer:
    arm = group("fetchlike", "diff_drive", with_base=True)
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    ends = [pose(0.8, y, 0.9, rpy=[0, np.pi / 2, 0]) for y in (-1.5, 1.5)]
    found = find("plan_platform_locations")(checker, *ends, samples=15, seed=1, time_limit=PATIENT)
    parts = {
        "outcome": found.outcome,
        "configurations": [found.q_pick, found.q_place],
        "cost": [found.cost, found.travel, found.turn],
    }
    return parts, {"outcome": found.outcome.name, "cost": found.cost}


# Grasps, cameras, meshes.


@call
def grasps() -> Answer:
    mesh = find("Mesh").load(asset("objects/angle.stl"))
    parts = {}
    for name, part in (
        ("box", body(0.04, 0.06, 0.08)),
        ("cylinder", [shape("Cylinder", 0.02, 0.1)]),
        ("mesh", [find("LinkShape")(mesh)]),
    ):
        found = find("sample_grasps")(part, hand(), seed=1)
        parts[name] = [
            [
                get(g, "T_object_tcp", "T_object_tool", "T_object_hand"),
                get(g, "width", "opening"),
                get(g, "quality", "score"),
            ]
            for g in found
        ]
    return parts, {name: len(found) for name, found in parts.items()}


@call
def pipe_grasps() -> Answer:
    parts = {}
    for number, pipe in enumerate(find("pipe_structures")(), 1):
        found = ask(pipe.sample_grasps, 100, gripper=find("pipe_robot")("tm14like")[2], seed=1)
        parts[str(number)] = [[get(g, "T_object_tool", "T_object_tcp"), g.opening, g.cost] for g in found]
    return parts, {"grasps": sum(map(len, parts.values()))}


@cache
def scan() -> Any:
    return find("scan_random_tray")(body(0.07, 0.035, 0.03), [0.3, 0.4, 0.1], hand(), count=12, fill=0.5, seed=1)


@call
def random_placement() -> Answer:
    resting = find("resting_poses")(body(0.07, 0.035, 0.03))
    found = find("random_placement")(body(0.07, 0.035, 0.03), [0.3, 0.4, 0.1], count=20, seed=2)
    parts = {
        "placed": [[p.T_tray_part, p.on_floor, p.resting_pose] for p in found.parts],
        "resting": [[p.T_floor_part, p.probability] for p in resting],
    }
    return parts, {"placed": len(found.parts), "not placed": found.not_placed}


@call
def depth_and_height_map() -> Answer:
    parts = {"depth": scan().image.depth, "points": scan().image.points()}
    parts["height"] = [scan().height_map.height, get(scan().height_map, "upper")]
    return parts, {
        "measured": int(np.isfinite(scan().image.depth).sum()),
        "highest": float(np.nanmax(scan().height_map.height)),
    }


@call
def graspability() -> Answer:
    found = scan().found
    fields = [["T_world_tcp", "T_world_tool", "T_object_tool"], ["score"], ["opening"]]
    parts = {"grasps": [[get(g, *names) for names in fields] for g in found.grasps], "counts": found.counts}
    return parts, {"grasps": len(found.grasps)}


@call
def cuboids() -> Answer:
    eye = scan().image.T_world_camera[:3, 3]
    fit = find("fit_cuboids")(scan().image.points(), T_world_tray=np.eye(4), tray_size=[0.3, 0.4, 0.1], eye=eye)
    parts = {"cuboids": [[c.T_world_box, c.size, c.fill, c.points] for c in fit.cuboids], "labels": fit.labels}
    return parts, {"cuboids": len(fit.cuboids)}


@call
def simplified_mesh() -> Answer:
    mesh, answers = find("Mesh").load(asset("objects/angle.stl")), []
    for tolerance in (0.0, 0.005, 0.05):
        found = find("simplify_mesh")(mesh, tolerance)
        surface = found["shape"].surface()
        answers.append(
            [found["deviation"], found["triangles_saved"], found["shape"].pose, surface.vertices, surface.triangles]
        )
    return {"solids": answers}, {"triangles": [len(answer[-1]) for answer in answers]}


@call
def push_grasp() -> Answer:
    answers = [
        find("push_grasp")(tool_speed=v, object_width=0.05, opening=0.1, planned_depth=0.06, max_push=0.3)
        for v in (0.1, 0.3, 0.5)
    ]
    fields = ("closing_time", "earliest", "latest", "window", "feasible", "max_tool_speed")
    ends = [[[getattr(end, key) for key in ("start", "pushed", "holds")] for end in (a.plain, a.push)] for a in answers]
    parts = {"figures": [[get(a, key) for key in fields] for a in answers], "ends": ends}
    limit = find("push_speed_limit")(length=0.03, friction=0.3, restitution=0.4)
    return parts | {"speed limit": limit}, {"window": answers[-1].window, "speed limit": limit}


# Manipulation.


def pipe_problem(structure: int, count: int) -> Any:
    """A pipe before an arm, to be moved past a column; without drawing a cell, which takes long."""
    robot_, arm, gripper = find("pipe_robot")("tm14like")
    pipe, scene = find("pipe_structures")()[structure - 1], find("World")()
    scene.add_box("column", [0.1, 0.1, 0.7], pose(0.6, 0, 0.35))
    scene.add_box("table", [2, 2, 0.05], pose(0, 0, -0.05))
    found = ask(pipe.sample_grasps, count, gripper=gripper, seed=1)
    candidates = [
        find("CandidateGrasp", "Grasp")(get(g, "T_object_tool", "T_object_tcp"), opening=g.opening, cost=g.cost)
        for g in found
    ]
    fingers = sorted(link for link in robot_.links if "finger_link" in link)
    ends = [pose(0.5, side * 0.45, 0.35, rpy=[0, 0, side * 0.4]) for side in (1, -1)]
    return find("ManipulationProblem")(
        arm, scene, pipe.shapes(), *ends, candidates, gripper=gripper, touch_links=fingers
    )


@call
def prm_star_mg_pipe() -> Answer:
    options = {"vertices": 2000, "neighbours": 12, "seed": 1, "time_limit": PATIENT, "threads": THREADS}
    return manipulation(ask(find("plan_manipulation"), pipe_problem(1, 60), planner="prm_star_mg", **options))


@call
def rrt_star_mg_pipe() -> Answer:
    options = {"max_samples": 600, "seed": 1, "time_limit": PATIENT, "threads": THREADS}
    return manipulation(ask(find("plan_manipulation"), pipe_problem(6, 60), planner="rrt_star_mg", **options))


@cache
def bar_problem() -> Any:
    """A flat arm of three joints turns a bar past a post, held at one of 20 places."""
    links, pairs = ['<link name="l0"/>'], []
    for i in range(1, 4):
        links.append(
            f'<link name="l{i}"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.02 0.02"/></geometry></collision></link>'
            f'<joint name="j{i}" type="revolute"><parent link="l{i - 1}"/><child link="l{i}"/><origin xyz="{0.4 if i > 1 else 0} 0 0"/>'
            '<axis xyz="0 0 1"/><limit effort="1" velocity="2" lower="-2.8" upper="2.8"/></joint>'
        )
        pairs += [f'<disable_collisions link1="l{k}" link2="l{i}" reason="User"/>' for k in range(i)]
    links.append(
        '<link name="tip"/><joint name="t" type="fixed"><parent link="l3"/><child link="tip"/><origin xyz="0.4 0 0"/></joint>'
    )
    urdf, srdf = (f'<robot name="planar">{"".join(rows)}</robot>' for rows in (links, pairs))
    arm = find("Robot").from_strings(urdf, srdf).group(base_link="l0", tip="tip")
    scene = find("World")()
    scene.add_box("post", [0.1, 0.1, 0.2], pose(0.85, 0, 0))
    scene.add_box("corner", [0.06, 0.06, 0.2], pose(0.35, -0.75, 0))
    places = [pose(-0.18 + 0.04 * i, 0, 0, rpy=[0, 0, turn * np.pi / 2]) for i in range(10) for turn in (1, -1)]
    candidates = [find("CandidateGrasp", "Grasp")(T) for T in places]
    ends = [pose(0.55, 0.45, 0, rpy=[0, 0, 1.2]), pose(0.6, -0.45, 0, rpy=[0, 0, 0.9])]
    return find("ManipulationProblem")(arm, scene, body(0.4, 0.02, 0.02), *ends, candidates, touch_links=["l3", "tip"])


@call
def prm_star_mg_growing() -> Answer:
    """No straight lines, and a roadmap that is doubled."""
    options = {"vertices": 500, "max_vertices": 4000, "straight": False, "time_limit": PATIENT, "threads": THREADS}
    return manipulation(ask(find("plan_manipulation"), pipe_problem(3, 40), **options))


@call
def pipe_cell_carry() -> Answer:
    """The cell of example 10."""
    cell = find("pipe_cell")(5, seed=1)
    options = {"vertices": 5000, "seed": 1, "time_limit": PATIENT, "threads": THREADS}
    parts, shown = manipulation(ask(find("plan_manipulation"), cell.problem(cell.grasps(200)), **options))
    return parts | {"cell": [cell.T_world_start, cell.T_world_goal]}, shown


@call
def prm_star_mg_bar() -> Answer:
    options = {"vertices": 800, "gamma": 5, "ik_solutions": 2, "time_limit": PATIENT, "threads": THREADS}
    return manipulation(ask(find("plan_manipulation"), bar_problem(), **options))


@call
def rrt_star_mg_bar() -> Answer:
    options = {"max_samples": 1000, "time_limit": PATIENT, "threads": THREADS, "keep_trees": True}
    found = ask(find("plan_manipulation"), bar_problem(), planner="rrt_star_mg", **options)
    parts, shown = manipulation(found)
    trees = [[tree.vertices, list(tree.parents), list(tree.costs), tree.grasp, tree.from_goal] for tree in found.trees]
    return parts | {"trees": trees}, shown | {"trees": len(trees)}


@call
def roadmap() -> Answer:
    arm = bar_problem().group if hasattr(bar_problem(), "group") else group("kr6like")
    made = ask(find("Roadmap").build, arm, vertices=1000, neighbours=8, seed=3)
    return {"vertices": made.vertices, "edges": made.edges}, {"edges": len(made.edges)}


# Base poses, stops, routes.


def row_of_squares(count: int) -> tuple[Any, list[np.ndarray]]:
    grid = find("BaseGrid")([0.0, 0.0], 0.05, 8 * count + 12, 16)
    masks = []
    for i in range(count):
        mask = np.zeros((1, grid.ny, grid.nx), np.uint8)
        mask[0, 2:14, 2 + 8 * i : 14 + 8 * i] = 1
        masks.append(mask)
    return grid, masks


@call
def stops_of_a_row() -> Answer:
    grid, masks = row_of_squares(7)
    found = find("least_stops", "plan_stops_exact")(
        grid, masks, 0.1, start=[0, 0], goal=[3, 0], time_limit=PATIENT, tie_time_limit=PATIENT
    )
    cells = find("robust_intersections")(grid, masks, 0.1)
    cover = find("minimal_stops", "cover_from_intersections")(grid, cells.robust, len(masks))
    whole = find("maximal_intersections")(grid, masks, 0.1)
    parts = {f"exact, {key}": part for key, part in stops(found)[0].items()} | {
        f"cover, {key}": part for key, part in stops(cover)[0].items()
    }
    return parts | {"robust": shared_cells(cells), "maximal": shared_cells(whole)}, stops(found)[1]


@call
def policies_and_order() -> Answer:
    grid = find("BaseGrid")([-1.0, -1.5], 0.05, 80, 30)
    x, y = -1 + 0.05 * (np.arange(grid.nx) + 0.5), -1.5 + 0.05 * (np.arange(grid.ny) + 0.5)
    places = [np.array([[0.5 * tray + 0.1 * i, 0.0] for i in range(3)]) for tray in range(4)]
    cells = [[(np.hypot(x - p[0], y[:, None]) < 0.8).astype(np.uint8)[None] for p in at] for at in places]
    order, parts, shown = find("paired_order")(places), {}, {}
    for policy in ("all", "remaining", "targets"):
        found = find("run_policy")(grid, cells, order, policy, time_limit=PATIENT, tie_time_limit=PATIENT)
        figures = [found.mean_stops, found.mean_radius, found.smallest_radius]
        parts[policy] = [figures, [[stop(s) for s in r.stops] for r in found.rounds]]
        shown[policy] = found.mean_stops
    best = find("optimised_order", "optimized_order")(grid, cells, [[0, 1], [2, 3]], order)
    return parts | {"order": [order, best.order, best.mean_radius, best.proven]}, shown


@call
def set_cover_and_tours() -> Answer:
    rng = np.random.default_rng(1)
    sets = [sorted(set(rng.integers(0, 40, 6).tolist())) for _ in range(60)] + [[i] for i in range(40)]
    cover = find("solve_set_cover")(40, sets, rng.uniform(1, 2, len(sets)).tolist(), time_limit=PATIENT)
    points = rng.uniform(0, 10, (22, 2))
    lengths = np.linalg.norm(points[:, None] - points[None], axis=2)
    small, large = (find("shortest_visiting_tour")(lengths[:n, :n]) for n in (12, 22))
    shared = find("share_stops")(lengths[:9, :9], [1.0, 2, 3, 4, 5], 2)
    costs = rng.uniform(0, 1, (12, 12))
    parts = {
        "cover": [cover.outcome, cover.chosen, cover.cost, cover.lower_bound],
        "tours": [[tour.outcome, tour.order, tour.length, tour.lower_bound, tour.proven] for tour in (small, large)],
        "shared": [shared.outcome, shared.orders, shared.durations, shared.makespan, shared.lower_bound],
        "assignment": find("cheapest_assignment")(costs),
    }
    return parts, {"cover": cover.cost, "tour": large.length, "makespan": shared.makespan}


@call
def base_route() -> Answer:
    parts, shown = {}, {}
    for name, base in ROBOTS[:2]:
        arm, scene = group(name, base), find("World")()
        for i in range(3):
            scene.add_box(f"wall {i}", [0.1, 3.0, 1.0], pose(1.5 + 1.5 * i, 1.0 * (-1) ** i, 0.5))
        home = tucked(name, base)
        ends = {"start": [0, 0, 0], "goal": [6, 0.5, 1.0]}
        found = find("plan_base_route")(arm, scene, home=home, **ends)
        at = np.array([[0, 0, 0], [2.2, 0, 1], [6, 0.5, 1]])
        parts[name] = [
            found.outcome,
            found.poses,
            found.length,
            found.turning,
            find("route_lengths")(arm, scene, home=home, positions=at, threads=THREADS),
        ]
        shown[name] = found.length
    return parts, shown


# The main job.


@cache
def scenario(name: str, trays: int, targets: int) -> Any:
    """A shipped scenario with fewer trays, fewer parts to pick, a smaller database, and no clock."""
    values = yaml.safe_load(asset(f"scenarios/{name}.yaml").read_text())
    values["trays"] = values["trays"][:trays]
    for tray in values["trays"]:
        if tray["targets"] != "all":
            tray["targets"] = tray["targets"][:targets]
    values["reach"] = {"samples": 300_000}
    values["options"] = {**values.get("options", {}), "motion_time_limit": PATIENT}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scenario.yaml"
        path.write_text(yaml.safe_dump(values, sort_keys=False))
        return find("load_scenario")(path)


@cache
def plan(name: str, trays: int, targets: int) -> Any:
    return find("plan_part_supply")(scenario(name, trays, targets), seed=1, threads=THREADS)


def supply(name: str, trays: int, targets: int) -> Answer:
    made = plan(name, trays, targets)
    found = made.result
    picks = [
        [pick.outcome, pick.stop, pick.tray, pick.part, pick.grasp, rejections(pick.rejections)] for pick in found.picks
    ]
    parts = {
        "outcome": [found.outcome, found.lower_bound, found.robustness_rate],
        "regions": [region.cells(found.grid) for region in found.regions],
        "rejections": [
            [
                [e.grasps, e.base_poses_tried, e.base_poses_feasible, rejections(e.rejections)]
                for e in region.explanations
            ]
            for region in found.regions
        ],
        "intersections": shared_cells(found.intersections),
        "stops": [stop(s) for s in found.stops],
        "route": [[leg.poses, leg.length, leg.turning] for leg in found.route],
        "picks": picks,
        "motions": [[[timed(m.trajectory), m.opening, m.holding] for m in pick.motions] for pick in found.picks],
    }
    shown = {
        "outcome": found.outcome.name,
        "stops": len(found.stops),
        "picks": len(picks),
        "driven": sum(leg.length for leg in found.route),
    }
    return parts, shown | {"motions [s]": sum(pick.duration for pick in found.picks)}


@call
def part_supply_storeroom() -> Answer:
    return supply("storeroom", 5, 4)


@call
def part_supply_omni() -> Answer:
    return supply("omni_cell", 2, 2)


@call
def verified() -> Answer:
    found = find("verify_plan")(plan("storeroom", 5, 4).to_dict(), samples=50)
    rates = [[rate.stop, rate.samples, rate.good] for rate in found.rates]
    parts = {
        "faults": len(found.faults),
        "rates": rates,
        "figures": [found.minimal_stops, found.configurations_checked],
    }
    return parts, {"faults": len(found.faults), "configurations": found.configurations_checked}


@call
def base_regions() -> Answer:
    chosen = scenario("storeroom", 2, 2)
    problem, database = chosen.problem(), chosen.reach_database()
    grid = find("make_base_grid")(problem, database)
    kept = find("ObjectRegions").compute(problem, database, grid)
    regions = [kept.base_region(tray) for tray in range(2)]
    before = [region.cells(grid) for region in regions]
    first = kept.parts(0)[0]
    kept.remove([(0, first)])
    after = [kept.base_region(0).cells(grid), kept.region(0, kept.parts(0)[:1])]
    return {"regions": before, "without a part": after, "parts": [r.part_cells(grid) for r in regions]}, {
        "cells": [r.count for r in regions]
    }


# Grasping while driving.


@call
def drive_by() -> Answer:
    limits = {"wheel_separation": 0.37476, "linear_velocity": 0.6, "wheel_velocity": 0.8}
    folder = asset("robots/fetchlike")
    moving = find("Robot").load(
        folder / "fetchlike.urdf", folder / "fetchlike.srdf", base="diff_drive", base_limits=limits
    )
    whole = moving.group("arm", tip="gripper_link", with_base=True).with_reference({"torso_lift_joint": 0.2})
    goal = [10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5]
    task = find("DriveByTask")(pose(5.5, -2, 0.5, rpy=[1, 1, 0]))
    found = find("plan_drive_by")(moving, whole, find("World")(), start=[0.0] * 10, tasks=[task], goal=goal,
                                  time_limit=PATIENT, attempt_time_limit=PATIENT, threads=THREADS)  # fmt: skip
    way = found.trajectory
    parts = {
        "outcome": found.outcome,
        "trajectory": [way.times, way.positions, way.drive],
        "sampled": timed(way.sampled(3)),
    }
    parts["events"] = [[e["waypoint"], e["time"], e["base_speed"], e["tool_speed"]] for e in found.events]
    return parts | {"iterations": found.iterations}, {
        "outcome": found.outcome.name,
        "seconds": found.duration,
        "iterations": found.iterations,
    }


@call
def drive_by_past_a_table() -> Answer:
    """A bottle is taken in passing; the robot keeps clear of the table and of itself."""
    arm = group("fetchlike", "diff_drive", with_base=True).with_reference({"head_tilt_joint": 0.4})
    scene = find("World")()
    scene.add_box("table", [1.2, 0.5, 0.7], pose(2.0, -0.9, 0.35))
    scene.add_cylinder("bottle", 0.028, 0.16, pose(2.0, -0.8, 0.781))
    T_grasp, home = pose(2.0, -0.8, 0.77, rpy=[0, 0, -0.6]), tucked("fetchlike", "diff_drive")
    tasks = [
        find("DriveByTask")(T_grasp @ pose(-0.12, 0, 0), tolerance=[0.005] * 3 + [0.03] * 3),
        find("DriveByTask")(T_grasp, dwell=0.4, object="bottle"),
    ]
    ends = {"start": [0, 0, 0, *home], "goal": [4, 0, 0, *home]}
    options = {"waypoints": 45, "time_limit": PATIENT, "attempt_time_limit": PATIENT, "threads": THREADS}
    found = find("plan_drive_by")(arm.robot, arm, scene, tasks=tasks, **ends, **options)
    way = found.trajectory
    parts = {"outcome": [found.outcome, found.iterations, found.attempts]}
    parts["trajectory"] = [way.times, way.positions, way.drive]
    return parts, {"outcome": found.outcome.name, "seconds": found.duration, "iterations": found.iterations}


@call
def drive_by_picks() -> Answer:
    """The first picks of a plan merged with the drive."""
    found = find("plan_drive_by_picks")(plan("omni_cell", 2, 2))
    parts = {"used": [[p.used, p.leg, p.stop, p.pick, p.stop_and_pick, p.drive_by] for p in found.picks]}
    parts["ways"] = [None if p.result.trajectory is None else p.result.trajectory.positions for p in found.picks]
    return parts, {"used": sum(p.used for p in found.picks), "saved": found.saved}


@call
def tracking() -> Answer:
    limits = {"linear_velocity": 2.0, "angular_velocity": 3.0, "wheel_separation": 0.4}
    moving = find("Robot").from_strings(
        '<robot name="r"><link name="base"/></robot>', base="diff_drive", base_limits=limits
    )
    times = np.arange(0.0, 4.01, 0.02)
    angle = 0.4 * times
    positions = np.column_stack([1.25 * np.sin(angle), 1.25 * (1 - np.cos(angle)), angle])
    velocities = np.column_stack([0.5 * np.cos(angle), 0.5 * np.sin(angle), np.full_like(angle, 0.4)])
    wanted = find("JointTrajectory")(["x", "y", "theta"], times, positions, velocities)
    noise = {"slip_left": 0.05, "travel_noise": 0.003, "position_noise": 0.002, "heading_noise": 0.002, "seed": 4}
    found = find("track_base")(moving, wanted, start_error=[0.1, -0.05, 0.2], **noise)
    parts = {
        "way": [found.times, found.actual, found.commands],
        "errors": [found.position_errors, found.heading_errors],
    }
    return parts, {"final error": found.final_error}


# With the shared data.


@call
def panda_with_meshes() -> Answer:
    folder = SHARED / "robots/panda_vamp/panda"
    if not (folder / "panda.urdf").exists():
        raise Skipped("the shared test data is not there")
    panda = find("Robot").load(folder / "panda.urdf", folder / "panda.srdf")
    arm = panda.group(next(name for name in sorted(panda.groups) if "arm" in name))
    checker, Q = find("CollisionChecker")(panda, world(), arm), drawn(arm, 300)
    free = checker.are_free(Q, threads=THREADS)
    return {"fk": arm.fk_batch(Q), "free": free, "distance": [checker.distance(q).value for q in Q[:50]]}, {
        "free": int(free.sum())
    }
