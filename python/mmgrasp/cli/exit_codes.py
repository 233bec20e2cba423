"""The exit codes of the command (README)."""

from .._core import Outcome

DONE, FAULTY, BAD_INPUT, IMPOSSIBLE, NOT_FOUND, INTERRUPTED = 0, 1, 2, 3, 4, 130
NOTHING_USABLE = 3  # none of the frames of a scan


def exit_code(outcome: Outcome) -> int:
    """The exit code of an outcome: without an answer, whether it is proven that there is none or none was found."""
    return {
        Outcome.solved: DONE,
        Outcome.infeasible: IMPOSSIBLE,
        Outcome.stopped: INTERRUPTED,
        Outcome.invalid_start: BAD_INPUT,
        Outcome.invalid_goal: BAD_INPUT,
    }.get(outcome, NOT_FOUND)
