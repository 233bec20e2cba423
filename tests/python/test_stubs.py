"""The committed stubs are what the binary module says. `python tests/python/test_stubs.py --write` renews them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from mmgrasp import _core

STUBS = Path(__file__).resolve().parents[2] / "python" / "mmgrasp" / "_core"


def generate(folder: Path) -> dict[str, str]:
    """File name to text, as pybind11-stubgen writes it."""
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
    return {path.name: with_exceptions(path.read_text()) for path in sorted(made.glob("*.pyi"))}


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


if __name__ == "__main__":
    import tempfile

    if sys.argv[1:] != ["--write"]:
        sys.exit("usage: test_stubs.py --write")
    STUBS.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in generate(Path(folder)).items():
            (STUBS / name).write_text(text)
            print(STUBS / name)
