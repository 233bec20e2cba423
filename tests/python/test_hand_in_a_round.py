"""A hand of three fingers in the main job: one of its types of grasp, planned, verified, drawn, held in physics; what is refused."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS
from frame_folders import run, write_frames, write_sensors
from mmgrasp import sim
from mmgrasp.cli import main
from mmgrasp.part_supply import ScenarioPlan, plan_part_supply
from mmgrasp.viz.scene import PlanScene
from mmgrasp.viz.timeline import State

try:
    import mujoco
except ImportError:
    mujoco = None

OMNI, SCANNED = (ASSETS / "scenarios" / f"{name}.yaml" for name in ("omni_cell", "scanned_tray"))
PINCH = {"name": "sdhlike", "type": "pinch", "prefix": "hand_"}


def with_hand(scenario: Path, gripper: dict[str, Any], tool: str) -> dict[str, Any]:
    """A shipped scenario whose robot carries the three fingers in front of its own gripper."""
    raw: dict[str, Any] = yaml.safe_load(scenario.read_text())
    raw["robot"] |= {
        "mount": [
            {
                "urdf": "asset:grippers/sdhlike/sdhlike.urdf",
                "parent_link": "gripper_tcp",
                "pose": {"xyz": [0.02, 0.0, 0.0], "rpy": [0.0, float(np.pi / 2), 0.0]},
                "prefix": "hand_",
            }
        ],
        "group": {"base_link": "base_link", "tip_link": tool},
        "tool_link": tool,
    }
    return raw | {"gripper": gripper}


def written(folder: Path, raw: dict[str, Any]) -> Path:
    path = folder / "hand.yaml"
    path.write_text(yaml.safe_dump(raw))
    return path


def tip_middle(robot: mg.Robot, joints: dict[str, float], tool: str, finger: str) -> np.ndarray:
    """The middle of a fingertip's box in the tool frame, by forward kinematics [m]."""
    poses = robot.link_poses(joints)
    return np.asarray((np.linalg.inv(poses[tool]) @ poses[f"hand_{finger}_tip"] @ [0, 0, 0.03425, 1])[:3])


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> tuple[ScenarioPlan, Path]:
    folder = tmp_path_factory.mktemp("round")
    raw = with_hand(OMNI, PINCH, "hand_tcp_pinch")
    raw["trays"] = [raw["trays"][0] | {"targets": [0, 8]}, raw["trays"][1] | {"targets": [2]}]
    plan = plan_part_supply(mg.load_scenario(written(folder, raw)))
    return plan, plan.save(folder / "plan.json")


@pytest.mark.parametrize(
    ("kind", "against"), [("pinch", ("finger_1", "finger_2")), ("cylindrical", ("thumb", "finger_1", "finger_2"))]
)
def test_the_pads_close_around_the_tool_frame(kind: str, against: tuple[str, ...], tmp_path: Path) -> None:
    tool = f"hand_tcp_{kind}"
    setup = mg.load_scenario(written(tmp_path, with_hand(OMNI, PINCH | {"type": kind}, tool))).setup
    hand = setup.gripper
    assert sorted(hand.finger_links) == sorted(f"hand_{name}_tip" for name in against)
    for opening in np.linspace(hand.min_opening, hand.max_opening, 7):
        middles = [tip_middle(setup.robot, hand.joint_values(opening), tool, name) for name in against]
        # Fingers of one side, thumb or one finger of the other: the pads are half a box of 24 mm nearer.
        one = middles[0] @ hand.closing
        other = np.mean([m @ hand.closing for m in middles[1:]])
        assert abs(one - other) - 0.024 == pytest.approx(opening, abs=2e-4)
        middle = (middles[0] + np.mean(middles[1:], axis=0)) / 2
        across = np.cross(hand.approach, hand.closing)
        assert abs(middle @ hand.closing) < 1e-4 and abs(middle @ across) < 1e-4
        assert -0.0085 < middle @ hand.approach < 0.001  # turning fingers draw the tips back as they open


def test_a_round_is_planned_and_verified(planned: tuple[ScenarioPlan, Path]) -> None:
    plan, file = planned
    assert plan.outcome == mg.Outcome.solved, plan
    assert len(plan.picks) == 3
    verdict = mg.verify_plan(file, samples=100)
    assert verdict.ok, verdict.faults


def test_pictures_show_the_fingers_where_they_are(planned: tuple[ScenarioPlan, Path]) -> None:
    plan, _ = planned
    scene, hand = PlanScene(plan.to_dict()), plan.scenario.setup.gripper
    for opening in np.linspace(hand.min_opening, hand.max_opening, 5):
        shown = scene.joint_values(State(np.zeros(3), plan.scenario.setup.home, float(opening)))
        for name, value in hand.joint_values(float(opening)).items():
            assert shown[name] == pytest.approx(value, abs=1e-9)


def lifted(plan: ScenarioPlan, pick: mg.base.Pick, part: sim.SimPart) -> sim.SimResult:
    """Approach, closing and lift of a pick in physics, beside the plan's obstacles."""
    setup = plan.scenario.setup
    approach = next(m for m in pick.motions if m.kind == "approach")
    world = mg.World()
    for body in plan.scenario.obstacles:
        world.add(body.name, body.shapes, body.pose)
    physics, joints = sim.Physics(time_step=0.001), setup.other_joints
    scene = sim.Simulation(setup.robot, world, [part], gripper=setup.gripper, joints=joints, physics=physics)
    return scene.run(
        approach.trajectory,
        base=plan.stops[pick.stop].pose,
        arm=setup.arm,
        opening=approach.opening,
        lift=0.05,
        hold=0.3,
    )


@pytest.mark.skipif(mujoco is None, reason="MuJoCo is not installed (pip install 'mmgrasp[sim]')")
def test_a_part_stays_in_the_hand(planned: tuple[ScenarioPlan, Path]) -> None:
    """Approach, closing and lift in physics: the part rises with the tool, and the fingertips alone hold it."""
    plan, _ = planned
    pick = plan.picks[0]
    part = plan.scenario.trays[pick.tray].tray.parts[pick.part]
    result = lifted(plan, pick, sim.SimPart(part.name, part.shapes, part.T_world_part, mass=0.1))
    touching = {e.b if e.a == part.name else e.a for e in result.contacts if e.end > result.duration - 0.05}
    assert touching == set(plan.scenario.setup.gripper.finger_links)
    rise = result.states[-1]["parts"][part.name][2, 3] - part.T_world_part[2, 3]
    assert rise == pytest.approx(0.05, abs=0.005)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["pinch", "cylindrical"])
def test_a_round_in_passing_is_verified(kind: str, tmp_path: Path) -> None:
    raw = with_hand(OMNI, PINCH | {"type": kind}, f"hand_tcp_{kind}")
    block = {"type": "block", "grid": [1, 2], "spacing": [0.09, 0.2]}
    raw["trays"] = [raw["trays"][0] | {"parts": block, "targets": [0, 1]}]
    raw["part_types"]["block"] = {"box": [0.04, 0.09, 0.07]}
    path = written(tmp_path, raw)
    assert main(["plan", str(path), "--drive-by", "--no-pictures", "-o", str(tmp_path / "out")]) == 0
    assert main(["verify", str(tmp_path / "out/plan.json"), "--scenario", str(path), "--samples", "100"]) == 0
    content = json.loads((tmp_path / "out/plan.json").read_text())
    assert len(content["picks"]) == len(content["drive_by"]["motions"]) == 2


@pytest.mark.parametrize(
    ("boxes", "code"),
    [
        ([([0.018, 0.09, 0.07], 0.011, 0.0)], "grasp-empty"),  # met by the thumb alone, or by the two fingers
        ([([0.018, 0.09, 0.07], -0.011, 0.0)], "grasp-empty"),
        (
            [([0.04, 0.09, 0.07], 0.0, 0.0), ([0.05, 0.09, 0.008], 0.0, 0.031)],
            "grasp-fingers",
        ),  # wider above the middle
    ],
)
def test_verify_sees_what_the_fingers_meet(
    boxes: list[tuple[list[float], float, float]], code: str, cylindrical: Path, tmp_path: Path
) -> None:
    """The part of a plan that holds becomes another one, by its shapes along the closing axis and upwards."""
    assert mg.verify_plan(cylindrical, samples=20).ok
    content = json.loads(cylindrical.read_text())
    part = content["scenario"]["parts"][0]
    grasp = part["grasps"][content["picks"][0]["grasp"]]["pose"]
    closing = mg.pose([0, 0, 0], quat_xyzw=grasp["quat_xyzw"])[:3, :3] @ content["scenario"]["gripper"]["closing"]
    assert np.allclose(np.abs(closing), [1, 0, 0], atol=1e-9)
    (plain,) = part["shapes"]
    part["shapes"] = [
        plain | {"size": size, "pose": plain["pose"] | {"xyz": [along, 0.0, up]}} for size, along, up in boxes
    ]
    changed = tmp_path / "plan.json"
    changed.write_text(json.dumps(content))
    verdict = mg.verify_plan(changed, samples=20)
    assert code in {fault.code for fault in verdict.faults}


@pytest.fixture(scope="module")
def cylindrical(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A plan in which thumb and two fingers take a block of 4 cm."""
    folder = tmp_path_factory.mktemp("cylindrical")
    raw = with_hand(OMNI, PINCH | {"type": "cylindrical"}, "hand_tcp_cylindrical")
    block = {"type": "block", "grid": [1, 2], "spacing": [0.09, 0.2]}
    raw["trays"] = [raw["trays"][0] | {"parts": block, "targets": [0]}]
    raw["part_types"]["block"] = {"box": [0.04, 0.09, 0.07]}
    plan = plan_part_supply(mg.load_scenario(written(folder, raw)))
    assert plan.outcome == mg.Outcome.solved
    return Path(plan.save(folder / "plan.json"))


def test_a_part_beside_one_side_is_not_held(tmp_path: Path) -> None:
    """Two of three fingertips meet the box, 30 mm from the thumb's pad: both are of one side."""
    path = written(tmp_path, with_hand(OMNI, PINCH | {"type": "cylindrical"}, "hand_tcp_cylindrical"))
    setup = mg.load_scenario(path).setup
    hand = setup.gripper
    for side in (-1, 1):
        box = [mg.LinkShape(mg.Box([0.02, 0.1, 0.05]), mg.pose(side * 0.02 * hand.closing))]
        assert mg.grasping.fingers_meet(setup.arm, hand, box, [mg.Grasp(np.eye(4), 0.04)]) == [False]
    both = [mg.LinkShape(mg.Box([0.04, 0.1, 0.05]))]
    assert mg.grasping.fingers_meet(setup.arm, hand, both, [mg.Grasp(np.eye(4), 0.04)]) == [True]


def own_profile(kind: str = "cylindrical", **changes: Any) -> dict[str, Any]:
    """The shipped section written out for the mounted hand, with one type: two fingers and thumb as given."""
    text = (ASSETS / "grippers" / "sdhlike" / "sdhlike.yaml").read_text()
    names = re.sub(r"\b((thumb|finger_[12])_(proximal|distal)|spread(?=: \d)|(?<=\[)spread)\b", r"hand_\1", text)
    section: dict[str, Any] = yaml.safe_load(names)["gripper"]
    ends = section["types"][kind]
    ends["open"] |= changes.get("open", {})
    ends["closed"] |= changes.get("closed", {})
    return {"approach": [0, 0, 1], "groups": section["groups"], "types": {"own": ends}}


def all_fingers(proximal: float) -> dict[str, float]:
    """Values of all fingers at which their tips stay upright."""
    return {
        f"hand_{k}_{j}": s * proximal
        for k in ("thumb", "finger_1", "finger_2")
        for j, s in (("proximal", 1), ("distal", -1))
    }


def test_a_type_that_closes_past_contact_closes_until_its_fingers_meet(tmp_path: Path) -> None:
    """The pads' distance by forward kinematics is the opening, from where they touch on."""
    tool = "hand_tcp_cylindrical"
    section = own_profile(closed=all_fingers(0.4))
    setup = mg.load_scenario(written(tmp_path, with_hand(OMNI, section, tool))).setup
    hand = setup.gripper
    assert hand.min_opening < 1e-6
    for opening in np.linspace(0, hand.max_opening, 9):
        thumb, finger = (
            tip_middle(setup.robot, hand.joint_values(opening), tool, name) @ hand.closing
            for name in ("thumb", "finger_1")
        )
        assert abs(thumb - finger) - 0.024 == pytest.approx(opening, abs=3e-4)


def test_sides_that_do_not_close_alike_are_refused(tmp_path: Path) -> None:
    section = own_profile(open={"hand_thumb_proximal": 0.15, "hand_thumb_distal": -0.15})
    with pytest.raises(mg.InvalidInput, match=r"the middle of the pads of own moves by 0\.\d+ m while they close"):
        mg.load_scenario(written(tmp_path, with_hand(OMNI, section, "hand_tcp_cylindrical")))


def test_a_still_group_may_be_called_fingers(tmp_path: Path) -> None:
    section = own_profile()
    section["groups"]["fingers"] = section["groups"].pop("spread")
    setup = mg.load_scenario(written(tmp_path, with_hand(OMNI, section, "hand_tcp_cylindrical"))).setup
    assert len(setup.gripper.groups) == 2 and list(setup.gripper.preshape) == ["fingers"]


@pytest.mark.slow
def test_grasps_of_a_map_for_the_hand_of_a_scenario(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`mmgrasp grasp` takes the type that the scenario chose, its own section or a profile's."""
    write_frames(tmp_path / "frames", "npz", 18)
    write_sensors(tmp_path / "frames")
    assert run(tmp_path / "frames", tmp_path / "map", "--voxel", "0.003") == 0
    for section in (PINCH, own_profile("pinch") | {"type": "own", "clearance": 0.012}):
        path = written(tmp_path, with_hand(OMNI, section, "hand_tcp_pinch"))
        capsys.readouterr()
        assert main(["grasp", str(tmp_path / "map"), "--gripper", str(path), "--samples", "400", "--json"]) == 0
        found = json.loads(capsys.readouterr().out)["objects"]
        kinds = {grasp["type"] for thing in found for grasp in thing["grasps"]}
        assert kinds == {section["type"]}


@pytest.mark.parametrize(
    ("change", "line", "said"),
    [
        ({"format": "nonsense"}, 1, "format = 'nonsense': must be one of mmgrasp-robot"),
        ({"gripper.clearence": 3}, 0, "unknown key.*did you mean clearance"),
        ({"gripper.approach": None}, 0, "approach is missing"),
        ({"gripper.types.pinch.open.spread": 9.0}, 0, r"gripper.types.pinch.open.spread"),
    ],
)
def test_a_bad_profile_is_told_where_it_is_named(change: dict[str, Any], line: int, said: str, tmp_path: Path) -> None:
    profile = yaml.safe_load((ASSETS / "grippers" / "sdhlike" / "sdhlike.yaml").read_text())
    for name, value in change.items():
        *keys, last = name.split(".")
        at = profile
        for key in keys:
            at = at[key]
        at[last] = value
        if value is None:
            del at[last]
    (tmp_path / "own.yaml").write_text(yaml.safe_dump(profile, sort_keys=False))
    path = written(tmp_path, with_hand(OMNI, PINCH | {"name": "own.yaml"}, "hand_tcp_pinch"))
    with pytest.raises(mg.InvalidInput, match=said) as caught:
        mg.load_scenario(path)
    places = re.findall(r"(\w+\.yaml):(\d+)", str(caught.value))
    assert [name for name, _ in places] == ["hand.yaml", "own.yaml"]
    assert yaml.safe_load(path.read_text().splitlines()[int(places[0][1]) - 1]) == {"name": "own.yaml"}
    assert not line or int(places[1][1]) == line


@pytest.mark.slow
def test_a_scanned_tray_is_emptied(tmp_path: Path) -> None:
    plan = plan_part_supply(mg.load_scenario(written(tmp_path, with_hand(SCANNED, PINCH, "hand_tcp_pinch"))))
    assert plan.outcome == mg.Outcome.solved, plan
    verdict = mg.verify_plan(plan.save(tmp_path / "plan.json"), samples=100)
    assert verdict.ok, verdict.faults


@pytest.mark.parametrize(
    ("gripper", "tool", "said"),
    [
        ({"type": None}, "hand_tcp_pinch", "gripper: type is missing.*one of pinch, cylindrical, spherical"),
        ({"type": "pich"}, "hand_tcp_pinch", r"gripper.type = 'pich': must be one of pinch, cylindrical, spherical"),
        ({"type": "spherical"}, "hand_tcp", "closes from all around .a pad pushes at 60 degrees"),
        ({}, "hand_tcp", r"the pads of pinch close around \[0.0191, 0.0000, -0.0005\] m in hand_tcp"),
        ({"name": "paralel"}, "hand_tcp_pinch", "no such robot or gripper"),
        ({"name": "tiago"}, "hand_tcp_pinch", "has no types of grasp"),
        ({"name": "none.yaml"}, "hand_tcp_pinch", r"none.yaml': no such file"),
        ({"prefix": "han_"}, "hand_tcp_pinch", "no movable joint han_thumb_proximal.*did you mean hand_thumb"),
        ({"clearance": -0.001}, "hand_tcp_pinch", "gripper.clearance = -0.001"),
        ({"clearance": 0.2}, "hand_tcp_pinch", "gripper.clearance = 0.2: must be at most 0.05453 m"),
        ({"payload": 0}, "hand_tcp_pinch", "gripper.payload"),
        ({"finger_depth": 0.02}, "hand_tcp_pinch", "finger_depth"),
    ],
)
def test_a_hand_that_does_not_fit_is_refused_at_its_line(
    gripper: dict[str, Any], tool: str, said: str, tmp_path: Path
) -> None:
    section = {key: value for key, value in (PINCH | gripper).items() if value is not None}
    path = written(tmp_path, with_hand(OMNI, section, tool))
    with pytest.raises(mg.InvalidInput, match=said) as caught:
        mg.load_scenario(path)
    assert re.match(r".*/hand\.yaml:\d+: gripper", str(caught.value))


def test_the_frame_that_is_proposed_is_taken(tmp_path: Path) -> None:
    raw = with_hand(OMNI, PINCH, "hand_tcp")
    with pytest.raises(mg.InvalidInput) as caught:
        mg.load_scenario(written(tmp_path, raw))
    proposed = re.search(r"add (\{.*\}) to robot.frames", str(caught.value))
    assert proposed
    raw["robot"] |= {"frames": [yaml.safe_load(proposed[1])], "tool_link": "pads"}
    raw["robot"]["group"]["tip_link"] = "pads"
    assert mg.load_scenario(written(tmp_path, raw)).setup.gripper.tool_link == "pads"


def test_groups_and_types_may_be_written_out(tmp_path: Path) -> None:
    """The profile's own section with one type alone, and limits of its own."""
    profile = yaml.safe_load((ASSETS / "grippers" / "sdhlike" / "sdhlike.yaml").read_text())["gripper"]
    text = yaml.safe_dump({"groups": profile["groups"], "types": {"pinch": profile["types"]["pinch"]}})
    own = yaml.safe_load(
        re.sub(r"\b((thumb|finger_[12])_(proximal|distal)|spread(?=: [\d])|(?<=- )spread)\b", r"hand_\1", text)
    )
    section = own | {"approach": [0, 0, 1], "clearance": 0.004, "payload": 1.5}
    schema = json.loads((ASSETS.parent / "schemas" / "scenario.schema.json").read_text())
    for gripper in (section, PINCH):
        jsonschema.validate(with_hand(OMNI, gripper, "hand_tcp_pinch"), schema)
    hand = mg.load_scenario(written(tmp_path, with_hand(OMNI, section, "hand_tcp_pinch"))).setup.gripper
    assert (hand.clearance, hand.payload) == (0.004, 1.5)
    named = mg.load_scenario(written(tmp_path, with_hand(OMNI, PINCH, "hand_tcp_pinch"))).setup.gripper
    assert hand.openings == named.openings and hand.finger_links == named.finger_links


def test_a_joint_of_the_arm_is_no_joint_of_the_hand(tmp_path: Path) -> None:
    raw = with_hand(OMNI, PINCH, "hand_tcp_pinch")
    raw["robot"]["joints"] = {"hand_spread": 1.0}
    with pytest.raises(mg.InvalidInput, match="hand_spread is a joint of the gripper"):
        mg.load_scenario(written(tmp_path, raw))
