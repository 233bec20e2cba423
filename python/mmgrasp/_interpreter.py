"""Refuses a subinterpreter before the C++ module would wait in it for ever: pybind11's modules know one interpreter."""

import importlib


def _is_main() -> bool:
    for name in ("_interpreters", "_xxsubinterpreters"):  # Python 3.13, and before
        try:
            interpreters = importlib.import_module(name)
        except ImportError:
            continue
        return bool(interpreters.get_current() == interpreters.get_main())
    return True


if not _is_main():
    raise ImportError(
        "mmgrasp cannot be imported in a subinterpreter: its C++ module knows one interpreter; use threads or processes"
    )
