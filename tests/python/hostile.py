"""All tables of bad inputs and all fuzzers, with the time of each (`./dev hostile`).

python tests/python/hostile.py                    the quick size: those tests of each part that are not marked slow
python tests/python/hostile.py --night [PART...]  all tests and the long searches of all parts, or of those named
python tests/python/hostile.py --write            puts what the last night runs of all parts tried and found into docs/hostile.md
"""

from __future__ import annotations

import datetime
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

HERE = Path(__file__).parent
REPOSITORY = HERE.parents[1]
KEPT = REPOSITORY / "build" / "hostile"
RECORD = HERE / "hostile_record.json"
PAGE = REPOSITORY / "docs" / "hostile.md"
BEGIN, END = "<!-- tries: written by tests/python/hostile.py -->", "<!-- end of tries -->"
LONGEST_QUICK = 60.0  # [s]; somebody waits for it
SCENARIO = REPOSITORY / "python" / "mmgrasp" / "assets" / "scenarios" / "storeroom.yaml"


class Part(NamedTuple):
    title: str
    tests: str
    """Files beside this one, without test_ and .py."""
    night: tuple[str, ...] = ()
    """Scripts beside this one with their arguments, or a command of ./dev."""


PARTS = {
    "texts": Part("YAML and JSON texts", "yaml_text file_fuzz key_fuzz option_bounds floor_map gripper_refusals",
                  ("file_fuzz.py {scenario} 20000", "file_fuzz.py plan 20000", *(f"key_fuzz.py {door}" for door in
                   ("scenario", "scanned", "pipe", "assembly", "profile", "gripper", "hand", "sensors", "map", "plan")))),
    "frames": Part("frames and maps of surfaces", "frames_fuzz map_file_fuzz scan_refusals"),
    "readers": Part("files of robots, meshes, clouds and trees", "module_files mesh_fuzz", ("./dev fuzz 120", "mesh_fuzz.py")),
    "calls": Part("every call, array and number of the stubs",
                  "bad_arguments argument_errors python_arguments odd_objects numbers number_walk texts", ("number_walk.py",)),
    "limits": Part("limits, threads, memory, forks", "limits interpreter threads forks small_processes pickling"),
    "command": Part("options and streams of the command", "cli_doors cli_options command_fuzz", ("command_fuzz.py 400",)),
    "places": Part("places that are written", "output_places output_folder output_commands killed_runs saved_again", ("killed_runs.py 60",)),
    "stops": Part("Ctrl-C, signals, costly calls", "interrupt signals long_work costly_calls"),
    "verify": Part("changed plans and scenarios", "verify_files plan_mutations mutation_shares schedule schedule_search",
                   ("mutation_shares.py 4",)),
    "plans": Part("odd scenarios: solved plans hold", "odd_scenarios",
                  ("odd_scenarios.py 500", "odd_scenarios.py 120 1 {kept} all", "odd_scenarios.py 100 1 {kept} advice")),
}  # fmt: skip


def files(part: Part) -> list[str]:
    return [str(HERE / f"test_{name}.py") for name in part.tests.split()]


class Tests(NamedTuple):
    """What became of the tests of one part."""

    seconds: float = 0.0
    made: int = 0
    """Without those that were skipped."""
    failed: int = 0


def count_tests(report: Path, parts: Iterable[str]) -> dict[str, Tests]:
    """Pytest's report (--junitxml), part by part."""
    of_file = {file: name for name in parts for file in PARTS[name].tests.split()}
    found = dict.fromkeys(of_file.values(), Tests())
    for case in ElementTree.parse(report).iter("testcase"):
        # A file that cannot be collected is an error case whose classname is empty.
        words = case.get("classname") or case.get("name") or ""
        part = of_file[next(word.removeprefix("test_") for word in words.split(".") if word.startswith("test_"))]
        is_failed = case.find("failure") is not None or case.find("error") is not None
        known = found[part]
        found[part] = Tests(
            known.seconds + float(case.get("time", 0)),
            known.made + (case.find("skipped") is None),
            known.failed + is_failed,
        )
    return found


def run_tests(parts: Iterable[str], arguments: list[str]) -> tuple[bool, dict[str, Tests]]:
    """Whether all passed, and what became of those of each part."""
    names = [file for part in parts for file in files(PARTS[part])]
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={report}"]
        done = subprocess.run([*command, *arguments, *names], cwd=REPOSITORY, check=False)
        return done.returncode == 0, count_tests(report, parts)


def run_search(words: str) -> tuple[bool, float, int]:
    """Whether nothing was found, seconds, and the tries that the search says it made; one that says none has failed."""
    first, *others = words.format(kept=KEPT, scenario=SCENARIO).split()
    begun = time.monotonic()
    command = [first] if first.startswith("./") else [sys.executable, "-u", str(HERE / first)]
    tries = 0
    with subprocess.Popen([*command, *others], cwd=REPOSITORY, stdout=subprocess.PIPE, text=True) as running:
        for line in running.stdout or ():
            print(line, end="", flush=True)
            if found := re.match(r"(\d+) tries", line):
                tries += int(found[1])
    return running.returncode == 0 and tries > 0, time.monotonic() - begun, tries


def keep(part: str, what: str, tries: int, good: bool) -> None:
    """Remembers the last run of a part's tests or of one of its searches, for --write."""
    row = {"tries": tries, "good": good, "day": datetime.date.today().isoformat()}
    known = json.loads(RECORD.read_text())
    RECORD.write_text(json.dumps({**known, f"{part}: {what}": row}, indent=1) + "\n")


def table() -> str:
    """What was tried, part by part, as docs/hostile.md has it."""
    record = json.loads(RECORD.read_text())
    lines, tries = ["| door | run | tries | found | day |", "|---|---|---|---|---|"], 0
    for name, part in PARTS.items():
        for what in ("tests", *part.night):
            shown = what.format(kept="", scenario=SCENARIO.name).replace("  ", " ")
            row = record.get(f"{name}: {what}")
            if row is None:
                lines.append(f"| {part.title} | `{shown}` | - | not run yet | - |")
                continue
            found = "nothing" if row["good"] else "something"
            lines.append(f"| {part.title} | `{shown}` | {row['tries']:,} | {found} | {row['day']} |")
            tries += row["tries"]
    return "\n".join([*lines, "", f"{tries:,} tries in all."])


def write() -> None:
    before, rest = PAGE.read_text().split(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n\n{table()}\n\n{END}{rest.split(END)[1]}")


def quick_size(took: float) -> str:
    """What the quick size took on the clock, and that it was too long."""
    text = f"the quick size took {took:.0f} s on the clock"
    return f"{text}: MORE THAN {LONGEST_QUICK:.0f} s, mark tests as slow" if took > LONGEST_QUICK else text


def search_all(parts: Iterable[str]) -> tuple[list[str], list[str]]:
    """Runs the searches of the parts: a line about each, and those that failed."""
    lines, failed = [], []
    for name in parts:
        for words in PARTS[name].night:
            good, took, tries = run_search(words)
            keep(name, words, tries, good)
            lines.append(f"{words:57} {tries:7} tries {took:8.1f} s{'' if good else '  FAILED'}")
            failed += [] if good else [words]
    return lines, failed


def main() -> int:
    if "--write" in sys.argv:
        write()
        return 0
    night = "--night" in sys.argv
    chosen = [word for word in sys.argv[1:] if word != "--night"] or list(PARTS)
    if unknown := set(chosen) - PARTS.keys():
        print(f"no part {', '.join(sorted(unknown))}; there are {', '.join(PARTS)}", file=sys.stderr)
        return 2
    # As continuous integration does. What is measured in a night run has the machine for itself.
    quick = ["-m", "not slow", "-n", str(os.cpu_count() or 1), "--dist", "loadfile"]
    begun = time.monotonic()
    good, tests = run_tests(chosen, [] if night else quick)
    took = time.monotonic() - begun
    failed = [] if good else ["tests"]
    lines = [f"{PARTS[name].title:45} {tests[name].made:5} tests {tests[name].seconds:8.1f} s" for name in chosen]
    lines.append(f"{'all tests':45} {sum(found.made for found in tests.values()):5} tests {took:8.1f} s on the clock")
    KEPT.mkdir(parents=True, exist_ok=True)
    if night:
        for name in chosen:
            keep(name, "tests", tests[name].made, not tests[name].failed)
        told, missed = search_all(chosen)
        lines, failed = lines + told, failed + missed
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    lines.append(f"{'processor time of all':57} {used.ru_utime + used.ru_stime:8.1f} s")
    if not night and len(chosen) == len(PARTS):
        lines.append(quick_size(took))
    print("\n".join(lines))
    print(f"failed: {', '.join(failed)} (what was found is in build/hostile)" if failed else "nothing found")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
