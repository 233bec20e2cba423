"""Which sources a stored result was made from: a hash goes with it, and the page names results that are older than theirs.

Chapters 4 and 5 of P1 and 4 of P3 so far. What the library beneath it (collisions, kinematics) gives is held by tests of its own and does not count.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from .._core import IoError
from ..documents.reading import read_json

_TRAJOPT = (
    "cpp/src/trajopt", "cpp/include/mmgrasp/trajopt", "cpp/src/task/drive_by", "cpp/include/mmgrasp/task/drive_by.hpp",
    "cpp/src/optim/nlp", "cpp/src/optim/sparse", "python/mmgrasp/reproduce/drive_by.py",
    "python/mmgrasp/reproduce/nearest_state.py",
)  # fmt: skip
_SIM = (*_TRAJOPT, "cpp/src/control", "cpp/src/grasp/push", "python/mmgrasp/sim", "python/mmgrasp/reproduce/physics.py")
_LINE = (
    "cpp/src/grasp/success/line_grasp.cpp",
    "cpp/include/mmgrasp/grasp/line_grasp.hpp",
    "python/mmgrasp/reproduce/grasp_success.py",
)
_MAPS = (
    "cpp/src/mapping/sdf", "cpp/src/mapping/render_depth.cpp", "cpp/include/mmgrasp/mapping/depth_camera.hpp",
    "cpp/include/mmgrasp/mapping/probabilistic_sdf.hpp",
)  # fmt: skip
_SYNTHESIS = (
    *_MAPS, "cpp/src/grasp/hand/hand_model.cpp", "cpp/src/grasp/success", "cpp/src/grasp/synthesis",
    "cpp/include/mmgrasp/grasp/contact_patch.hpp",
    "cpp/include/mmgrasp/grasp/success_model.hpp", "cpp/include/mmgrasp/grasp/surface_draws.hpp",
    "cpp/include/mmgrasp/grasp/synthesize_grasps.hpp", "python/mmgrasp/reproduce/grasp_success.py",
)  # fmt: skip
_SURFACES = (
    *_SYNTHESIS, "python/mmgrasp/reproduce/surface_view.py", "python/mmgrasp/reproduce/uncertain_surfaces.py",
)  # fmt: skip
_TRIALS = (
    *_SYNTHESIS, "cpp/src/mapping/height_map.cpp", "cpp/src/grasp/graspability",
    "cpp/include/mmgrasp/grasp/graspability.hpp",
    "python/mmgrasp/sim/model.py", "python/mmgrasp/sim/pick_trial.py", "python/mmgrasp/sim/scene.py",
    "python/mmgrasp/reproduce/grasping_trials.py", "python/mmgrasp/reproduce/height_features.py",
    "python/mmgrasp/reproduce/unknown_objects.py",
)  # fmt: skip
_SEGMENTS = (
    "cpp/src/geometry/segmentation",
    "python/mmgrasp/grippers/motor.py",
    "python/mmgrasp/reproduce/segmentation.py",
)
_LEAST_SET = ("cpp/src/gripper_design", "python/mmgrasp/reproduce/gripper_sets.py")
_DESIGN = (
    *_LEAST_SET, "cpp/src/geometry/segmentation", "cpp/src/grasp/assembly", "python/mmgrasp/grippers",
    "python/mmgrasp/reproduce/gripper_assembly.py",
)  # fmt: skip
SOURCES: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(
        ("p1-figure-4.3", "p1-figure-4.4", "p1-figure-4.5", "p1-figure-4.6", "p1-figure-4.13"),
        _TRAJOPT,
    ),
    "p1-figure-4.9": ("cpp/src/control", "python/mmgrasp/reproduce/tracking.py"),
    "p1-figure-4.10": _SIM,
    "p1-figure-4.12": _SIM,
    "p1-table-3.5-drive-by": (*_TRAJOPT, "cpp/src/task/part_supply", "python/mmgrasp/reproduce/three_ways.py"),
    **dict.fromkeys(("p1-figure-5.2", "p1-figure-5.4", "p1-figure-5.7"), _SEGMENTS),
    **dict.fromkeys(("p1-figure-5.13", "p1-gripper-growth"), _LEAST_SET),
    **dict.fromkeys(("p1-figure-5.14", "p1-figure-5.16"), _DESIGN),
    "p3-figure-4.6": _LINE,
    **dict.fromkeys(("p3-figure-4.15", "p3-figure-4.18", "p3-figure-4.19"), _SURFACES),
    "p3-figure-4.21": _SYNTHESIS,
    **dict.fromkeys(("p3-table-4.1", "p3-table-4.1-rough", "p3-table-4.2"), _TRIALS),
}
"""Folders and files of the repository, by result."""


def sources_hash(name: str, repository: Path) -> str | None:
    """Over the names and contents of all files that a result depends on; None where that is not kept, or not in a repository."""
    if name not in SOURCES or not (repository / "layers.toml").is_file():
        return None
    whole = hashlib.sha256()
    for place in SOURCES[name]:
        path = repository / place
        files = sorted(p for p in path.rglob("*") if p.suffix in (".cpp", ".hpp", ".py")) if path.is_dir() else [path]
        for file in files:
            whole.update(str(file.relative_to(repository).as_posix()).encode() + b"\0")
            whole.update(file.read_bytes() + b"\0")
    return whole.hexdigest()


def stored_result(path: Path) -> dict[str, Any]:
    """A result that `reproduce` wrote; raises IoError for any other file under its name."""
    content = read_json(path).raw
    known = isinstance(content, dict) and {"name", "title", "rows", "checks", "seed"} <= content.keys()
    if not known or not isinstance(content["checks"], list):
        raise IoError(f"{path}: is no result of mmgrasp reproduce: remove it, or choose another folder")
    return dict(content)


def is_stale(result: dict[str, Any], repository: Path) -> bool:
    """Whether a stored result was made from other sources than those that are there; where none are kept, it is not said."""
    now = sources_hash(result["name"], repository)
    return now is not None and result.get("sources") != now


def stale_results(folder: Path, repository: Path) -> list[str]:
    """Names of the stored results that are older than their sources, in the order of the table above."""
    stored = {name: folder / f"{name}.json" for name in SOURCES}
    return [n for n, p in stored.items() if p.is_file() and is_stale(stored_result(p), repository)]
