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
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

HERE = Path(__file__).parent
REPOSITORY = HERE.parents[1]
KEPT = REPOSITORY / "build" / "hostile"
PAGE = REPOSITORY / "docs" / "hostile.md"
BEGIN, END = "<!-- tries: written by tests/python/hostile.py -->", "<!-- end of tries -->"
SCENARIO = REPOSITORY / "python" / "mmgrasp" / "assets" / "scenarios" / "storeroom.yaml"


class Part(NamedTuple):
    title: str
    tests: str
    """Files beside this one, without test_ and .py."""
    night: tuple[str, ...] = ()
    """Scripts beside this one with their arguments, or a command of ./dev."""


PARTS = {
    "texts": Part("YAML and JSON texts", "yaml_text file_fuzz key_fuzz option_bounds floor_map",
                  (f"file_fuzz.py {SCENARIO} 20000", *(f"key_fuzz.py {door}" for door in
                   ("scenario", "scanned", "pipe", "assembly", "profile", "sensors", "map")))),
    "frames": Part("frames and maps of surfaces", "frames_fuzz map_file_fuzz scan_refusals"),
    "readers": Part("files of robots, meshes, clouds and trees", "module_files", ("./dev fuzz 600",)),
    "calls": Part("every call, array and number of the stubs", "bad_arguments argument_errors python_arguments odd_objects numbers", ("number_walk.py",)),
    "limits": Part("limits, threads, memory, forks", "limits interpreter threads forks small_processes"),
    "command": Part("options and streams of the command", "cli_doors cli_options command_fuzz", ("command_fuzz.py 400",)),
    "places": Part("places that are written", "output_places output_commands", ("killed_runs.py 30",)),
    "stops": Part("Ctrl-C, signals, costly calls", "interrupt signals long_work costly_calls"),
    "verify": Part("changed plans and scenarios", "verify_files plan_mutations", ("mutation_shares.py 4",)),
    "plans": Part("odd scenarios: solved plans hold", "odd_scenarios",
                  ("odd_scenarios.py 500", "odd_scenarios.py 500 1 {kept} all", "odd_scenarios.py 100 1 {kept} advice")),
}  # fmt: skip


def files(part: Part) -> list[str]:
    return [str(HERE / f"test_{name}.py") for name in part.tests.split()]


def run_tests(parts: Iterable[str], arguments: list[str]) -> tuple[bool, dict[str, float], Counter[str]]:
    """Whether all passed; seconds and tests of each part."""
    seconds = dict.fromkeys(parts, 0.0)
    tests: Counter[str] = Counter()
    names = [file for part in parts for file in files(PARTS[part])]
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={report}"]
        done = subprocess.run([*command, *arguments, *names], cwd=REPOSITORY, check=False)
        for case in ElementTree.parse(report).iter("testcase"):
            file = case.get("classname", "").split(".")[-1].removeprefix("test_")
            part = next(name for name in parts if file in PARTS[name].tests.split())
            seconds[part] += float(case.get("time", 0))
            tests[part] += 1
    return done.returncode == 0, seconds, tests


def run_search(words: str) -> tuple[bool, float, int]:
    """Whether nothing was found, seconds, and the tries that the search says it made."""
    first, *others = words.replace("{kept}", str(KEPT)).split()
    begun = time.monotonic()
    command = [first] if first.startswith("./") else [sys.executable, "-u", str(HERE / first)]
    tries = 0
    with subprocess.Popen([*command, *others], cwd=REPOSITORY, stdout=subprocess.PIPE, text=True) as running:
        for line in running.stdout or ():
            print(line, end="", flush=True)
            if found := re.match(r"(\d+) tries", line):
                tries += int(found[1])
    return running.returncode == 0, time.monotonic() - begun, tries


def keep(part: str, what: str, tries: int, good: bool) -> None:
    """Remembers the last run of a part's tests or of one of its searches, for --write."""
    record = KEPT / "record.json"
    known = json.loads(record.read_text()) if record.exists() else {}
    row = {"part": part, "tries": tries, "good": good, "day": datetime.date.today().isoformat()}
    record.write_text(json.dumps({**known, f"{part}: {what}": row}, indent=1))


def table() -> str:
    """What was tried, part by part, as docs/hostile.md has it."""
    record = json.loads((KEPT / "record.json").read_text())
    lines = ["| door | run | tries | found | day |", "|---|---|---|---|---|"]
    for name, part in PARTS.items():
        for what in ("tests", *part.night):
            row = record.get(f"{name}: {what}")
            shown = what.replace(str(SCENARIO), SCENARIO.name).replace(" {kept}", "")
            if row is None or not row["tries"]:
                continue
            found = "nothing" if row["good"] else "something"
            lines.append(f"| {part.title} | `{shown}` | {row['tries']:,} | {found} | {row['day']} |")
    return "\n".join([*lines, "", f"{sum(row['tries'] for row in record.values()):,} tries in all."])


def write() -> None:
    before, rest = PAGE.read_text().split(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n\n{table()}\n\n{END}{rest.split(END)[1]}")


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
    good, seconds, tests = run_tests(chosen, [] if night else quick)
    failed = [] if good else ["tests"]
    lines = [f"{PARTS[name].title:45} {tests[name]:5} tests {seconds[name]:8.1f} s" for name in chosen]
    lines.append(f"{'all tests':45} {sum(tests.values()):5} tests {time.monotonic() - begun:8.1f} s on the clock")
    KEPT.mkdir(parents=True, exist_ok=True)
    for name in chosen if night else []:
        keep(name, "tests", tests[name], good)
        for words in PARTS[name].night:
            good, took, tries = run_search(words)
            keep(name, words, tries, good)
            lines.append(f"{words:57} {tries:7} tries {took:8.1f} s{'' if good else '  FAILED'}")
            failed += [] if good else [words]
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    lines.append(f"{'processor time of all':57} {used.ru_utime + used.ru_stime:8.1f} s")
    print("\n".join(lines))
    print(f"failed: {', '.join(failed)} (what was found is in build/hostile)" if failed else "nothing found")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
