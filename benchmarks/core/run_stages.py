"""What each stage of the collision checks is worth: the same work with one stage left out after the other.

    python benchmarks/core/run_stages.py [--rounds 5] [--build FOLDER]

Compiles the files that know the stages (cpp/src/collision/narrow/stages.hpp) again without one of them, links them with the
other objects of the build, and runs bench_stages against each library. A stage is worth what its absence costs: the ratio of the
times. All answers must be the same.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import left_out
from programs import BUILD, build_programs
from tables import ROOT, markdown

STAGES = ROOT / "cpp/src/collision/narrow/stages.hpp"


def stages() -> dict[str, int]:
    """Names and bits of the stages."""
    return {name: int(bit) for name, bit in re.findall(r"k(\w+)Stage = (\d+)", STAGES.read_text())}


def library_without(stage: str, bit: int, build: Path) -> Path:
    """libmmgrasp without a stage."""

    def knows_stages(source: Path) -> bool:
        return source.is_relative_to(ROOT / "cpp/src/collision") and "stages.hpp" in source.read_text()

    return left_out.library_without(stage, f"MMGRASP_STAGES_LEFT_OUT={bit}", knows_stages, build)


def measured(build: Path, rounds: int, library: Path | None) -> dict[tuple[str, str], dict]:
    """The lines of bench_stages by robot and work."""
    environment = {**os.environ, **({"LD_PRELOAD": str(library)} if library else {})}
    command = [build / "benchmarks/bench_stages", str(rounds)]
    out = subprocess.run(command, check=True, env=environment, stdout=subprocess.PIPE, text=True).stdout
    lines = [json.loads(line) for line in out.splitlines()]
    return {(line["on"].split(",")[0], line["row"]): line for line in lines}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--build", type=Path, help="a build with bench_stages in it, instead of one made here")
    arguments = parser.parse_args()
    build = arguments.build or BUILD
    if arguments.build is None:
        build_programs([], ["bench_stages"])
    build = build.resolve()
    whole = measured(build, arguments.rounds, None)
    rows = [["all stages", *(f"{line['value']:.3g} us" for line in whole.values())]]
    same = True
    for stage, bit in stages().items():
        without = measured(build, arguments.rounds, library_without(stage, bit, build))
        same = same and all(without[key]["answers"] == line["answers"] for key, line in whole.items())
        name = re.sub(r"(?<!^)([A-Z])", lambda match: " " + match[1].lower(), stage).lower()
        rows.append(
            [f"without: {name}", *(f"{without[key]['value'] / line['value']:.2f}" for key, line in whole.items())]
        )
    print(markdown(["", *(f"{robot}: {row}" for robot, row in whole)], rows))
    if not same:
        print("answers differ", file=sys.stderr)
    return 0 if same else 1


if __name__ == "__main__":
    raise SystemExit(main())
