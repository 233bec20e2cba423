"""Pictures of a carried pipe: how it bends, how sag and stress change on the way, what the objectives cost each other, and the arm."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from .._core import SupportedFrame
from ..bodies import Body, SceneBodies, floor_tiles, moved
from ..pipes.planning import PipePlan
from .pictures import _pyplot, _save
from .png import write_png
from .raster import Camera, Scene, render
from .style import FLOOR, OBSTACLE, PART, ROBOT, ROBOT_ARM, STOP, TRAY_COLOURS

POINTS = 25  # drawn along each section
SHARE = 0.12  # of the pipe's size that the largest drawn displacement has


def write_pipe_pictures(plan: PipePlan, out: Path, report: Callable[[str, float], None]) -> list[Path]:
    """Writes every picture and returns their paths."""
    steps = [write_trade_off] if plan.optimum.feasible else []
    if plan.trajectory is not None:
        steps = [write_deformed, write_sag, write_trade_off, write_motion]
    paths = []
    for i, step in enumerate(steps):
        report("pictures", i / len(steps))
        paths.append(step(plan, out))
    return paths


def drawing_scale(largest: float, size: float) -> float:
    """A round factor (1, 2 or 5 times a power of ten) that draws the largest displacement at about SHARE of the pipe's size."""
    if largest <= 0:
        return 1.0
    wanted = SHARE * size / largest
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(max(1.0, power * max(m for m in (1, 2, 5) if m * power <= wanted * (1 + 1e-9))))


def deformed_sections(plan: PipePlan, pose: int, scale: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points (n, 3) in the world along each section at a pose of the path: as it would be stiff, and displaced by `scale` times what it bends."""
    assert plan.grasp is not None
    problem, T = plan.problem, plan.problem.T_world_pipe[pose]
    held = SupportedFrame(problem.frame, [plan.grasp])
    gravity = problem.gravity_in_pipe(T)
    nodes = np.asarray(problem.pipe.nodes)
    out = []
    for i, (a, b) in enumerate(problem.pipe.sections):
        shares = np.linspace(0, 1, POINTS)
        straight = nodes[a] + shares[:, None] * (nodes[b] - nodes[a])
        length = problem.pipe.lengths[i]
        bent = np.array([held.displacement(gravity, i, min(s * length, length)) for s in shares])
        out.append((moved(T, straight), moved(T, straight + scale * bent)))
    return out


def write_deformed(plan: PipePlan, out: Path) -> Path:
    """The pipe where it sags most, from two sides."""
    worst = int(np.argmax([row.sag for row in plan.sags]))
    row = plan.sags[worst]
    nodes = np.asarray(plan.problem.pipe.nodes)
    scale = drawing_scale(row.sag, float(np.linalg.norm(np.ptp(nodes, axis=0))))
    sections = deformed_sections(plan, worst, scale)
    assert plan.grasp is not None
    hand = plan.problem.T_world_pipe[worst] @ plan.grasp.T_object_hand[:, 3]
    largest = sections[row.section]
    share = row.distance / plan.problem.pipe.lengths[row.section]
    at = largest[1][round(share * (POINTS - 1))]
    from matplotlib.ticker import MaxNLocator

    drawn = _pyplot()(11, 5.4)
    for number, (elevation, azimuth) in enumerate(((20, -60), (4, 30)), start=1):
        axes: Any = drawn.add_subplot(1, 2, number, projection="3d")
        for i, (straight, bent) in enumerate(sections):
            axes.plot(*straight.T, color="#9AA0A6", linewidth=1.2, linestyle="--", label="not bent" if i == 0 else None)
            axes.plot(*bent.T, color=PART, linewidth=3, label=f"bent, {scale:g} times" if i == 0 else None)
        axes.plot(*hand[:3, None], "s", color=ROBOT_ARM, markersize=9, label="grasp")
        axes.plot(*at[:, None], "v", color=STOP, markersize=8, label=f"largest: {1e3 * row.sag:.3g} mm")
        axes.set_aspect("equal")
        axes.view_init(elevation, azimuth)
        axes.tick_params(labelsize=7)
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_major_locator(MaxNLocator(4))
        axes.set_xlabel("x [m]", fontsize=8)
        axes.set_ylabel("y [m]", fontsize=8)
        if number == 2:
            axes.set_zlabel("z [m]", fontsize=8)
    handles, labels = drawn.axes[0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    drawn.suptitle(
        f"pose {worst}: displacements drawn {scale:g} times as large as they are", x=0.02, ha="left", fontsize=12
    )
    return _save(drawn, out / "deformed.png")


def write_sag(plan: PipePlan, out: Path) -> Path:
    """Sag and stress on the motion's clock."""
    limits = plan.problem.limits
    sags = [1e3 * row.sag for row in plan.sags]
    curves = [("largest displacement", "mm", sags, 1e3 * limits.sag, TRAY_COLOURS[0])]
    if all(row.stress is not None for row in plan.sags):
        stresses = [1e-6 * (row.stress or 0.0) for row in plan.sags]
        curves.append(("largest stress", "MPa", stresses, 1e-6 * limits.stress, TRAY_COLOURS[5]))
    drawn = _pyplot()(9, 2.6 * len(curves))
    for number, (name, unit, values, limit, colour) in enumerate(curves, start=1):
        axes = drawn.add_subplot(len(curves), 1, number)
        axes.plot([row.time for row in plan.sags], values, "o-", color=colour, markersize=4)
        axes.set_ylim(0, 1.2 * max(values) if max(values) > 0 else 1.0)
        axes.set_ylabel(f"{name} [{unit}]")
        if limit:
            axes.axhline(limit, color=colour, linestyle=":", linewidth=1.5)
            axes.set_title(f"at rest at each pose of the path; the limit is {limit:g} {unit}", loc="left", fontsize=10)
        else:
            axes.set_title("at rest at each pose of the path", loc="left", fontsize=10)
    drawn.axes[-1].set_xlabel("time [s]")
    return _save(drawn, out / "sag.png")


def write_trade_off(plan: PipePlan, out: Path) -> Path:
    """Every feasible grasp by its objectives; the Pareto front among them, and the best."""
    rows = np.array([[g.joint_motion, 1e3 * g.deflection, g.force_manipulability] for g in plan.optimum.feasible])
    rows = rows.reshape(-1, 3)
    drawn = _pyplot()(11, 4.6)
    names = ("joint motion [rad or m]", "sum of the sags [mm]", "sum of the force manipulability")
    for number, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)), start=1):
        axes = drawn.add_subplot(1, 3, number)
        axes.plot(rows[:, i], rows[:, j], ".", color="#B9BEC4", markersize=4, label="feasible grasps")
        front = rows[plan.optimum.front]
        axes.plot(front[:, i], front[:, j], "o", color=TRAY_COLOURS[0], markersize=4, label="Pareto front")
        if len(rows):
            axes.plot(rows[0, i], rows[0, j], "*", color=STOP, markersize=14, label="the best by the weights")
        axes.set_xlabel(names[i], fontsize=9)
        axes.set_ylabel(names[j], fontsize=9)
        axes.tick_params(labelsize=8)
    handles, labels = drawn.axes[0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=9)
    return _save(drawn, out / "trade_off.png")


def write_motion(plan: PipePlan, out: Path) -> Path:
    """The arm and the pipe at begin, middle and end, side by side, with the way of the pipe's frame."""
    assert plan.trajectory is not None and plan.grasp is not None
    problem = plan.problem
    arm = problem.holding(plan.grasp)[0]
    bodies = SceneBodies.of_world(problem.robot, problem.world)
    pipe = Body("pipe", tuple(problem.pipe.shapes()), np.eye(4))
    points = np.concatenate([moved(T, np.asarray(problem.pipe.nodes)) for T in problem.T_world_pipe])
    low, high = points.min(axis=0), points.max(axis=0)
    focus = (low + high) / 2
    focus[:2] *= 0.6
    reach = float(np.linalg.norm(high - low)) + 0.5
    outward = focus[:2] / max(float(np.linalg.norm(focus[:2])), 1e-9)
    eye = focus + reach * 0.85 * np.array(
        [0.75 * outward[0] - 0.65 * outward[1], 0.75 * outward[1] + 0.65 * outward[0], 0.55]
    )
    pictures = []
    for share in (0.0, 0.5, 1.0):
        q = plan.trajectory.at(share * plan.trajectory.duration)
        links = arm.link_poses(q)
        scene = Scene()
        scene.add(*floor_tiles(focus[:2] - 2, focus[:2] + 2, bodies.floor), FLOOR)
        for body in bodies.obstacles:
            scene.add(body.vertices_at(), body.faces, OBSTACLE)
        for link in bodies.links:
            colour = ROBOT_ARM if link.name in problem.gripper.finger_links else ROBOT
            scene.add(link.vertices_at(links[link.name]), link.faces, colour)
        T = arm.fk(q) @ np.linalg.inv(plan.grasp.T_object_hand)
        scene.add(pipe.vertices_at(T), pipe.faces, PART)
        pictures.append(render(scene, Camera(eye, focus, 640, 560), background="#F7F7F5"))
    return write_png(out / "motion.png", np.concatenate(pictures, axis=1))
