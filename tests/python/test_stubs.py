"""The committed stubs are what the binary module says. `python tests/python/test_stubs.py --write` renews them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from mmgrasp import _core
from stub_text import option_types, precise, with_none, with_options

STUBS = Path(__file__).resolve().parents[2] / "python" / "mmgrasp" / "_core"
OPTIONS = STUBS.parent / "_options.py"
PASSED_ON = {
    "CheckOptions": ("verify.check_plan", _core.verify.check_plan, ()),
    "CheckerOptions": ("CollisionChecker", _core.CollisionChecker.__init__, ()),
    "DriveByOptions": ("plan_drive_by", _core.plan_drive_by, ()),
    "GraspabilityOptions": ("evaluate_graspability", _core.evaluate_graspability, ()),
    "MotionOptions": ("plan_motion", _core.plan_motion, ("seed",)),
    "ReachOptions": ("ReachDatabase.build", _core.ReachDatabase.build, ()),
    "TrackingOptions": ("BaseTracker", _core.BaseTracker.__init__, ()),
}
"""Type, call and options left out, for Python's functions that pass keywords on."""


def generate(folder: Path) -> dict[str, str]:
    """File name to text: what pybind11-stubgen writes, made precise."""
    command = [
        sys.executable,
        "-m",
        "pybind11_stubgen",
        "mmgrasp._core",
        "-o",
        str(folder),
        "--numpy-array-use-type-var",
        "--exit-code",
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    made = folder / "mmgrasp" / "_core"
    modules = {"__init__.pyi": _core, "verify.pyi": _core.verify}
    return {name: precise(with_exceptions((made / name).read_text()), module) for name, module in modules.items()}


def with_exceptions(stub: str) -> str:
    """The stub with classes for the exceptions that stubgen imports from the package, which imports them from this stub."""
    lines, classes = [], []
    for line in stub.splitlines(keepends=True):
        name = line.removeprefix("from mmgrasp import ").strip()
        if not line.startswith("from mmgrasp import ") or not hasattr(_core, name):
            lines.append(line)
            continue
        exception = getattr(_core, name)
        bases = ", ".join(base.__name__ for base in exception.__bases__)
        classes.append(f'class {name}({bases}):\n    """\n    {exception.__doc__}\n    """\n')
    first = next((i for i, line in enumerate(lines) if line.startswith("class ")), len(lines))
    return "".join([*lines[:first], *classes, *lines[first:]])


def test_stubs_are_up_to_date(tmp_path: Path) -> None:
    made = generate(tmp_path)
    committed = {path.name: path.read_text() for path in sorted(STUBS.glob("*.pyi"))}
    assert made.keys() == committed.keys()
    for name, text in made.items():
        assert text == committed[name], f"{name} is out of date: ./dev stubs"


def test_types_of_options_are_up_to_date() -> None:
    assert OPTIONS.read_text() == option_types(PASSED_ON), f"{OPTIONS.name} is out of date: ./dev stubs"


def test_no_annotation_says_nothing() -> None:
    """No call hides its options, and `Any` stands only where any value can."""
    for path in sorted(STUBS.glob("*.pyi")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if not line.lstrip().startswith("def ") or line.startswith("def _"):
                continue
            place = f"{path.name}:{number}: {line.strip()}"
            assert "**kwargs" not in line, place
            assert re.search(r": typing\.Any\b|-> typing\.Any\b|Supports(Float|Int)", line) is None, place
            assert re.search(r"(: |-> |\[|\| )(list|dict|tuple)(?![\w\[.])", line) is None, place


def test_options_become_typed_keywords() -> None:
    lines = [
        "def go(a: int, *, b: int = 1, **kwargs) -> int:",
        '    """',
        "    Keyword options:",
        "        step: float = inf  # longest [m]",
        "        solver: str = 'ipopt'  # its name",
        '    """',
        '    """',
        "        other: int = 1  # of another call",
    ]
    expected = "def go(a: int, *, b: int = 1, step: float = ..., solver: str = 'ipopt') -> int:"
    assert with_options(lines[0], lines[1:]) == expected
    assert (
        with_options("def go(**kwargs) -> int:", lines[1:6])
        == "def go(*, step: float = ..., solver: str = 'ipopt') -> int:"
    )
    with pytest.raises(ValueError, match="no option is listed"):
        with_options(lines[0], ['    """', "    Nothing.", '    """'])


def test_none_as_a_default_is_allowed_as_an_argument() -> None:
    line = "def f(self, world: World = None, at: int | None = None, name: str = 'None', q: list[float] = None) -> None:"
    assert with_none(line) == (
        "def f(self, world: World | None = None, at: int | None = None, name: str = 'None', q: list[float] | None = None) -> None:"
    )


if __name__ == "__main__":
    import tempfile

    if sys.argv[1:] != ["--write"]:
        sys.exit("usage: test_stubs.py --write")
    STUBS.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in generate(Path(folder)).items():
            (STUBS / name).write_text(text)
            print(STUBS / name)
    OPTIONS.write_text(option_types(PASSED_ON))
    print(OPTIONS)
