"""What a reproduced table or figure is: rows with the paper's value and ours side by side, checks, and how to draw them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .._progress import Progress
from .statements import REVERSED, Pair, difference

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Sweep = Callable[..., list[Any]]


def sweep_here(
    function: Callable[..., dict[str, Any]], items: Sequence[dict[str, Any]], *, progress: Progress, stage: str
) -> list[dict[str, Any]]:
    """Calls the function with each item's keywords, one after the other in this process."""
    out = []
    for i, item in enumerate(items):
        if progress is not None:
            progress(stage, i / len(items))
        out.append(function(**item))
    if progress is not None:
        progress(stage, 1.0)
    return out


@dataclass
class Context:
    """How a run is to be done."""

    quick: bool = False
    seed: int = 1
    progress: Progress = None
    run_sweep: Sweep = sweep_here

    def sweep(self, function: Callable[..., dict[str, Any]], items: Iterable[dict[str, Any]], stage: str) -> list[Any]:
        """A measurement for each item, in their order; here or on a cluster."""
        return self.run_sweep(function, list(items), progress=self.progress, stage=stage)


@dataclass
class Check:
    """A statement about the outcome. kind "E": the paper's exact value; "T": its trend; "S": a comparison of the paper's."""

    kind: str
    what: str
    holds: bool
    clock: bool = False
    """About seconds on the clock: how busy the machine is decides with."""
    answer: str = ""
    """To a statement of kind "S": confirmed, no difference or reversed."""


@dataclass
class Result:
    """One reproduced item. Values are (paper, ours); None where the paper prints nothing or there is nothing of ours."""

    rows: list[tuple[dict[str, Any], dict[str, tuple[Any, Any]]]] = field(default_factory=list)
    setup: dict[str, Any] = field(default_factory=dict)
    checks: list[Check] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    drawing: dict[str, Any] = field(default_factory=dict)
    """What the picture needs beyond the rows; plain values."""

    def row(self, key: dict[str, Any], **_: Any) -> dict[str, tuple[Any, Any]]:
        values: dict[str, tuple[Any, Any]] = {}
        self.rows.append((key, values))
        return values

    def exact(self, what: str, holds: bool) -> None:
        self.checks.append(Check("E", what, bool(holds)))

    def trend(self, what: str, holds: bool, *, clock: bool = False) -> None:
        self.checks.append(Check("T", what, bool(holds), clock))

    def near_paper(self, column: str, share: float) -> None:
        """A trend for each row in which the paper prints this column: ours is within this share of it."""
        for key, values in self.rows:
            paper, ours = values.get(column, (None, None))
            if paper is not None:
                where = ", ".join(str(value) for value in key.values())
                what = f"{where}: {column} within {100 * share:g} % of the paper's {paper:g}"
                self.trend(what, ours is not None and abs(ours - paper) <= share * abs(paper))

    def statement(self, what: str, pairs: Iterable[Pair], *, clock: bool = False) -> None:
        """A statement of the paper: that one way gives more than another; left out when there is nothing to compare."""
        found = difference(pairs)
        if found is not None:
            self.checks.append(Check("S", f"{what}: {found}", found.answer != REVERSED, clock, found.answer))

    def answered(self, what: str, answer: str) -> None:
        """A claim of the paper that is no matter of chance, with its answer."""
        self.checks.append(Check("S", what, answer != REVERSED, answer=answer))

    def to_dict(self) -> dict[str, Any]:
        return {
            "rows": [
                {
                    "key": key,
                    "values": {name: {"paper": _plain(p), "ours": _plain(o)} for name, (p, o) in values.items()},
                }
                for key, values in self.rows
            ],
            "setup": {key: _plain(value) for key, value in self.setup.items()},
            "checks": [
                {"kind": c.kind, "what": c.what, "holds": c.holds, "clock": c.clock}
                | ({"answer": c.answer} if c.answer else {})
                for c in self.checks
            ],
            "notes": self.notes,
            "drawing": self.drawing,
        }


def _plain(value: Any) -> Any:
    """JSON's own types; floats keep six significant digits, which no table shows more of."""
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if hasattr(value, "item"):
        value = value.item()
    return float(f"{value:.6g}") if isinstance(value, float) else value


@dataclass(frozen=True)
class Entry:
    """One name of `mmgrasp reproduce`."""

    name: str
    title: str
    run: Callable[[Context], Result]
    draw: Callable[[dict[str, Any]], Figure] | None = None
    """From a stored result to its picture."""
