"""What the benchmark drivers share: tables in benchmarks/README.md."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def markdown(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def write_readme(section: str, text: str) -> None:
    """Replaces what stands between the section's two markers in benchmarks/README.md."""
    path = ROOT / "benchmarks/README.md"
    begin, end = f"<!-- {section} begin -->", f"<!-- {section} end -->"
    page = path.read_text()
    if begin not in page:
        raise SystemExit(f"{path}: has no marker {begin}")
    pattern = re.compile(re.escape(begin) + ".*?" + re.escape(end), re.DOTALL)
    path.write_text(pattern.sub(lambda _: f"{begin}\n{text}\n{end}", page))


def show(section: str, text: str, write: bool) -> None:
    """Prints a section's tables and, when asked to, puts them into benchmarks/README.md."""
    print(text)
    if write:
        write_readme(section, text)
