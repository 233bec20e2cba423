"""What long calls report to."""

from collections.abc import Callable

Progress = Callable[[str, float], None] | None
"""Called with a stage and the fraction of it that is done, in [0, 1]; None: nobody listens."""
