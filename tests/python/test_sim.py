"""Physics trials: the model against closed forms, grasps that must hold and such that must not, repeatability."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp import sim
from mmgrasp.sim.bottle import Bottle
from mmgrasp.sim.passing import Passing, posture
from mmgrasp.sim.pictures import frames, write_gif, write_strip
from sim_scenes import TABLE, approach, arm, box, gripper, robot, table

try:
    import mujoco
except ImportError:
    mujoco = None
physics = pytest.mark.skipif(mujoco is None, reason="MuJoCo is not installed (pip install 'mmgrasp[sim]')")
G = 9.81


def stone() -> mg.Robot:
    return mg.Robot.from_strings('<robot name="stone"><link name="stone"/></robot>')


def steps(world: sim.Simulation, seconds: float) -> None:
    for _ in range(round(seconds / world.physics.time_step)):
        world.mujoco.mj_step(world.model, world.data)
    world.mujoco.mj_forward(world.model, world.data)


# --- the model ---------------------------------------------------------------------------------------------------------
def test_without_mujoco_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(mg.InvalidInput, match=r"mmgrasp\[sim\]"):
        sim.Simulation(stone(), mg.World())


def test_the_model_has_every_joint_shape_and_mass() -> None:
    built = sim.build(robot(), table(), [box()], gripper())
    root = ET.fromstring(built.xml)
    actuated = [e.attrib["name"] for e in root.findall("actuator/*")]
    assert built.joints == [name for name in actuated if not name.startswith("base/")]
    assert sorted(built.joints) == sorted(robot().joints)
    assert list(built.fingers) == [j.name for j in gripper().joints]
    shapes = sum(len(robot().collisions(link)) for link in robot().links)
    assert len(root.findall("worldbody//geom")) == shapes + 3 == len(built.owner)  # floor, table, box
    urdf = ET.fromstring(robot().to_urdf())
    masses = sum(float(m.attrib["value"]) for m in urdf.findall(".//inertial/mass"))
    assert sum(float(i.attrib["mass"]) for i in root.findall(".//inertial")) == pytest.approx(masses)
    assert "weld" not in built.xml


@physics
def test_links_stand_where_forward_kinematics_puts_them() -> None:
    world = sim.Simulation(robot(), table(), gripper=gripper())
    joints = dict(zip(arm().names, approach().positions[3], strict=True))
    world.reset(np.array([0.3, -0.2, 0.7]), joints)
    T = mg.pose([0.3, -0.2, 0], rpy=[0, 0, 0.7])
    for link, expected in robot().link_poses(joints, T).items():
        assert world.body_pose(f"link/{link}") == pytest.approx(expected, abs=1e-9), link


@physics
def test_free_fall() -> None:
    ball = sim.SimPart("ball", [mg.LinkShape(mg.Sphere(0.05))], mg.pose([0, 0, 2.0]))
    world = sim.Simulation(stone(), mg.World(), [ball])
    steps(world, 0.5)
    # Semi-implicit steps h of a constant acceleration fall g h t / 2 farther than g t^2 / 2.
    fallen = G * 0.5**2 / 2 + G * world.physics.time_step * 0.5 / 2
    assert 2.0 - world.part_pose("ball")[2, 3] == pytest.approx(fallen, abs=1e-9)
    steps(world, 3.0)
    assert world.part_pose("ball")[2, 3] == pytest.approx(0.05, abs=1e-3)


@physics
@pytest.mark.parametrize("angle", [0.15, 0.25, 0.35, 0.5])
def test_a_block_on_a_slope_keeps_to_the_friction_cone(angle: Any) -> None:
    tilted = sim.Physics(gravity=(G * np.sin(angle), 0, -G * np.cos(angle)))
    block = sim.SimPart("block", [mg.LinkShape(mg.Box([0.1, 0.1, 0.02]))], mg.pose([0, 0, 0.01]), mass=0.5)
    world = sim.Simulation(stone(), mg.World(), [block], physics=tilted)
    steps(world, 0.6)
    slid = world.part_pose("block")[0, 3]
    acceleration = G * (np.sin(angle) - 0.3 * np.cos(angle))
    if acceleration < 0:
        assert abs(slid) < 5e-4
    else:
        assert slid == pytest.approx(acceleration * 0.6**2 / 2, rel=0.03)


@physics
def test_a_part_weighs_what_it_is_told() -> None:
    part = sim.SimPart("two", [mg.LinkShape(mg.Box([0.1, 0.1, 0.1]), mg.pose([0.05, 0, 0.05])), mg.LinkShape(mg.Box([0.1, 0.1, 0.1]), mg.pose([-0.05, 0, 0.05]))], mg.pose([0, 0, 0]), mass=0.7)  # fmt: skip
    world = sim.Simulation(stone(), mg.World(), [part])
    assert world.model.body("part/two").mass[0] == pytest.approx(0.7)
    # A box of 0.2 x 0.1 x 0.1 m about its middle.
    expected = 0.7 / 12 * np.array([0.1**2 + 0.1**2, 0.2**2 + 0.1**2, 0.2**2 + 0.1**2])
    assert sorted(world.model.body("part/two").inertia) == pytest.approx(sorted(expected))
    steps(world, 0.5)
    (force,) = world.contact_forces().values()
    assert force == pytest.approx(0.7 * G, rel=1e-3)


# --- grasping ----------------------------------------------------------------------------------------------------------
@physics
def test_a_box_is_picked_from_the_table_and_held() -> None:
    world = sim.Simulation(robot(), table(), [box()], gripper=gripper())
    run = world.run(approach(), arm=arm())
    part = run.parts["box"]
    assert run.grasped and part.grasped, part.cause
    assert part.rise == pytest.approx(0.1, abs=2e-3)
    assert part.displacement < 1e-3
    assert part.slip < 1e-3
    assert run.arm_error < 2e-3
    # Wide open it takes half a second to close 10 cm, and half of that to come to the 5 cm of the box.
    for finger in gripper().finger_links:
        (event,) = run.touching("box", finger)
        assert event.begin == pytest.approx(approach().duration + 0.05 / 0.1, abs=0.05)
        assert event.peak_force == pytest.approx(world.physics.grip_force, rel=0.05)
    (lying,) = run.touching("box", "table")
    assert lying.end < run.duration - 2.0


@physics
@pytest.mark.parametrize("y, cause", [(0.2, "never touched"), (0.06, "never had it|not lifted")])
def test_a_box_beside_the_gripper_is_not_grasped(y: Any, cause: str) -> None:
    world = sim.Simulation(robot(), table(), [box(y=y)], gripper=gripper())
    part = world.run(approach(), arm=arm()).parts["box"]
    assert not part.grasped
    assert np.any([c in part.cause for c in cause.split("|")]), part.cause
    assert part.rise < 0.05


@physics
@pytest.mark.parametrize("share, holds", [(0.8, True), (1.25, False)])
def test_the_grip_carries_what_its_friction_cones_do(share: Any, holds: Any) -> None:
    """Two fingers with force F and friction mu carry 2 mu F; the lift adds next to nothing."""
    weak = sim.Physics(grip_force=20.0, finger_friction=0.9)
    mass = share * 2 * 0.9 * 20.0 / G
    world = sim.Simulation(robot(), table(), [box(mass=mass)], gripper=gripper(), physics=weak)
    assert world.run(approach(), arm=arm()).grasped == holds


# --- the base ----------------------------------------------------------------------------------------------------------
def drive(v: float = 0.4, duration: float = 3.0) -> mg.planning.JointTrajectory:
    times = np.arange(0.0, duration + 0.01, 0.02)
    share = times / duration
    way = v * duration * share**3 * (10 - 15 * share + 6 * share**2)
    return mg.planning.JointTrajectory(["x", "y", "theta"], times, np.outer(way, [1, 0, 0]))


@physics
def test_the_base_drives_as_planned_and_slips_as_told() -> None:
    world = sim.Simulation(robot(), mg.World())
    run = world.run(drive(0.25), hold=0.5)
    assert run.base_error < 0.01
    assert run.states[-1]["base"] == pytest.approx([0.75, 0, 0], abs=2e-3)
    open_loop = world.run(drive(0.25), hold=0.5, tracking={"feedback": False}, slip=(0.1, 0.1))
    assert open_loop.states[-1]["base"] == pytest.approx([0.9 * 0.75, 0, 0], abs=2e-3)
    closed = world.run(drive(0.25), hold=0.5, slip=(0.1, 0.1))
    assert closed.base_error < 0.3 * open_loop.base_error


@physics
def test_speed_stretches_the_plan() -> None:
    world = sim.Simulation(robot(), mg.World())
    slow = world.run(drive(0.25), hold=0.0, speed=0.5)
    assert slow.duration == pytest.approx(6.0, abs=0.01)
    assert slow.states[-1]["base"] == pytest.approx([0.75, 0, 0], abs=2e-3)


@physics
def test_same_seed_same_run() -> None:
    world = sim.Simulation(robot(), table(), [box()], gripper=gripper())
    noisy: dict[str, Any] = {"position_noise": 0.003, "heading_noise": 0.003, "travel_noise": 0.01, "hold": 0.2}
    plan = mg.planning.JointTrajectory(["x", "y", "theta"], [0, 1], [[-1.0, 0, 0], [-0.8, 0, 0]])
    first, again, other = (world.run(plan, seed=s, **noisy) for s in (4, 4, 5))
    assert first.to_dict() == again.to_dict()
    assert first.states[-1]["base"] == again.states[-1]["base"] != other.states[-1]["base"]


# --- wrong input -------------------------------------------------------------------------------------------------------
@physics
def test_wrong_input_is_refused_by_name() -> None:
    world = sim.Simulation(robot(), table(), [box()], gripper=gripper())
    for bad in (
        {"speed": 0}, {"speed": 2.0}, {"closing_speed": 0}, {"lift": -1}, {"hold": np.nan}, {"slip": (0, 1)}, {"close_at": -1},
        {"frame_period": 0}, {"position_noise": -1},
    ):  # fmt: skip
        with pytest.raises(mg.InvalidInput, match=next(iter(bad))):
            world.run(approach(), arm=arm(), **bad)
    with pytest.raises(mg.InvalidInput, match="spede"):
        world.run(approach(), spede=1)  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match="elbow"):
        world.run(mg.planning.JointTrajectory(["elbow"], [0, 1], [[0], [1]]))
    with pytest.raises(mg.InvalidInput, match="without the base"):
        world.run(approach(), arm=robot().group("arm_with_torso", tip="gripper_tcp", with_base=True))
    with pytest.raises(mg.InvalidInput, match="lift"):
        world.run(approach(), arm=arm(), lift=2.0)
    with pytest.raises(mg.InvalidInput, match="renderer"):
        frames(world, world.run(drive(), hold=0.0), [0], eye=[1, 1, 1], target=[0, 0, 0], renderer="x")


def test_wrong_parts_and_numbers_are_refused() -> None:
    for bad in (box(mass=0), box(mass=np.nan), box(friction=-1), sim.SimPart("empty", [], np.eye(4))):
        with pytest.raises(mg.InvalidInput, match="part"):
            sim.build(stone(), mg.World(), [bad])
    for field in ("time_step", "grip_force", "finger_friction"):
        wrong = sim.Physics()
        setattr(wrong, field, 0)
        with pytest.raises(mg.InvalidInput, match=field):
            sim.build(stone(), mg.World(), physics=wrong)
    floating = mg.Robot.from_strings('<robot name="f"><link name="a"/><link name="b"/><joint name="j" type="floating"><parent link="a"/><child link="b"/></joint></robot>')  # fmt: skip
    with pytest.raises(mg.InvalidInput, match="'j'"):
        sim.build(floating, mg.World())


# --- pictures ----------------------------------------------------------------------------------------------------------
@physics
def test_pictures_show_the_part_where_it_is(tmp_path: Path) -> None:
    """The orange box stands in the middle of a camera that looks at it, before and after the lift."""
    world = sim.Simulation(robot(), table(), [box()], gripper=gripper())
    run = world.run(approach(), arm=arm(), frame_period=0.2)
    pictures = []
    for time, z in ((0.0, TABLE + 0.06), (run.duration, TABLE + 0.16)):
        pictures += frames(world, run, [time], eye=[1.4, -0.9, 1.1], target=[0.8, 0, z], width=160, height=120)
    for picture in pictures:
        red, _, blue = picture[60, 80].astype(int)
        assert red > 120 and red > 2 * blue
    assert write_strip(tmp_path / "strip.png", pictures, columns=2).stat().st_size > 2000
    assert write_gif(tmp_path / "run.gif", pictures, 0.1).read_bytes()[:6] == b"GIF89a"


# --- in passing --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("share", [0.2, 0.5, 1.0])
def test_plans_in_passing_meet_the_box_at_the_speed_asked_for(share: Any) -> None:
    """The tool is at the planned engagement as closing begins, and moves on at the speed until both fingers touch."""
    passing = Passing(share)
    plan, close_at = passing.plan()
    arm, q = posture()
    at = [plan.at(t) for t in (close_at, close_at + passing.closing().closing_time)]
    tips = [x[0] + arm.fk(q)[0, 3] + 0.02 for x in at]
    assert tips[0] - (2.0 - 0.025) == pytest.approx(passing.start(), abs=1e-4)
    assert tips[1] - tips[0] == pytest.approx(passing.speed * 0.5, abs=1e-4)
    speeds = np.diff(plan.positions[:, 0]) / np.diff(plan.times)
    assert speeds.max() == pytest.approx(passing.speed, rel=1e-6)
    assert np.abs(np.diff(speeds)).max() <= 0.5 * 0.01 + 1e-9


@physics
def test_push_grasp_forgives_what_plain_closing_does_not() -> None:
    """At full speed plain closing leaves 4.5 mm on either side, the push-grasp 25 mm."""
    for push in (False, True):
        passing = Passing(1.0, push, aside=0.02)
        assert passing.promised() == push
        run = passing.run(frame_period=10.0)
        assert run.grasped == push, run.parts["box"].cause


@physics
def test_the_plan_knows_where_the_bottle_lies_in_the_hand() -> None:
    """A push-grasp in one motion of base and arm: from the moment it is held the part is in physics where the plan has it, to 1 cm."""
    bottle = Bottle()
    found, close_at = bottle.plan()
    assert found.outcome == mg.Outcome.solved, found.report
    (event,) = found.events
    assert event["object"] == "bottle"
    run = bottle.run(found, close_at, hold=0.5, travel_noise=0.0, position_noise=0.0, heading_noise=0.0)
    assert run.grasped, run.parts["bottle"].cause
    hand_of = bottle.simulation().gripper
    assert hand_of is not None
    hand = hand_of.tool_link
    offsets = []
    for state in run.states:
        if state["time"] < event["attach_time"] + 0.2:
            continue
        x, y, theta = state["base"]
        T_world_hand = robot().link_poses(state["joints"], mg.pose([x, y, 0], [0, 0, theta]))[hand]
        T_hand_part = np.linalg.inv(T_world_hand) @ state["parts"]["bottle"]
        offsets.append(np.linalg.norm(T_hand_part[:3, 3] - np.array(event["T_tip_object"])[:3, 3]))
    assert len(offsets) > 50
    assert max(offsets) < 0.01
