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
from programs import BUILD, build_programs
from tables import ROOT, markdown

STAGES = ROOT / "cpp/src/collision/narrow/stages.hpp"


def stages() -> dict[str, int]:
    """Names and bits of the stages."""
    return {name: int(bit) for name, bit in re.findall(r"k(\w+)Stage = (\d+)", STAGES.read_text())}


def library_without(stage: str, bit: int, build: Path) -> Path:
    """libmmgrasp without a stage."""
    folder = build / "stages" / stage
    folder.mkdir(parents=True, exist_ok=True)
    replaced = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = Path(entry["file"])
        if not source.is_relative_to(ROOT / "cpp/src/collision") or "stages.hpp" not in source.read_text():
            continue
        old = entry["command"].split(" -o ")[1].split()[0]
        replaced[old] = str(folder / (source.name + ".o"))
        command = entry["command"].replace(old, replaced[old]) + f" -DMMGRASP_STAGES_LEFT_OUT={bit}"
        subprocess.run(command, shell=True, cwd=build, check=True)
    link = subprocess.run(["ninja", "-t", "commands", "mmgrasp"], cwd=build, check=True, capture_output=True, text=True)
    command = next(
        line for line in reversed(link.stdout.splitlines()) if " -shared " in line and "libmmgrasp.so" in line
    )
    library = re.search(r"-o (\S*libmmgrasp\.so\S*)", command)
    assert library is not None
    out = folder / Path(library[1]).name
    command = command.replace(library[0], f"-o {out}").split(" && ")
    command = next(part for part in command if " -shared " in part)
    for old, new in replaced.items():
        command = command.replace(f" {old} ", f" {new} ")
    subprocess.run(command, shell=True, cwd=build, check=True)
    return out


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
