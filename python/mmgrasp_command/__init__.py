"""The entry of the command `mmgrasp`. It stands beside the package, because Ctrl-C while that one loads shall end it without a word."""

import signal


def main() -> int:
    """Runs `mmgrasp.cli.main` and returns the exit code."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        from mmgrasp.cli import main as run

        signal.signal(signal.SIGINT, signal.default_int_handler)
    else:
        from mmgrasp.cli import main as run
    return run()
