"""The report's segments to click: what is embedded, and what a click finds, run by node where it is there."""

from __future__ import annotations

import base64
import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp.grippers import load_assembly, plan_grippers
from mmgrasp.grippers.assembly_file import shipped_assembly
from mmgrasp.grippers.planning import GripperPlan
from mmgrasp.viz.gripper_report import gripper_report_html
from mmgrasp.viz.segment_picker import SCRIPT, picker_data

VIEWS = [
    {"yaw": 0.6, "pitch": 0.5, "zoom": 0.9},
    {"yaw": -2.0, "pitch": -0.7, "zoom": 1.4},
    {"yaw": 0.0, "pitch": 1.57, "zoom": 0.8},
]


@pytest.fixture(scope="module")
def plan() -> GripperPlan:
    assembly = load_assembly("pulley")
    assembly.parts["pulley"].keep_off = [mg.gripper_design.KeepOff("pulley", segments=[1])]
    return plan_grippers(replace(assembly, steps=assembly.steps[:4]))


def node(script: str) -> str:
    program = shutil.which("node")
    if program is None:
        pytest.skip("node is not there")
    run = subprocess.run([program, "-e", script], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout


def embedded(page: str) -> list[dict[str, Any]]:
    found = re.search(r'<script type="application/json" id="picker-data">(.*?)</script>', page, re.DOTALL)
    assert found
    return list(json.loads(found.group(1)))


def array(text: str, kind: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), kind)


def test_the_page_holds_each_part_and_needs_no_network(plan: GripperPlan) -> None:
    page = gripper_report_html(plan, None)
    parts = embedded(page)
    assert [part["name"] for part in parts] == list(plan.segmentations)
    for part in parts:
        mesh = plan.assembly.parts[part["name"]].mesh
        assert array(part["vertices"], "<f4").reshape(-1, 3) == pytest.approx(np.asarray(mesh.vertices), abs=1e-7)
        assert (array(part["triangles"], "<u4").reshape(-1, 3) == np.asarray(mesh.triangles)).all()
        labels = plan.segmentations[part["name"]].labels
        assert (array(part["labels"], "<u4") == np.asarray(labels)).all()
        assert part["names"] == plan.segment_names[part["name"]]
        assert len(part["colours"]) == len(part["segments"]) == len(plan.segmentations[part["name"]].segments)
    assert [part["keep_off"] for part in parts if part["name"] == "pulley"] == [[1]]
    assert SCRIPT.read_text() in page
    assert not re.search(r"""(src|href)=["']https?:|fetch\(|import\(""", page)


def test_names_cannot_end_the_script(plan: GripperPlan) -> None:
    evil = "</script><b>"
    other = replace(plan, segmentations={evil: plan.segmentations["base"]}, primitives={evil: plan.primitives["base"]})
    other.assembly = replace(plan.assembly, parts={**plan.assembly.parts, evil: plan.assembly.parts["base"]})
    assert embedded(gripper_report_html(replace(other, fates=[]), None))[0]["name"] == evil


def test_a_click_finds_the_segment_that_the_ray_caster_finds(plan: GripperPlan) -> None:
    points = [(x, y) for x in np.linspace(-0.83, 0.85, 15).tolist() for y in np.linspace(-0.81, 0.87, 15).tolist()]
    script = f"""
        const p = require({json.dumps(str(SCRIPT))});
        const parts = {json.dumps(picker_data(plan))}.map(p.readPart), out = [];
        for (const part of parts) for (const view of {json.dumps(VIEWS)}) for (const [x, y] of {json.dumps(points)}) {{
            const ray = p.viewRay(part, view, x, y);
            out.push([ray.origin, ray.direction, p.pickSegment(part, view, x, y)]);
        }}
        console.log(JSON.stringify(out));"""
    found = json.loads(node(script))
    hits = 0
    for index, name in enumerate(plan.segmentations):
        rows = found[index * len(VIEWS) * len(points) : (index + 1) * len(VIEWS) * len(points)]
        mesh, labels = plan.assembly.parts[name].mesh, np.asarray(plan.segmentations[name].labels)
        for origin, direction, segment in rows:
            expected = nearest(mesh, np.array(origin), np.array(direction))
            if len(expected) == 0:
                assert segment == -1
            elif len(set(labels[expected])) == 1:  # on an edge either side will do
                assert segment == labels[expected[0]]
                hits += 1
    assert hits > 800


def nearest(mesh: mg.Mesh, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Triangles where a line from outside first meets the surface, by the plane of each and areas in it."""
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = normals @ direction
    at = np.einsum("ij,ij->i", corners[:, 0] - origin, normals) / np.where(np.abs(facing) > 1e-15, facing, np.nan)
    hit = origin + at[:, None] * direction
    inside = np.ones(len(corners), dtype=bool)
    for k in range(3):
        edge = corners[:, (k + 1) % 3] - corners[:, k]
        inside &= np.einsum("ij,ij->i", np.cross(edge, hit - corners[:, k]), normals) >= -1e-13
    inside &= ~np.isnan(at)
    if not inside.any():
        return np.array([], dtype=int)
    return np.flatnonzero(inside & (at <= at[inside].min() + 1e-6))


def test_the_lines_of_two_clicks_are_read_as_keep_off(plan: GripperPlan, tmp_path: Path) -> None:
    script = f"""
        const p = require({json.dumps(str(SCRIPT))});
        const parts = {json.dumps(picker_data(plan))}.map(p.readPart);
        const pulley = parts.find(part => part.name === 'pulley'), shaft = parts.find(part => part.name === 'shaft');
        p.toggle(pulley, 0); p.toggle(shaft, 1); p.toggle(shaft, 0); p.toggle(shaft, 1);
        console.log(p.yamlLines(parts));"""
    chosen = {part["name"]: part["keep_off"] for part in yaml.safe_load("parts:\n" + node(script))["parts"]}
    names = plan.segment_names
    assert chosen == {"pulley": names["pulley"][:2], "shaft": names["shaft"][:1]}
    content = yaml.safe_load(shipped_assembly("pulley").read_text())
    for part in content["parts"]:
        part.update({"keep_off": chosen[part["name"]]} if part["name"] in chosen else {})
    file = tmp_path / "assembly.yaml"
    file.write_text(yaml.safe_dump(content))
    read = load_assembly(file)
    assert {
        name: [n for k in part.keep_off for n in k.names] for name, part in read.parts.items() if part.keep_off
    } == chosen


@pytest.mark.parametrize("unit", ["mm", "inch"])
def test_the_lines_keep_boxes_that_the_file_has(tmp_path: Path, unit: str) -> None:
    """Pasted over what the file has, nothing that was forbidden may be touched."""
    content = yaml.safe_load(shipped_assembly("pulley").read_text())
    scale = {"mm": 1.0, "inch": 1 / 25.4}[unit]
    tilted = {"xyz": [scale * 1e-5, -scale * 2, scale * 22], "rpy": [0.1, -0.2, 3.0]}
    upright = {"box": [scale * 50, scale * 50, scale * 3], "pose": {"xyz": [0, 0, scale * 11]}}
    boxes: list[Any] = [{"box": [scale * 70, scale * 70, scale * 4], "pose": tilted}, {"box": [scale * 72] * 3}]
    given = {"pulley": [1, *boxes], "sleeve": [upright], "shaft": [0]}
    content["unit"] = unit
    for part in content["parts"]:
        for key in ("box", "turned"):
            if key in part:
                part[key] = (scale * np.array(part[key])).tolist()
        if "pose" in part:
            part["pose"]["xyz"] = (scale * np.array(part["pose"]["xyz"])).tolist()
        if part["name"] in given:
            part["keep_off"] = given[part["name"]]
    content.pop("fingers")
    content["order"] = [{"part": name} for name in ("base", "shaft", "sleeve", "pulley")]
    file = tmp_path / "assembly.yaml"
    file.write_text(yaml.safe_dump(content))
    before = plan_grippers(load_assembly(file))
    script = f"""
        const p = require({json.dumps(str(SCRIPT))});
        const parts = {json.dumps(picker_data(before))}.map(p.readPart);
        p.toggle(parts.find(part => part.name === 'pulley'), 0); p.toggle(parts.find(part => part.name === 'shaft'), 0);
        console.log(p.yamlLines(parts));"""
    pasted = {part["name"]: part["keep_off"] for part in yaml.safe_load("parts:\n" + node(script))["parts"]}
    assert set(pasted) == set(given) and pasted["shaft"] == []
    for part in content["parts"]:
        part.update({"keep_off": pasted[part["name"]]} if part["name"] in pasted else {})
    file.write_text(yaml.safe_dump(content))
    after = load_assembly(file).parts
    assert [n for k in after["pulley"].keep_off for n in k.names] == before.segment_names["pulley"][:2]
    assert after["shaft"].keep_off == []
    for name in given:
        old = [box for k in before.assembly.parts[name].keep_off for box in k.boxes]
        new = [box for k in after[name].keep_off for box in k.boxes]
        assert len(old) == len(new) == sum(isinstance(k, dict) for k in given[name])
        for (T, size), (T_new, size_new) in zip(old, new, strict=True):
            assert T_new == pytest.approx(T, abs=1e-10) and size_new == pytest.approx(size, abs=1e-12)
