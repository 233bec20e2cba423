"""How many changes of plans and scenarios `verify` refuses, of every field in every way; the table in
docs/methods/verify.md.

    python tests/python/mutation_shares.py [OF_EACH [MINUTES]]    each document at most so long
    python tests/python/mutation_shares.py --write                puts the shares of the last run into the page

A run goes on where the last one ended (build/mutations) as long as it is the same code that judges the same changes;
where that one had come to the end, and for other code, it begins anew. Of places that differ in indices alone OF_EACH
(4) are tried. A run fails on a change that goes unnoticed without a reason, on a reason that nothing needs, and on a
share below the least.
"""

from __future__ import annotations

import hashlib
import inspect
import json
import shutil
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import mmgrasp as mg
import plan_mutations
import scenario_mutations
from conftest import REPOSITORY
from field_changes import Change, Harmless, all_changes, changed, explained, pattern
from mmgrasp import _core

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
JUDGES = (plan_mutations.refused_early, plan_mutations.judge, scenario_mutations.tells)
SAMPLES = 200  # base poses at each stop


class Document(NamedTuple):
    name: str
    content: dict[str, Any]
    judge: Judge
    """Which cases refuse a changed one."""


def hashed(*contents: bytes) -> str:
    found = hashlib.sha256()
    for content in contents:
        found.update(len(content).to_bytes(8, "big") + content)
    return found.hexdigest()


def package_files() -> list[Path]:
    """What of mmgrasp answers: its modules and schemas, and all that is compiled of it."""
    package, compiled = Path(mg.__file__).parent, Path(str(_core.__file__)).parent
    return sorted({*package.rglob("*.py"), *package.rglob("*.schema.json"), *compiled.glob("*.so*")})


def code_key() -> str:
    """A hash of what judges: mmgrasp, and the functions here that ask it."""
    files = [hashed(path.name.encode(), path.read_bytes()) for path in package_files()]
    return hashed("".join(files).encode(), *(inspect.getsource(judge).encode() for judge in JUDGES))


def changes_key(code: str, content: Any, changes: list[Change]) -> str:
    """A hash of what is judged: by which code, which document, and which changes of it in which order."""
    listed = [[change.field, change.kind] for change in changes]
    return hashed(code.encode(), json.dumps(content).encode(), json.dumps(listed).encode())


def kept_plan(folder: Path, code: str) -> tuple[dict[str, Any], Path]:
    """The plan, made once by each code, and its scenario beside it."""
    kept = folder / f"plan_{code[:16]}.json"
    if not kept.exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        plan, _ = plan_mutations.plan_and_scenario(folder)
        kept.write_text(json.dumps(plan))
    return json.loads(kept.read_text()), folder / "scenario.yaml"


def documents(folder: Path) -> Iterator[Document]:
    plan, beside = kept_plan(folder / "plan", code_key())
    yield Document("plan", plan, plan_mutations.judge(beside, SAMPLES))
    scenario = scenario_mutations.whole_scenario()
    (folder / "scenario").mkdir(parents=True, exist_ok=True)
    told = scenario_mutations.tells(scenario, folder / "scenario")
    yield Document("scenario", scenario, lambda values: {"scenario": told(values)})


class Answers:
    """The answers about one document's changes, in a file that begins with the hash of what was judged."""

    def __init__(self, document: Document, of_each: int) -> None:
        self.document = document
        changes = list(all_changes(document.content, of_each))
        # What was tried so far is a fair sample of all.
        self.changes = [changes[i] for i in Random(1).sample(range(len(changes)), len(changes))]
        self.code = code_key()
        self.key = changes_key(self.code, document.content, self.changes)
        self.file = answers_file(document.name, of_each)
        first, *rows = self.file.read_text().splitlines() if self.file.exists() else [""]
        self.done = len(rows) if first and json.loads(first) == self.header else 0

    @property
    def header(self) -> dict[str, str]:
        return {"code": self.code, "key": self.key}

    @property
    def is_whole(self) -> bool:
        return self.done == len(self.changes)

    def begin_anew(self) -> None:
        document = self.document
        assert not any(document.judge(document.content).values()), f"the {document.name} as it was made is refused"
        self.file.parent.mkdir(parents=True, exist_ok=True)
        self.file.write_text(json.dumps(self.header) + "\n")
        self.done = 0

    def go_on(self, minutes: float) -> int:
        """Judges what was not judged yet; how many."""
        if not self.done:
            self.begin_anew()
        ends = time.monotonic() + 60 * minutes
        judged = 0
        with self.file.open("a") as out:
            for change in self.changes[self.done :]:
                if time.monotonic() > ends:
                    print(f"{self.document.name}: {self.done} of {len(self.changes)} tried")
                    break
                refused = self.document.judge(changed(self.document.content, change.place, change.new))
                out.write(json.dumps({"field": change.field, "kind": change.kind, **refused}) + "\n")
                out.flush()
                self.done += 1
                judged += 1
        return judged


class Count(NamedTuple):
    """Changed documents, each counted once, in however many cases it is judged."""

    judged: int
    kept: int
    """Those of earlier runs of the same code."""
    is_whole: bool

    def __str__(self) -> str:
        kept = f"{self.kept} more in earlier runs of this code"
        return f"{self.judged} tries: changed documents judged now, each counted once; {kept}"


def run(of_each: int, minutes: float) -> Count:
    """Tries what was not tried yet by this code; all of it where there is nothing left."""
    all_answers = [Answers(document, of_each) for document in documents(FOLDER)]
    if all(answers.is_whole for answers in all_answers):
        for answers in all_answers:
            answers.begin_anew()
    kept = sum(answers.done for answers in all_answers)
    judged = sum(answers.go_on(minutes) for answers in all_answers)
    return Count(judged, kept, all(answers.is_whole for answers in all_answers))


def answers_file(name: str, of_each: int) -> Path:
    return FOLDER / f"{name}_{of_each}.jsonl"


def results(case: str, of_each: int) -> list[tuple[Change, bool]]:
    """Each change that was tried, and whether it was refused."""
    file = answers_file("scenario" if case == "scenario" else "plan", of_each)
    rows = [json.loads(line) for line in file.read_text().splitlines()[1:]] if file.exists() else []
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
    """How many of the changes of a plan and of a scenario, each beside the other, were refused, and how many there
    were."""
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


def is_old(of_each: int) -> bool:
    """Whether answers are there of another code than today's."""
    files = [answers_file(name, of_each) for name in ("plan", "scenario")]
    headers = [json.loads(file.read_text().splitlines()[0]) for file in files if file.exists()]
    return any(header.get("code") != code_key() for header in headers) or not headers


def write(of_each: int) -> None:
    text = PAGE.read_text()
    before, rest = text.split(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n\n{table(of_each)}\n\n{END}{rest.split(END)[1]}")


def all_faults(of_each: int, is_whole: bool) -> list[str]:
    wrong = [fault for case in CASES for fault in faults(case, of_each, is_whole and of_each >= ENOUGH)]
    refused, tried = all_together(of_each)
    if 100 * refused < LEAST_TOGETHER * tried:
        wrong.append(f"plan and scenario together: {refused} of {tried} refused, less than {LEAST_TOGETHER} %")
    return wrong


def main() -> int:
    words = [float(word) for word in sys.argv[1:] if word != "--write"]
    of_each = int(words[0]) if words else 4
    if "--write" in sys.argv:
        if is_old(of_each):
            print("there are no answers of this code: run it first", file=sys.stderr)
            return 2
        write(of_each)
        return 0
    count = run(of_each, words[1] if len(words) > 1 else 1e6)
    wrong = all_faults(of_each, count.is_whole)
    print("\n".join([table(of_each), *wrong, f"{count}; {len(wrong)} complaints"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
