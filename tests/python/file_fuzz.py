"""Scenario and plan texts changed at random: they are read or refused, nothing else.

As a script: `file_fuzz.py FILE [TRIES [SEED]]`; FILE is a scenario, a plan (.json) or the word `plan`, for one that is
made first.
"""

from __future__ import annotations

import copy
import json
import random
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import mmgrasp as mg
from mmgrasp.documents.reading import read_json
from mmgrasp.part_supply.consistency import check_consistency
from mmgrasp.part_supply.plan_file import check_form, check_names
from mmgrasp.part_supply.plan_reader import plan_to_check
from plan_mutations import plan_and_scenario

SCRAPS = [
    *("", " ", "\n", "\t", "-", ":", ": ", "#", "[", "]", "{", "}", ",", '"', "'", "&a ", "*a", "!!str ", "!x ", "|", ">", "?", "%"),
    *("0", "-1", "1e308", "1e-308", "1e999", ".nan", "-.inf", "9" * 400, "0x7fffffff", "010", "1:30", "true", "null", "~", "NaN"),
    *("\x00", "\x1b[31m", "\ufeff", "\u202e", "\U0001f600", "a" * 3000, "[" * 200, "../../../etc/passwd", "/dev/zero", "~nobody/x"),
]  # fmt: skip
TOO_LONG = 20.0  # [s] of processor time for one text


def changed(text: str, draw: random.Random) -> str:
    """The text with one to three places changed: a piece cut, doubled or moved, a line gone, a scrap put in."""
    for _ in range(draw.randint(1, 3)):
        a = draw.randrange(len(text) + 1)
        b = min(len(text), a + draw.choice([1, 1, 2, 5, 20, 200]))
        kind = draw.randrange(6)
        if kind == 0:
            text = text[:a] + text[b:]
        elif kind == 1:
            text = text[:b] + text[a:b] + text[b:]
        elif kind == 2:
            c = draw.randrange(len(text) + 1)
            text = text[:c] + text[a:b] + text[c:]
        elif kind == 3:
            lines = text.split("\n")
            i, j = draw.randrange(len(lines)), draw.randrange(len(lines))
            lines[i], lines[j] = lines[j], lines[i]
            text = "\n".join(lines)
        else:
            text = text[:a] + draw.choice(SCRAPS) + text[b if kind == 4 else a :]
    return text


def read_scenario(path: Path) -> None:
    mg.load_scenario(path)


def read_plan_whole(path: Path) -> None:
    """All that is read of a plan before it is drawn or checked."""
    root = read_json(path).root
    check_form(root)
    plan_to_check(root)
    check_consistency(root.raw)
    check_names(root)


def with_short_motions(plan: dict[str, Any]) -> dict[str, Any]:
    """The plan with two samples of each motion: most of the text would be numbers of motions."""
    plan = copy.deepcopy(plan)
    for motion in [m for pick in plan["picks"] for m in pick["motions"]] + plan.get("drive_by", {}).get("motions", []):
        for key in ("times", "positions", "velocities", "accelerations"):
            motion[key] = motion[key][:2]
    return plan


class Result(NamedTuple):
    taken: int
    refused: int
    complaints: list[str]
    """What was neither read nor refused with a message."""

    def __str__(self) -> str:
        tries = self.taken + self.refused + len(self.complaints)
        return f"{tries} tries: {self.taken} read, {self.refused} refused, {len(self.complaints)} complaints"


def what_came(read: Callable[[Path], None], path: Path) -> str:
    """How reading the file ended: "read", "refused", or what to complain of."""
    begun = time.process_time()
    try:
        read(path)
        ended = "read"
    except mg.Error as error:
        ended = "refused" if str(error) else "an error without a word"
    except Exception as error:
        ended = f"{type(error).__name__}: {error}"
    took = time.process_time() - begun
    return ended if took < TOO_LONG else f"{ended} after {took:.0f} s of processor time"


def fuzz(text: str, read: Callable[[Path], None], folder: Path, tries: int, seed: int) -> Result:
    """What became of changed texts. Those that are complained of stay in the folder."""
    draw = random.Random(seed)
    taken = refused = 0
    complaints = []
    path = folder / "fuzzed.file"
    for number in range(tries):
        path.write_text(changed(text, draw), encoding="utf-8", errors="surrogatepass")
        ended = what_came(read, path)
        taken += ended == "read"
        refused += ended == "refused"
        if ended not in ("read", "refused"):
            kept = path.rename(folder / f"fuzzed_{seed}_{number}.file")
            complaints.append(f"{kept.name}: {ended}")
    return Result(taken, refused, complaints)


def made_plan() -> dict[str, Any]:
    """A plan of three trays and two stops with all that may stand in one."""
    with tempfile.TemporaryDirectory() as folder:
        return with_short_motions(plan_and_scenario(Path(folder))[0])


def source(word: str) -> tuple[str, Callable[[Path], None]]:
    """The text that is changed, and what reads it."""
    if word == "plan":
        return json.dumps(made_plan(), indent=1), read_plan_whole
    path = Path(word)
    return path.read_text(), read_plan_whole if path.suffix == ".json" else read_scenario


def main() -> int:
    text, read = source(sys.argv[1])
    tries = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    folder = Path(tempfile.mkdtemp())
    result = fuzz(text, read, folder, tries, seed)
    print("\n".join([*result.complaints, str(result)]))
    if result.complaints:
        print(f"the texts are in {folder}")
        return 1
    shutil.rmtree(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
