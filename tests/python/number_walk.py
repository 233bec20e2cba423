"""Calls everything that the stubs show with each of its numbers set to what no number should be (test_numbers.py).

Each try must return or refuse (mg.Error, TypeError, ValueError) within two seconds of processor time and some memory,
or end by Ctrl-C. Tries run in a process of their own, so that one that ends or hangs is told by name:

    python tests/python/number_walk.py [NAME...]      all tries of the calls whose names begin so, and their outcomes
"""

from __future__ import annotations

import collections
import json
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import types
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

import mmgrasp as mg
from argument_calls import CALLS, Call, Parameter, callable_of, other_arguments
from argument_objects import OBJECTS
from number_tables import QUICK, UNBOUNDED

NAN, INFINITY = float("nan"), float("inf")
VALUES: dict[str, Any] = {
    "nan": NAN,
    "inf": INFINITY,
    "-inf": -INFINITY,
    "-1": -1,
    "0": 0,
    "1e-300": 1e-300,
    "1e300": 1e300,
    "1e160": 1e160,
    "2**31-1": 2**31 - 1,
    "2**63": 2**63,
    "-2**63": -(2**63),
    "True": True,
    "a word": "x",
    "None": None,
    "complex": 1j,
    "a huge list": [0.5] * 10**6,
}
NEVER = ("nan", "-inf", "1e160", "a word", "complex", "a huge list")  # no number takes these
# Names under which a message tells of a parameter that is no single number, or goes to another object.
ALSO_NAMED = {
    "base_limits": ("linear_velocity",),
    "joints": ('joint "i"',),
    "values": ('joint "i"',),
    "height": ("offset",),
    "arg1": ("padding",),
}
GIGABYTE = 2**30
SOFT, HARD = 2.0, 8  # [s] of processor time: when Ctrl-C comes, and when a try that does not hear it is ended
LONGEST = 600.0  # [s] that a try may take on the clock, when others use the processor


class Try(NamedTuple):
    function: str
    parameter: str
    value: str

    def __str__(self) -> str:
        return f"{self.function}({self.parameter}={self.value})"


def is_number(annotation: str) -> bool:
    plain = re.sub(r"collections\.abc\.Callable\[.*", "", annotation)
    return re.search(r"\b(float|int)\b", plain) is not None


def numbers() -> list[tuple[Call, str, str]]:
    """(call, parameter, annotation) of every number that the stubs show, but for methods that are there to be
    replaced."""
    ours = [call for call in CALLS if not call.function.startswith("NonlinearProblem.")]
    return [(call, p.name, p.annotation) for call in ours for p in call.parameters if is_number(p.annotation)]


def tries(names: Iterable[str] = ("",), values: Iterable[str] = tuple(VALUES)) -> list[Try]:
    found = [Try(call.function, name, value) for call, name, _ in numbers() for value in values]
    return [one for one in dict.fromkeys(found) if one.function.startswith(tuple(names))]


def shaped(value: Any, annotation: str, name: str) -> Any:
    """The value where the number stands: in a list, in a dict, or itself."""
    if isinstance(value, list):
        return value
    if annotation.startswith("collections.abc.Sequence[collections"):
        return [[value]]
    if annotation.startswith("collections.abc.Sequence[tuple"):
        return [(value, value)]
    if annotation.startswith("collections.abc.Sequence["):
        return [value]
    if annotation.startswith("tuple"):
        return (value, value)
    if annotation.startswith("collections.abc.Mapping"):
        return {"linear_velocity" if name == "base_limits" else "i": value}
    return value


def shown_at(one: Try) -> tuple[Call, Parameter]:
    """The first call, of those shown in several ways, that takes the number."""
    return next((c, p) for c in CALLS if c.function == one.function for p in c.parameters if p.name == one.parameter)


def perform(one: Try) -> Any:
    call, parameter = shown_at(one)
    value = shaped(VALUES[one.value], parameter.annotation, parameter.name)
    if call.is_setter:
        path, _, attribute = call.function.rpartition(".")
        target = OBJECTS[path.rpartition(".")[2]]()
        return lambda: setattr(target, attribute, value)
    needed = tuple(p.name for p in call.parameters if p.is_needed and p.name != parameter.name)
    keywords = other_arguments(call.function, parameter.name, needed)
    keywords = {**keywords, **QUICK.get(call.function, dict)(), parameter.name: value}
    function = callable_of(call.function)
    return lambda: function(**keywords)


class _Interrupt(KeyboardInterrupt):
    pass


def _interrupt(number: int, frame: types.FrameType | None) -> NoReturn:
    raise _Interrupt


def _outcome(one: Try) -> str:
    try:
        action = perform(one)  # builds what the call needs
    except Exception as error:
        return f"no call: {type(error).__name__}: {error}"
    used = resource.getrusage(resource.RUSAGE_SELF)
    spent = used.ru_utime + used.ru_stime
    resource.setrlimit(resource.RLIMIT_CPU, (int(spent) + HARD, resource.RLIM_INFINITY))
    try:
        signal.setitimer(signal.ITIMER_PROF, SOFT)
        try:
            action()
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
    except _Interrupt:
        return "interrupted"
    except (mg.Error, TypeError, ValueError) as error:
        told = one.value not in NEVER or any(
            name in str(error) for name in (one.parameter, *ALSO_NAMED.get(one.parameter, ()))
        )
        return "refused" if told else f"refused for something else: {error}"
    except BaseException as error:
        return f"{type(error).__name__}: {str(error)[:200]}"
    return "returned"


def _work(path: str) -> None:
    """The child: reads tries from stdin, prints each outcome as soon as it is known."""
    signal.signal(signal.SIGPROF, _interrupt)
    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + 2 * GIGABYTE, resource.RLIM_INFINITY))
    with open(path, "w", buffering=1) as out:
        for line in sys.stdin:
            print("?", file=out)
            print(json.dumps(_outcome(Try(*json.loads(line)))), file=out)


def _run(some: list[Try]) -> Iterator[tuple[Try, str]]:
    """As many as one process gets through, the last of them with what ended it."""
    with tempfile.NamedTemporaryFile("r") as answers:
        child = subprocess.Popen(
            [sys.executable, "-W", "ignore", __file__, "--work", answers.name],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        watch = threading.Timer(LONGEST + len(some), child.kill)
        watch.start()
        child.communicate("".join(json.dumps(list(one)) + "\n" for one in some))
        watch.cancel()
        lines = answers.read().splitlines()
    outcomes = [json.loads(line) for line in lines if line != "?"]
    yield from zip(some, outcomes, strict=False)
    if len(outcomes) < len(some):
        ended = "did not hear Ctrl-C" if child.returncode == -signal.SIGXCPU else f"ended with {child.returncode}"
        yield some[len(outcomes)], ended


def walk(some: list[Try]) -> dict[Try, str]:
    outcomes: dict[Try, str] = {}
    while len(outcomes) < len(some):
        outcomes.update(_run(some[len(outcomes) :]))
    return outcomes


def complaint(one: Try, outcome: str) -> str | None:
    """What is wrong about it, if anything. Who goes on with a value until Ctrl-C has taken it, as who returns with
    it."""
    if outcome == "refused":
        return None
    if outcome not in ("returned", "interrupted"):
        return outcome
    if outcome == "returned" and one.function.startswith(("verify.Checked", "verify.PlanToCheck")):
        return None  # wrong values in a plan are faults that the check reports
    how = "took" if outcome == "returned" else "went on, until Ctrl-C, with"
    return f"{how} {one.value}" if never_taken(one) else None


def never_taken(one: Try) -> bool:
    """Whether the parameter must refuse the value: NaN always; what is no number, or beyond all bounds, where one
    number is asked for."""
    if one.value == "nan":
        return True
    is_plain = re.fullmatch(r"(float|int)( \| None)?", shown_at(one)[1].annotation) is not None
    is_unbounded = one.parameter in UNBOUNDED or f"{one.function}.{one.parameter}" in UNBOUNDED
    return is_plain and one.value in (*NEVER, "inf") and not (is_unbounded and one.value in ("inf", "1e160"))


def main(names: list[str]) -> int:
    complaints = 0
    some = tries(names or [""])
    counts: collections.Counter[str] = collections.Counter()
    for first in range(0, len(some), 500):
        outcomes = walk(some[first : first + 500])
        for one, outcome in outcomes.items():
            fault = complaint(one, outcome)
            if fault:
                complaints += 1
                print(f"{one}: {fault}", flush=True)
        counts.update(outcome.split(":")[0] for outcome in outcomes.values())
    print(f"{len(some)} tries: {dict(counts)}; {complaints} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--work"]:
        _work(sys.argv[2])
    else:
        sys.exit(main(sys.argv[1:]))
