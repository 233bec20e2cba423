"""Scenario and plan texts changed at random: they are read or refused, nothing else. As a script: `file_fuzz.py FILE [TRIES [SEED]]`."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable
from pathlib import Path

import mmgrasp as mg
from mmgrasp.documents.reading import read_json
from mmgrasp.part_supply.consistency import check_consistency
from mmgrasp.part_supply.plan_file import check_form, check_names
from mmgrasp.part_supply.plan_reader import plan_to_check

SCRAPS = [
    *("", " ", "\n", "\t", "-", ":", ": ", "#", "[", "]", "{", "}", ",", '"', "'", "&a ", "*a", "!!str ", "!x ", "|", ">", "?", "%"),
    *("0", "-1", "1e308", "1e-308", "1e999", ".nan", "-.inf", "9" * 400, "0x7fffffff", "010", "1:30", "true", "null", "~", "NaN"),
    *("\x00", "\x1b[31m", "\ufeff", "\u202e", "\U0001f600", "a" * 3000, "[" * 200, "../../../etc/passwd", "/dev/zero", "~nobody/x"),
]  # fmt: skip


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


def fuzz(text: str, read: Callable[[Path], None], folder: Path, tries: int, seed: int) -> tuple[int, int]:
    """How many changed texts were read, and how many refused. Anything else that is raised is raised here."""
    draw = random.Random(seed)
    taken = refused = 0
    for _ in range(tries):
        path = folder / "fuzzed.file"
        path.write_text(changed(text, draw), encoding="utf-8", errors="surrogatepass")
        try:
            read(path)
            taken += 1
        except mg.Error as error:
            assert str(error), "an error without a word"
            refused += 1
    return taken, refused


def main() -> int:
    import tempfile

    source = Path(sys.argv[1])
    tries = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    read = read_plan_whole if source.suffix == ".json" else read_scenario
    with tempfile.TemporaryDirectory() as folder:
        taken, refused = fuzz(source.read_text(), read, Path(folder), tries, seed)
    print(f"{taken + refused} tries: {taken} read, {refused} refused")
    return 0


if __name__ == "__main__":
    sys.exit(main())
