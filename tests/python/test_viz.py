"""Pictures and report of a plan written by hand: what they show is known."""

import re
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from plan_by_hand import plan_by_hand

pytest.importorskip("mmgrasp")

from mmgrasp.bodies import SceneBodies, stored_pose
from mmgrasp.documents.reading import Document
from mmgrasp.part_supply.plan_file import check_form, check_names, plan_schema
from mmgrasp.scenario.schema import NOTES, WORDS
from mmgrasp.viz import png, raster, report, topview
from mmgrasp.viz.film import SECONDS_PER_FRAME, write_film
from mmgrasp.viz.scene import PlanScene
from mmgrasp.viz.timeline import GRIP_TIME, State, Timeline, along_route


def re_edges(path: str) -> list[list[float]]:
    """Numbers of each line in an SVG path of separate lines."""
    return [[float(v) for v in re.findall(r"[-\d.]+", piece)] for piece in path.split("M")[1:]]


def decode_png(data: bytes) -> np.ndarray:
    """Reads back an 8-bit RGB PNG whose rows are unfiltered."""
    width, height = struct.unpack(">II", data[16:24])
    position, body = 8, b""
    while position < len(data):
        (size,) = struct.unpack(">I", data[position : position + 4])
        if data[position + 4 : position + 8] == b"IDAT":
            body += data[position + 8 : position + 8 + size]
        position += 12 + size
    rows = np.frombuffer(zlib.decompress(body), np.uint8).reshape(height, 1 + 3 * width)
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, 3)


def test_png_round_trip() -> None:
    image = np.random.default_rng(1).integers(0, 255, (7, 5, 3), dtype=np.uint8)
    assert np.array_equal(decode_png(png.png_bytes(image)), image)


def test_png_refuses_other_arrays() -> None:
    with pytest.raises(ValueError, match="uint8"):
        png.png_bytes(np.zeros((4, 4, 3)))


def test_camera_projects_the_target_to_the_middle_and_halves_size_at_twice_the_distance() -> None:
    camera = raster.Camera(np.array([0.0, -2.0, 0.0]), np.zeros(3), width=200, height=100, fov=90)
    middle, near, far = camera.project(np.array([[0.0, 0, 0], [1.0, 0, 0], [1.0, 2.0, 0]]))
    assert middle == pytest.approx([100, 50, 2])
    assert near[0] - 100 == pytest.approx(50 / np.tan(np.pi / 4) * 1 / 2)
    assert far[0] - 100 == pytest.approx((near[0] - 100) / 2)


def test_renderer_shows_the_nearer_of_two_squares() -> None:
    square = np.array([[-1.0, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    scene = raster.Scene()
    scene.add(square, faces, "#FF0000")
    scene.add(square + [0, 1.0, 0], faces, "#0000FF")
    camera = raster.Camera(np.array([0.0, -3.0, 0.0]), np.zeros(3), 60, 60, 60)
    middle = raster.render(scene, camera)[30, 30]
    assert middle[0] > 100 and middle[2] == 0
    behind = raster.Camera(np.array([0.0, 5.0, 0.0]), np.zeros(3), 60, 60, 60)
    middle = raster.render(scene, behind)[30, 30]
    assert middle[2] > 100 and middle[0] == 0


def test_timeline_adds_up_and_knows_where_things_are() -> None:
    timeline = Timeline(plan_by_hand())
    assert timeline.duration == pytest.approx(4.0 + 2 * (7.5 + 2 * GRIP_TIME) + 5.0)
    assert timeline.state_at(0).base == pytest.approx([0.3, 0.3, 0.0])
    assert timeline.state_at(1e9).base == pytest.approx([2.5, 0.3, 0.0])
    reach_half = timeline.state_at(4.0 + 1.0)
    assert reach_half.arm == pytest.approx([0.2, 0.25]) and reach_half.attached is None
    lifting = timeline.state_at(4.0 + 3.0 + GRIP_TIME + 0.5)
    assert lifting.attached is not None and lifting.attached[0] == "A/brick_0"
    assert timeline.state_at(timeline.duration).removed == {"A/brick_0", "B & C/brick_0"}
    times = timeline.grasp_times()
    assert [row for row, _ in times] == [0, 0] and [time for _, time in times] == pytest.approx([7.0, 15.5])


def test_along_route_turns_then_drives() -> None:
    poses = np.array([[0, 0, 0], [0, 0, 1.0], [1.0, 0, 1.0]])
    assert along_route(poses, 0.25) == pytest.approx([0, 0, 0.5])
    assert along_route(poses, 0.75) == pytest.approx([0.5, 0, 1.0])
    assert along_route(poses, 1.0) == pytest.approx([1, 0, 1])


def test_scene_places_the_tool_by_closed_form_and_the_held_part_in_it() -> None:
    scene = PlanScene(plan_by_hand())
    state = State(np.array([1.0, 2.0, np.pi / 2]), np.array([0.2, 0.5]), 0.0)
    T = scene.robot_poses(state)["tcp"]
    angle = np.pi / 2 + 0.5
    assert T[:3, 3] == pytest.approx([1 + 0.7 * np.cos(angle), 2 + 0.7 * np.sin(angle), 0.3 + 0.2 + 0.4])
    held = State(state.base, state.arm, 0.0, ("A/brick_0", np.eye(4)))
    assert scene.part_pose("A/brick_0", held, scene.robot_poses(held)) == pytest.approx(T)
    assert scene.arm_links == {"arm", "tcp"}


def test_bodies_stand_where_world_and_plan_have_them() -> None:
    world = mg.World()
    world.add_box("shelf", [0.4, 0.2, 0.6], mg.pose([1.0, 2.0, 0.3], rpy=[0, 0, np.pi / 2]))
    plan = plan_by_hand()
    stored = SceneBodies.of_plan(plan)
    (shelf,) = SceneBodies.of_world(stored.robot, world).obstacles
    at = shelf.vertices_at()
    assert at.min(axis=0) == pytest.approx([0.9, 1.8, 0.0]) and at.max(axis=0) == pytest.approx([1.1, 2.2, 0.6])
    assert [body.name for body in stored.obstacles] == [o["name"] for o in plan["scenario"]["obstacles"]]
    for part in plan["scenario"]["parts"]:
        assert stored.parts[part["name"]].pose[:3, 3] == pytest.approx(part["pose"]["xyz"])
    assert [link.name for link in stored.links] == stored.robot.links


def test_poses_of_plan_files_may_be_given_either_way() -> None:
    turned = mg.pose([1, 2, 3], rpy=[0.1, 0.2, 0.3])
    quaternion = mg.robot.quat_xyzw_from_rotation(turned[:3, :3])
    assert stored_pose({"xyz": [1, 2, 3], "quat_xyzw": quaternion}) == pytest.approx(turned)
    assert stored_pose({"xyz": [1, 2, 3], "rpy": [0.1, 0.2, 0.3]}) == pytest.approx(turned)
    assert stored_pose({"xyz": [1, 2, 3]}) == pytest.approx(mg.pose([1, 2, 3]))


def test_top_view_draws_every_cell_stop_and_name() -> None:
    svg = topview.TopView(plan_by_hand()).svg()
    assert re.findall(r'data-tray="([^"]*)" data-cells="(\d+)"', svg) == [("A", "80"), ("B &amp; C", "64")]
    assert svg.count('class="disc"') == 1 and svg.count('class="route"') == 2
    disc = re.search(r'r="([\d.]+)" class="disc"', svg)
    assert disc and float(disc[1]) == pytest.approx(0.2 * topview.SCALE, abs=0.1)
    assert "nan" not in svg.lower()
    shared = re.search(r'<path d="([^"]*)" class="intersection"><title>shared by trays A, B &amp; C: 48 cells', svg)
    # The regions share x from 0.6 to 1.4 and y from 0.8 to 1.4: a rectangle, four joined edges.
    assert shared and shared[1].count("M") == 4
    lengths = [np.hypot(c - a, d - b) for a, b, c, d in re_edges(shared[1])]
    assert sorted(lengths) == pytest.approx([0.6 * topview.SCALE] * 2 + [0.8 * topview.SCALE] * 2, abs=0.2)


def test_footprint_of_a_turned_box_is_its_outline() -> None:
    quarter = {"xyz": [1.0, 2.0, 0.0], "quat_xyzw": [0, 0, np.sin(np.pi / 4), np.cos(np.pi / 4)]}
    (outline,) = topview.footprint([{"type": "box", "size": [0.4, 0.2, 1.0], "pose": quarter}], quarter)
    # Turned twice by 90 degrees: x stays along x; the shape's own offset is turned by the body's.
    assert outline.max(axis=0) - outline.min(axis=0) == pytest.approx([0.4, 0.2])
    assert outline.mean(axis=0) == pytest.approx([1.0 - 2.0, 2.0 + 1.0])


def test_report_tells_the_plan_and_needs_nothing_from_outside(tmp_path: Path) -> None:
    page = report.write_report(plan_by_hand(), tmp_path).read_text()
    assert "1 stop serves 2 trays: 2 parts in 26.0 s" in page
    assert not re.search(r'(?:src|href)="(?!data:)', page)
    assert "B &amp; C" in page and "24 of 60" in page
    assert [p.name for p in tmp_path.iterdir()] == ["report.html"]


def test_report_of_no_plan_names_the_tray_and_the_advice() -> None:
    plan = plan_by_hand()
    plan.update(outcome="not_found", stops=[], route=[], picks=[])
    plan["obstructions"] = [{"tray": "A", "part": "A/brick_0", "stage": "robustness", "message": "no disc of 0.500 m fits",
                             "largest_uncertainty": 0.21, "reach_deficit": 0.0}]  # fmt: skip
    page = report.report_html(plan)
    assert "Tray A, part A/brick_0" in page and "no disc of 0.500 m fits" in page and "0.210 m" in page


@pytest.mark.slow
def test_pictures_show_regions_in_the_tray_colours(tmp_path: Path) -> None:
    from PIL import Image

    from mmgrasp.viz import pictures

    paths = pictures.write_pictures(plan_by_hand(), tmp_path)
    assert [p.name for p in paths] == ["topview.png", "regions.png", "stop_1.png", "pick_1_joints.png"]
    regions = np.asarray(Image.open(tmp_path / "regions.png").convert("RGB")).reshape(-1, 3).astype(int)
    blue = (regions[:, 2] > regions[:, 0] + 60).mean()
    orange = (regions[:, 0] > regions[:, 2] + 60).mean()
    assert blue > 0.01 and orange > 0.01
    robot = decode_png((tmp_path / "stop_1.png").read_bytes()).astype(int)
    arm_like = (robot[..., 2] - robot[..., 0] > 30).mean()
    assert arm_like > 0.002


def test_the_plan_by_hand_has_the_schemas_form() -> None:
    root = Document("plan", plan_by_hand(), {}).root
    check_form(root)
    check_names(root)
    breakings: list[tuple[Callable[[dict[str, Any]], None], str]] = [
        (lambda p: p["picks"][0].update(part="C/block_00"), "no such part"),
        (lambda p: p["picks"][0].update(stop=7), "no such stop"),
        (lambda p: p["stops"][0].update(intersection=7), "no such intersection"),
        (lambda p: p["regions"][0].update(tray="X"), "no such tray"),
        (lambda p: p["stops"][0].update(trays=["X"]), "no such tray"),
    ]
    for breaking, piece in breakings:
        plan = plan_by_hand()
        breaking(plan)
        with pytest.raises(mg.InvalidInput, match=piece):
            check_names(Document("plan", plan, {}).root)


def words_of(schema: dict[str, Any]) -> set[str]:
    """The words of a schema and of all schemas in it."""
    below = [s for key in ("properties", "patternProperties", "$defs") for s in schema.get(key, {}).values()]
    below += schema.get("oneOf", [])
    below += [schema[key] for key in ("items", "additionalProperties") if isinstance(schema.get(key), dict)]
    return set(schema).union(*(words_of(s) for s in below))


def test_every_word_of_the_plans_schema_is_applied() -> None:
    assert words_of(plan_schema()) <= WORDS | NOTES


def test_a_film_follows_the_robot(tmp_path: Path) -> None:
    """Its pictures are those of the plan's states at even times, seen from one direction; the robot stays in their middle."""
    from PIL import Image, ImageSequence

    plan = plan_by_hand()
    seen: list[float] = []
    file = write_film(plan, tmp_path / "round.gif", frames=4, progress=lambda _, share: seen.append(share))
    assert seen == [0, 0.25, 0.5, 0.75]
    with Image.open(file) as film:
        assert film.info["duration"] == pytest.approx(1000 * SECONDS_PER_FRAME)
        pictures = [np.asarray(frame.convert("RGB"), dtype=float) for frame in ImageSequence.Iterator(film)]
    assert len(pictures) == 4
    assert np.abs(pictures[0] - pictures[1]).max() > 50  # something moved
    height, width, _ = pictures[0].shape
    floor = pictures[0][-2, width // 2]
    for picture in pictures:
        middle = picture[height // 2 - 30 : height // 2 + 30, width // 2 - 20 : width // 2 + 20]
        assert np.abs(middle - floor).max() > 30  # the robot, not the floor
    with pytest.raises(mg.InvalidInput, match="no motions"):
        write_film(plan | {"route": [], "picks": [], "stops": []}, tmp_path / "none.gif")
    assert not (tmp_path / "none.gif").exists()
