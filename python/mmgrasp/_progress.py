"""What long calls report to."""

from collections.abc import Callable, Collection

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


def growing(progress: Progress, in_passes: Collection[str] = ()) -> Progress:
    """The caller's function, which hears of each stage only fractions that grow.

    Stages named `in_passes` begin anew several times, nobody knows how often: each pass is half of what the ones before left.
    """
    if progress is None:
        return None
    heard_last: dict[str, float] = {}
    shown: dict[str, tuple[float, float]] = {}  # what the pass fills
    furthest: dict[str, float] = {}

    def hear(stage: str, fraction: float) -> None:
        low, high = shown.get(stage, (0.0, 0.5 if stage in in_passes else 1.0))
        if fraction < heard_last.get(stage, 0.0) and stage in in_passes:
            low, high = high, (1 + high) / 2
        shown[stage], heard_last[stage] = (low, high), fraction
        furthest[stage] = max(furthest.get(stage, 0.0), low + (high - low) * fraction)
        progress(stage, furthest[stage])

    return hear
