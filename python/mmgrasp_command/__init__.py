"""The entry of the command `mmgrasp`. It stands beside the package, because Ctrl-C while that one loads shall end it without a word, and what keeps
it from loading (a broken installation, no memory) with one."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable


def main() -> int:
    """Runs `mmgrasp.cli.main` and returns the exit code."""
    interruptible = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if interruptible:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        run = _load()
    except Exception as error:
        first: BaseException = error
        while first.__cause__ is not None:  # what a library says of it may be a page
            first = first.__cause__
        reason = " ".join(str(first).split()) or type(first).__name__
        sys.stderr.write(f"mmgrasp: cannot be loaded: {reason} (too little memory, ulimit -v, has this effect, too)\n")
        return 2
    if interruptible:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return run()


def _load() -> Callable[[], int]:
    from mmgrasp.cli import main as run

    return run
