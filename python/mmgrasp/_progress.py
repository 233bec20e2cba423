"""What long calls report to."""

from collections.abc import Callable

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
