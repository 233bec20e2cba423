"""What long calls report to."""

import contextlib
from collections.abc import Callable, Collection, Iterator

Progress = Callable[[str, float], None] | None
"""Called with a stage and the fraction of it that is done, in [0, 1]; with the same once a second while a call says nothing new. None: nobody listens."""

_MARK = "_raised_by_the_caller"


def heard(progress: Progress) -> Progress:
    """The caller's function, whose errors are marked: what words errors anew lets them pass."""
    if progress is None:
        return None

    def hear(stage: str, fraction: float) -> None:
        try:
            progress(stage, fraction)
        except BaseException as error:
            setattr(error, _MARK, True)
            raise

    return hear


def is_callers(error: BaseException) -> bool:
    """Whether the error came from the caller's own function."""
    return getattr(error, _MARK, False)


@contextlib.contextmanager
def growing(progress: Progress, in_passes: Collection[str] = ()) -> Iterator[Progress]:
    """The caller's function, which hears of each stage only fractions that grow, and 1 of all when the block ends.

    Stages named `in_passes` begin anew several times, nobody knows how often: each pass is half of what the ones before left.
    """
    if progress is None:
        yield None
        return
    heard_last: dict[str, float] = {}
    shown: dict[str, tuple[float, float]] = {}  # what the pass fills
    furthest: dict[str, float] = {}

    def hear(stage: str, fraction: float) -> None:
        low, high = shown.get(stage, (0.0, 0.5 if stage in in_passes else 1.0))
        if fraction < heard_last.get(stage, 0.0) / 2 and stage in in_passes:
            low, high = high, (1 + high) / 2
        shown[stage], heard_last[stage] = (low, high), fraction
        furthest[stage] = max(furthest.get(stage, 0.0), low + (high - low) * fraction)
        progress(stage, furthest[stage])

    yield hear
    for stage, share in furthest.items():
        if share < 1:
            progress(stage, 1.0)
