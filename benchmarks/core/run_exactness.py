"""100,000 collision answers beside FCL called directly, and what of them lies within 1e-6 m of touching.

    python benchmarks/core/run_exactness.py [--write] [--queries 100000]

--write puts the table into benchmarks/README.md. Leaves with 1 when an answer outside of the band differs.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from programs import BUILD, build_programs
from tables import markdown, show

BAND = "in the 1e-6 m band"


def table(lines: list[dict]) -> str:
    """A row for each robot and scene, and their sum."""
    rows = []
    for line in lines:
        rows.append([line["on"], *(f"{int(line[key])}" for key in ("value", "free", "self", "scene", BAND, "wrong"))])
    rows.append(["all", *(str(sum(int(row[k]) for row in rows)) for k in range(1, 7))])
    return markdown(["robot, scene", "agreed on", "free", "self-collision", "scene", "in the band", "wrong"], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    parser.add_argument("--queries", type=int, default=100_000)
    given = parser.parse_args()
    build_programs([], ["bench_exactness"])
    program = [BUILD / "benchmarks/bench_exactness", str(given.queries)]
    done = subprocess.run(program, stdout=subprocess.PIPE, text=True)
    printed = done.stdout.splitlines()
    band = [line.removeprefix("band: ") for line in printed if line.startswith("band: ")]
    wrong = [line for line in printed if line.startswith("WRONG: ")]
    listed = "\n".join(f"- {line}" for line in band) or "None of them lies in the band."
    text = f"{table([json.loads(line) for line in printed if line.startswith('{')])}\n\nIn the band:\n\n{listed}"
    show("exactness", "\n\n".join([text, *wrong]), given.write)
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
