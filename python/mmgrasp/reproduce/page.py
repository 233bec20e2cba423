"""Markdown and pictures of stored results."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

from .._files import PNG, check_file, write_file
from . import ENTRIES
from .sources import is_stale, sources_hash, stale_results, stored_result
from .stored_regions import FINDING

FOLDER = "reproduction"
STALE = "Older than the sources it is made from"
PAGE = "reproduction.md"
HEAD = """# What the papers print, and what mmgrasp computes

Written by `mmgrasp reproduce` (or `./dev reproduce`) from the results in `{folder}/*.json`; do not edit. Each table has the paper's value
(p) and ours (o) in every column; a dash stands where the paper prints nothing. **E** marks statements that must hold exactly, **T** trends. **S** marks
comparisons that a paper makes, asked again over paired runs: *confirmed* or *reversed* when the 95 % interval of the mean difference leaves zero out,
*no difference* otherwise.
P1 ran on a laptop at 2.5 GHz. Times start from a loaded reachability database, with nothing kept from before.
"""


def markdown(result: dict[str, Any], picture: str | None = None) -> str:
    """One result as a section."""
    lines = [f"## {result['name']}: {result['title']}", ""]
    columns = list(dict.fromkeys(name for row in result["rows"] for name in row["values"]))
    keys = list(dict.fromkeys(name for row in result["rows"] for name in row["key"]))
    printed = [n for n in columns if any(row["values"].get(n, {}).get("paper") is not None for row in result["rows"])]
    head = [*keys]
    for name in columns:
        head += [f"{name} (p)", f"{name} (o)"] if name in printed else [name]
    lines += ["| " + " | ".join(head) + " |", "|" + "---|" * len(keys) + "---:|" * (len(head) - len(keys))]
    for row in result["rows"]:
        cells = [_text(row["key"].get(key)) for key in keys]
        for name in columns:
            value = row["values"].get(name, {"paper": None, "ours": None})
            cells += [_text(value["paper"]), _text(value["ours"])] if name in printed else [_text(value["ours"])]
        lines.append("| " + " | ".join(cells) + " |")
    lines.append("")
    if picture:
        lines += [f"![{result['title']}]({picture})", ""]
    for check in result["checks"]:
        answer = check.get("answer") or ("holds" if check["holds"] else "DOES NOT HOLD")
        lines.append(f"- **{check['kind']}** {answer}: {check['what']}")
    if result["checks"]:
        lines.append("")
    for note in result["notes"]:
        lines += [note, ""]
    setup = "; ".join(f"{key} {_text(value)}" for key, value in result["setup"].items())
    machine = result["machine"]
    kind = "quick version, " if result["quick"] else ""
    lines += [
        f"Set-up: {setup}.",
        "",
        f"({kind}seed {result['seed']}, {result['seconds']:g} s for this page, {result['date']}, {machine['processor']}, "
        f"{machine['cores']} cores, {machine['system']}, Python {machine['python']}, mmgrasp {machine['mmgrasp']})",
        "",
    ]
    return "\n".join(lines)


def _text(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
    if isinstance(value, list):
        return " x ".join(_text(v) for v in value) if len(value) == 3 else ", ".join(_text(v) for v in value)
    return str(value)


def write_picture(result: dict[str, Any], path: Path) -> bool:
    """Draws a stored result; False when its entry has no picture."""
    draw = ENTRIES[result["name"]].draw
    if draw is None:
        return False
    buffer = io.BytesIO()
    draw(result).savefig(buffer, format="png")
    write_file(path, buffer.getvalue())
    return True


def _one_line_a_key(result: dict[str, Any]) -> str:
    """JSON whose changes can be read: a line for each table row and each other key, however large its value."""
    rows = ",\n  ".join(json.dumps(row, allow_nan=False) for row in result["rows"])
    others = (f'"{key}": {json.dumps(value, allow_nan=False)}' for key, value in result.items() if key != "rows")
    return "{\n" + ",\n".join([*others, f'"rows": [\n  {rows}\n]']) + "\n}\n"


def check_places(name: str, seed: int, out: Path) -> None:
    """Raises IoError where `store` would replace what is no page or result of ours, or cannot write."""
    check_file(out / PAGE, HEAD.partition("\n")[0].encode())
    check_file(_stored(name, seed, out), _one_line_a_key({"name": name, "rows": []}).partition(",")[0].encode())
    check_file(out / FOLDER / f"{name}.png", PNG)


def _stored(name: str, seed: int, out: Path) -> Path:
    return out / FOLDER / (f"{name}.json" if seed == 1 else f"{name}-seed-{seed}.json")


def store(result: dict[str, Any], out: Path) -> Path:
    """Writes a result's JSON and picture below the folder and the page of all results stored there; returns the page.

    Seed 1 is the one shown. Those of other seeds are kept beside it, and the page says which statements hold for them.
    """
    made_from = sources_hash(result["name"], out.absolute().parent)
    if made_from is not None:
        result = {**result, "sources": made_from}
    write_file(_stored(result["name"], result["seed"], out), _one_line_a_key(result))
    if result["seed"] == 1:
        write_picture(result, out / FOLDER / f"{result['name']}.png")
    return write_page(out)


def _other_seeds(folder: Path, name: str) -> list[str]:
    """A line for each result of another seed."""
    lines = []
    for path in sorted(folder.glob(f"{name}-seed-*.json")):
        result = stored_result(path)
        broken = [check["what"] for check in result["checks"] if not check["holds"]]
        holding = f"{len(result['checks']) - len(broken)} of {len(result['checks'])} statements hold"
        lines.append(f"Seed {result['seed']}: {holding}{''.join('; not: ' + what for what in broken)}.\n")
    return lines


def _finding(folder: Path) -> list[str]:
    """What the first chapter comes to: how many of P1's own base positions serve, by the stored table 3.1."""
    path = folder / "p1-table-3.1.json"
    notes = stored_result(path)["notes"] if path.is_file() else []
    return [f"**P1's base positions beside exact ones.** {note}\n" for note in notes if note.startswith(FINDING)]


def write_page(out: Path) -> Path:
    """The page of all results stored below the folder, in the order of the table of entries."""
    repository = out.absolute().parent
    sections = [HEAD.format(folder=FOLDER)]
    sections += _finding(out / FOLDER)
    stale = stale_results(out / FOLDER, repository)
    if stale:
        sections.append(f"{STALE}: {', '.join(stale)}.\n")
    for name in ENTRIES:
        path = out / FOLDER / f"{name}.json"
        if not path.is_file():
            continue
        picture = f"{FOLDER}/{name}.png"
        result = stored_result(path)
        section = markdown(result, picture if (out / picture).is_file() else None)
        if is_stale(result, repository):
            head, _, rest = section.partition("\n")
            section = f"{head}\n\n*{STALE}.*\n{rest}"
        sections.append(section)
        sections += _other_seeds(out / FOLDER, name)
    page = out / PAGE
    write_file(page, "\n".join(sections))
    return page
