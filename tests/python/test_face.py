"""The face of the package: a small root, every other name in one room, and no module that imports in a circle."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
import types
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import mmgrasp as mg
from conftest import REPOSITORY
from mmgrasp import _core, _moved

PACKAGE = Path(mg.__file__).parent
ROOT = {
    *("__version__", "Error", "InvalidInput", "IoError", "Outcome", "pose"),
    *("Robot", "World", "CollisionChecker", "ReachDatabase", "Box", "Cylinder", "Sphere", "Mesh", "LinkShape"),
    *(
        "plan_motion",
        "plan_cartesian",
        "time_parameterize",
        "Grasp",
        "Hand",
        "ManipulationProblem",
        "plan_manipulation",
    ),
    *("DriveByTask", "plan_drive_by", "load_scenario", "plan_part_supply", "verify_plan"),
    *("ProbabilisticSdf", "synthesize_grasps"),
}
FACADES = ("robot", "collision", "planning", "grasping", "base", "mapping", "optim", "gripper_design")
ROOT_ONLY = {"Error", "InvalidInput", "IoError"}  # of every room


def public(module: types.ModuleType) -> dict[str, object]:
    """Names without a leading underscore; of modules, none."""
    return {k: v for k, v in vars(module).items() if not k.startswith("_") and not isinstance(v, types.ModuleType)}


def test_the_root_has_the_names_of_the_design() -> None:
    assert {*public(mg), "__version__"} <= ROOT


def test_every_name_of_the_library_is_in_exactly_one_room() -> None:
    rooms = {name: [f for f in FACADES if name in public(getattr(mg, f))] for name in public(_core)}
    assert {name: found for name, found in rooms.items() if len(found) != (name not in ROOT_ONLY)} == {}
    assert public(mg.verify) == public(_core.verify)


@pytest.mark.parametrize("facade", FACADES)
def test_a_room_gives_what_root_and_library_give(facade: str) -> None:
    for name, value in public(getattr(mg, facade)).items():
        assert value is getattr(mg if name in vars(mg) else _core, name), name
        assert hasattr(_core, name), name


@pytest.mark.parametrize("facade", [*FACADES, "verify"])
def test_a_room_only_imports_and_says_what_lives_there(facade: str) -> None:
    tree = ast.parse((PACKAGE / f"{facade}.py").read_text())
    assert ast.get_docstring(tree)
    for statement in tree.body[1:]:
        assert isinstance(statement, ast.ImportFrom), ast.unparse(statement)
        assert all(alias.asname == alias.name for alias in statement.names), ast.unparse(statement)


@pytest.mark.parametrize("facade", ["__init__", *FACADES, "verify"])
def test_names_are_written_once(facade: str) -> None:
    tree = ast.parse((PACKAGE / f"{facade}.py").read_text())
    names = [a.name for s in tree.body if isinstance(s, ast.ImportFrom) for a in s.names]
    assert len(names) == len(set(names))
    assert "__all__" not in vars(importlib.import_module(f"mmgrasp.{facade}".removesuffix(".__init__")))


def gone() -> list[str]:
    rooms = {name for room in _moved.ROOMS for name in public(room)}
    problems = {name for module, names in _moved.PROBLEMS.items() for name in (module, *names)}
    return sorted((rooms | problems | set(_moved.RENAMED)) - set(public(mg)))


def test_old_names_are_known() -> None:
    assert {"ScoredGrasp", "Gripper", "PartSupplyPlan", "solve_part_supply", "scan_tray", "pipe_cells"} <= set(gone())


@pytest.mark.parametrize("name", gone())
def test_a_name_that_left_the_root_says_where_it_is(name: str) -> None:
    with pytest.raises(AttributeError, match=rf"^mmgrasp\.{name} moved: mmgrasp\.") as error:
        getattr(mg, name)
    module, _, last = str(error.value).split(": ")[1].rpartition(".")
    place = importlib.import_module(module)
    assert hasattr(place, last) or importlib.import_module(f"{module}.{last}")


def test_the_new_place_is_named_in_full() -> None:
    with pytest.raises(AttributeError, match=r"^mmgrasp\.Graspability moved: mmgrasp\.grasping\.Graspability$"):
        getattr(mg, "Graspability")  # noqa: B009
    for old in ("CandidateGrasp", "PipeGrasp", "ScoredGrasp"):
        with pytest.raises(AttributeError, match=rf"^mmgrasp\.{old} moved: mmgrasp\.Grasp$"):
            getattr(mg, old)
    with pytest.raises(AttributeError, match=r"^mmgrasp\.Gripper moved: mmgrasp\.Hand$"):
        getattr(mg, "Gripper")  # noqa: B009
    with pytest.raises(AttributeError, match=r"moved: mmgrasp\.part_supply\.ScenarioPlan$"):
        getattr(mg, "PartSupplyPlan")  # noqa: B009
    with pytest.raises(ImportError, match=r"^mmgrasp\.Gripper moved: mmgrasp\.Hand$"):
        from mmgrasp import Gripper  # type: ignore[attr-defined] # noqa: F401
    with pytest.raises(AttributeError, match=r"^module 'mmgrasp' has no attribute 'plan_holiday'$"):
        getattr(mg, "plan_holiday")  # noqa: B009


def test_a_name_that_is_nearly_right_brings_the_right_one() -> None:
    done = subprocess.run(
        [sys.executable, "-c", "import mmgrasp; mmgrasp.plan_motoin"], capture_output=True, text=True, timeout=60
    )
    assert done.stderr.splitlines()[-1].endswith("has no attribute 'plan_motoin'. Did you mean: 'plan_motion'?")


PYTHON_ONLY = {"pose", "pose_to_xyz_quat", "pose_to_xyz_rpy", "cache_folder", "with_sampled_pairs"}
SHORTER = {"Mesh": "MeshShape"}


def test_a_bound_name_is_the_cpp_name() -> None:
    headers = "\n".join(path.read_text() for path in sorted((REPOSITORY / "cpp" / "include").rglob("*.hpp")))
    classes = set(re.findall(r"^(?:struct|class|enum class) (?:MMGRASP_EXPORT )?(\w+)", headers, re.MULTILINE))
    classes |= set(re.findall(r"^using (\w+) =", headers, re.MULTILINE))
    functions = set(re.findall(r"\b([a-z]\w+)\(", headers))
    for name, value in (public(_core) | public(_core.verify)).items():
        if name in PYTHON_ONLY:
            assert name not in functions
        elif isinstance(value, type):
            assert SHORTER.get(name, name) in classes, name
        else:
            assert name in functions or f"make_{name}" in functions, name


# --- imports ----------------------------------------------------------------------------------------------------------
def modules() -> dict[str, Path]:
    """Dotted name below the package to file; a package by the name of its folder."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(name: str, path: Path, known: dict[str, Path]) -> set[str]:
    """Modules of the package that one imports, also inside functions and for type checkers."""
    package = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    package = [part for part in package if part]
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            assert not any(a.name.split(".")[0] == "mmgrasp" for a in node.names), f"{name}: imports are relative"
        if isinstance(node, ast.ImportFrom):
            assert node.level or (node.module or "").split(".")[0] != "mmgrasp", f"{name}: imports are relative"
            if node.level:
                base = [*package[: len(package) - node.level + 1], *(node.module.split(".") if node.module else [])]
                for alias in node.names:
                    inner, outer = ".".join([*base, alias.name]), ".".join(base)
                    found.add(inner if inner in known else outer)
    return {module for module in found if module in known} - {""}


def test_no_module_imports_in_a_circle() -> None:
    known = modules()
    graph = {name: imports_of(name, path, known) for name, path in known.items()}
    assert "part_supply" in graph["base"] and "sim.scene" in graph["sim.plan_controller"]
    list(TopologicalSorter(graph).static_order())


def test_no_package_imports_in_a_circle() -> None:
    known = modules()
    graph: dict[str, set[str]] = {}
    for name, path in known.items():
        if name:
            package = name.split(".")[0]
            graph.setdefault(package, set()).update(m.split(".")[0] for m in imports_of(name, path, known))
            graph[package].discard(package)
    assert "scenario" in graph["part_supply"]
    list(TopologicalSorter(graph).static_order())


def test_the_package_itself_uses_no_room() -> None:
    known = modules()
    users = {name for name, path in known.items() if imports_of(name, path, known) & {*FACADES, "verify"}}
    assert users <= {"", "_moved"}
