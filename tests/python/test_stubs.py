"""The committed stubs are what the binary module says. `python tests/python/test_stubs.py --write` renews them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

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
    return {path.name: path.read_text() for path in sorted(made.glob("*.pyi"))}


def test_stubs_are_up_to_date(tmp_path):
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
