"""How many changes of plans and scenarios `verify` refuses, of every field in every way; the table in docs/methods/verify.md.

    python tests/python/mutation_shares.py [OF_EACH [MINUTES]]    goes on where the last run ended (build/mutations), each at most so long
    python tests/python/mutation_shares.py --write                puts the shares of the last run into the page

Of places that differ in indices alone OF_EACH (4) are tried. It fails on a change that goes unnoticed without a reason, on a
reason that nothing needs, and on a share below the least.
"""

from __future__ import annotations

import json
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import plan_mutations
import scenario_mutations
from conftest import REPOSITORY
from field_changes import Change, Harmless, all_changes, changed, explained, pattern

FOLDER = REPOSITORY / "build" / "mutations"
PAGE = REPOSITORY / "docs" / "methods" / "verify.md"
BEGIN, END = "<!-- shares: written by tests/python/mutation_shares.py -->", "<!-- end of shares -->"
SMALL = ("more", "less")
ENOUGH = 4  # places of a kind that tell whether a reason is needed


class Case(NamedTuple):
    title: str
    harmless: Harmless
    least: float
    """Share that must be refused [%]."""
    any_holds: str = ""
    """Why each of its changes may hold; the least share keeps `verify` from looking less closely than it does."""


CASES = {
    "alone": Case("a plan without a scenario, what it says itself", plan_mutations.HARMLESS, 99.0),
    "stored": Case("the scenario stored in such a plan", {}, 85.0, "another problem, which the plan solves as well"),
    "beside": Case("a plan beside its scenario", plan_mutations.HARMLESS, 99.0),
    "scenario": Case("a scenario beside its plan", scenario_mutations.HARMLESS, 98.0),
}
TOGETHER, LEAST_TOGETHER = ("beside", "scenario"), 99.0
"""Cases whose changes are counted together, and the share of them that must be refused [%]."""
Judge = Callable[[dict[str, Any]], dict[str, bool]]


def documents(folder: Path) -> Iterator[tuple[str, dict[str, Any], Judge]]:
    """What is changed, under its name, and which cases refuse it."""
    kept = folder / "plan.json"
    if not kept.exists():
        kept.write_text(json.dumps(plan_mutations.plan_and_scenario(folder)))
    plan, expected = json.loads(kept.read_text())
    alone = plan_mutations.refuses(None, 200)

    def of_plan(values: dict[str, Any]) -> dict[str, bool]:
        by_itself = alone(values)
        return {"alone": by_itself, "beside": by_itself or plan_mutations.differs(values, expected)}

    yield "plan", plan, of_plan
    scenario = scenario_mutations.whole_scenario()
    told = scenario_mutations.tells(scenario, folder)
    yield "scenario", scenario, lambda values: {"scenario": told(values)}


def run(of_each: int, minutes: float) -> bool:
    """Tries what was not tried yet; whether everything is."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    is_whole = True
    for name, document, judge in documents(FOLDER):
        ends = time.monotonic() + 60 * minutes
        answers = FOLDER / f"{name}_{of_each}.jsonl"
        done = len(answers.read_text().splitlines()) if answers.exists() else 0
        assert done or not any(judge(document).values()), f"the {name} as it was made is refused"
        changes = list(all_changes(document, of_each))
        order = Random(1).sample(range(len(changes)), len(changes))  # what was tried so far is a fair sample of all
        with answers.open("a") as out:
            for number in range(done, len(changes)):
                if time.monotonic() > ends:
                    print(f"{name}: {number} of {len(changes)} tried")
                    is_whole = False
                    break
                change = changes[order[number]]
                refused = judge(changed(document, change.place, change.new))
                out.write(json.dumps({"field": change.field, "kind": change.kind, **refused}) + "\n")
                out.flush()
    return is_whole


def results(case: str, of_each: int) -> list[tuple[Change, bool]]:
    """Each change that was tried, and whether it was refused."""
    file = FOLDER / f"{'scenario' if case == 'scenario' else 'plan'}_{of_each}.jsonl"
    rows = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    answer = "alone" if case == "stored" else case
    some = [r for r in rows if case not in ("alone", "stored") or (r["field"][0] == "scenario") == (case == "stored")]
    return [(Change(tuple(r["field"]), r["kind"], (), None), r[answer]) for r in some]


def share(count: int, of: int) -> str:
    return f"{100 * count / of:.2f} %" if of else "-"


def faults(case: str, of_each: int, is_whole: bool) -> list[str]:
    """What is wrong with the answers; that every reason is needed shows when all changes were tried."""
    tried = results(case, of_each)
    left = [change for change, refused in tried if not refused]
    found = [
        f"{case}: {pattern(c.field)}: {c.kind}: not refused, and no reason given"
        for c in left
        if not explained(c, CASES[case].harmless) and not CASES[case].any_holds
    ]
    reasons = {name for name in CASES[case].harmless if case != "alone" or not name.startswith("scenario.")}
    unneeded = reasons - {pattern(change.field) for change in left} if is_whole else set()
    found += [f"{case}: {name}: listed as harmless, every change was refused" for name in sorted(unneeded)]
    if 100 * len(left) > (100 - CASES[case].least) * len(tried):
        found.append(f"{case}: {len(left)} of {len(tried)} not refused: less than {CASES[case].least} % are")
    return found


def all_together(of_each: int) -> tuple[int, int]:
    """How many of the changes of a plan and of a scenario, each beside the other, were refused, and how many there were."""
    answers = [refused for case in TOGETHER for _, refused in results(case, of_each)]
    return sum(answers), len(answers)


def table(of_each: int) -> str:
    """The shares as the page has them: by the size of a change, and of each reason."""
    lines = [
        f"Every field is changed in every way that its kind has ({of_each} of those places that differ in indices alone):",
        "",
    ]
    lines += ["| what is changed | changes | refused | small ones (2 %, or 0.01) | others |", "|---|---|---|---|---|"]
    reasons = ["| not refused | changes | share | why |", "|---|---|---|---|"]
    for name, case in CASES.items():
        tried = results(name, of_each)
        row = [case.title, str(len(tried)), share(sum(refused for _, refused in tried), len(tried))]
        for is_small in (True, False):
            some = [refused for change, refused in tried if (change.kind in SMALL) == is_small]
            row.append(f"{sum(some)} of {len(some)}, {share(sum(some), len(some))}")
        lines.append("| " + " | ".join(row) + " |")
        left = Counter(pattern(change.field) for change, refused in tried if not refused)
        if case.any_holds:
            left = Counter({f"{len(left)} fields": sum(left.values())} if left else {})
        for field, count in sorted(left.items(), key=lambda item: (-item[1], item[0])):
            why = case.any_holds or case.harmless.get(field, ("", "no reason given"))[1]
            reasons.append(
                f"| {name}: {field if case.any_holds else f'`{field}`'} | {count} | {share(count, len(tried))} | {why} |"
            )
    good, count = all_together(of_each)
    lines += ["", f"The last two together: {good} of {count}, {share(good, count)}."]
    return "\n".join([*lines, "", *reasons])


def write(of_each: int) -> None:
    text = PAGE.read_text()
    before, rest = text.split(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n\n{table(of_each)}\n\n{END}{rest.split(END)[1]}")


def main() -> int:
    words = [float(word) for word in sys.argv[1:] if word != "--write"]
    of_each = int(words[0]) if words else 4
    if "--write" in sys.argv:
        write(of_each)
        return 0
    is_whole = run(of_each, words[1] if len(words) > 1 else 1e6)
    print(table(of_each))
    print(f"{sum(len(results(case, of_each)) for case in ('alone', 'stored', 'beside', 'scenario'))} tries")
    wrong = [fault for case in CASES for fault in faults(case, of_each, is_whole and of_each >= ENOUGH)]
    refused, tried = all_together(of_each)
    if 100 * refused < LEAST_TOGETHER * tried:
        wrong.append(f"plan and scenario together: {refused} of {tried} refused, less than {LEAST_TOGETHER} %")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
