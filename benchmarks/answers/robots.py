"""Kinematics, inverse kinematics and collisions."""

from __future__ import annotations

import itertools
from pathlib import Path

from .lookup import PATIENT, Answer, Skipped, ask, call, find, threads
from .results import rejections
from .setups import ROBOTS, asset, drawn, group, pose, world

SHARED = Path(__file__).resolve().parents[3] / "shared/data"


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
        parts[f"{name}, free"] = checker.are_free(Q, threads=threads())
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
        answers.append(ask(find("CollisionChecker"), arm.robot, scene, arm, **options).are_free(Q, threads=threads()))
    return {"free": answers}, {"free": [int(a.sum()) for a in answers]}


@call
def disabled_pairs() -> Answer:
    parts = {}
    for name, base in ROBOTS[:2]:
        bare = find("Robot").load(asset("robots") / name / f"{name}.urdf", base=base)
        found = find("compute_disabled_pairs")(bare, samples=2000, seed=1, threads=threads())
        index = {link: i for i, link in enumerate(found.links)}
        reasons = sorted({reason for _, _, reason in found.disabled_pairs})
        parts[name] = [[index[a], index[b], reasons.index(reason)] for a, b, reason in found.disabled_pairs]
    return parts, {name: len(pairs) for name, pairs in parts.items()}


@call
def panda_with_meshes() -> Answer:
    folder = SHARED / "robots/panda_vamp/panda"
    if not (folder / "panda.urdf").exists():
        raise Skipped("the shared test data is not there")
    panda = find("Robot").load(folder / "panda.urdf", folder / "panda.srdf")
    arm = panda.group(next(name for name in sorted(panda.groups) if "arm" in name))
    checker, Q = find("CollisionChecker")(panda, world(), arm), drawn(arm, 300)
    free = checker.are_free(Q, threads=threads())
    return {"fk": arm.fk_batch(Q), "free": free, "distance": [checker.distance(q).value for q in Q[:50]]}, {
        "free": int(free.sum())
    }
