"""What the benchmark drivers share: the baselines' environment, building and running the programs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import venv
from pathlib import Path

from tables import ROOT, markdown

BUILD = ROOT / "build/bench"


def baselines_environment(folder: Path, requirements: Path) -> Path:
    """A virtual environment with the baselines; made when it is not there. Returns its python."""
    python = folder / "bin/python"
    if not python.exists():
        print(f"making {folder}", file=sys.stderr)
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "-q", "-r", requirements], check=True)
    return python


def packages_of(python: Path) -> str:
    """The folder a virtual environment installs packages into."""
    command = [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def build_programs(options: list[str], targets: list[str]) -> list[Path]:
    """Configures and builds; returns the programs. No targets: everything."""
    environment = {**os.environ, "CCACHE_BASEDIR": str(ROOT)}
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DMMGRASP_BUILD_BENCHMARKS=ON", *options]
    quiet = {"check": True, "env": environment, "stdout": subprocess.DEVNULL}
    subprocess.run(["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", *options], **quiet)
    chosen = ["--target", *targets] if targets else []
    subprocess.run(["cmake", "--build", BUILD, *chosen], **quiet)
    return sorted((BUILD / "benchmarks").glob("bench_*"))


def lines_of(command: list) -> list[dict]:
    """Runs a program and reads the JSON lines it prints; other lines are shown."""
    print("running", *(Path(str(part)).name for part in command), file=sys.stderr)
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, cwd=BUILD)
    out = []
    for line in done.stdout.splitlines():
        if line.startswith("{"):
            out.append(json.loads(line))
        elif line:
            print(line, file=sys.stderr)
    return out


def full_table(lines: list[dict]) -> str:
    """Every measurement with its settings."""
    plain = ("row", "on", "who", "value", "unit", "settings")
    rows = []
    for line in lines:
        more = ", ".join(
            f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in line.items() if k not in plain
        )
        rows.append(
            [line["row"], line["on"], line["who"], f"{line['value']:.4g} {line['unit']}", more, line["settings"]]
        )
    return markdown(["work", "on", "program", "", "also", "settings"], rows)
