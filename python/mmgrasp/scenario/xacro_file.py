"""xacro files expanded by the optional package `xacro`, without ROS: $(find NAME) is answered as package://NAME is."""

from __future__ import annotations

import contextlib
import io
import logging
import threading
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from .. import _core
from .._core import InvalidInput, IoError
from .._files import read_bytes, read_text

LARGEST_TEXT = 256_000_000  # [bytes], as of a URDF
_LOCK = threading.Lock()  # the package keeps what it works on in module variables


def read_or_expand(path: str, package_dirs: Mapping[str, str], xacro_args: Mapping[str, Any] | None) -> str:
    """The text of a file; of a file called .xacro, what it expands to."""
    if path.endswith(".xacro"):
        return expand(path, package_dirs, xacro_args)
    return read_text(Path(path), LARGEST_TEXT)


def expand(
    path: str, package_dirs: Mapping[str, str] | None = None, xacro_args: Mapping[str, Any] | None = None
) -> str:
    """XML text of a xacro file. Macros are programs: expand only files you trust."""
    try:
        import xacro
        from xacro import substitution_args
    except ImportError:
        raise InvalidInput(f"{path}: is xacro, which needs the package xacro: pip install 'mmgrasp[xacro]'") from None
    arguments = _arguments(xacro_args)
    if not Path(path).is_file():
        raise IoError(f"file {path}: " + ("is a folder" if Path(path).is_dir() else "does not exist"))

    def find(name: str) -> str:
        folder = _core.find_package(name, str(Path(path).resolve().parent), dict(package_dirs or {}))
        if not folder:
            raise InvalidInput(f'package "{name}" not found; name its folder with package_dirs {{"{name}": ...}}')
        return folder

    parse = xacro.parse

    def parse_plain(text: Any, filename: str | None = None) -> Any:
        if text is None and filename is not None:
            content = read_bytes(Path(filename), LARGEST_TEXT)
            for word in (b"<!DOCTYPE", b"<!ENTITY"):
                if word in content.upper():
                    raise InvalidInput(f"{word.decode()}> declarations are refused")
        return parse(text, filename)

    printed = io.StringIO()
    patches = (
        _patched(vars(xacro), "parse", parse_plain),
        _patched(vars(substitution_args), "_eval_find", find),
        _patched(substitution_args._eval_dict, "find", find),  # what $(eval ...) sees
    )
    with _LOCK, contextlib.ExitStack() as stack:
        for patch in patches:
            stack.enter_context(patch)
        try:
            with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
                expanded: str = xacro.process_file(path, mappings=arguments, verbosity=0).toprettyxml(indent="  ")
        except Exception as error:  # the package raises whatever its expressions raise
            place = next((file for file in reversed(xacro.filestack or []) if file), path)
            inside = "" if str(place) == path else f" (in {place})"
            cause = getattr(error, "exc", None)  # the package wraps what $(find ...) raised
            message = str(cause if isinstance(cause, InvalidInput) else error) or type(error).__name__
            raise InvalidInput(f"{path}{inside}: xacro cannot be expanded: {message}") from error
    if printed.getvalue().strip():
        logging.getLogger("mmgrasp").warning("%s: %s", path, " ".join(printed.getvalue().split()))
    return expanded


def _arguments(given: Mapping[str, Any] | None) -> dict[str, str]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InvalidInput(f"xacro_args = {given!r}: must be a dict from argument to value")
    arguments = {}
    for name, value in given.items():
        if not isinstance(name, str) or not isinstance(value, (str, bool, int, float)):
            raise InvalidInput(f"xacro_args[{name!r}] = {value!r}: must be a string, number or bool under a name")
        arguments[name] = str(value).lower() if isinstance(value, bool) else str(value)
    return arguments


@contextlib.contextmanager
def _patched(names: dict[str, Any], name: str, value: Any) -> Iterator[None]:
    kept = names[name]
    names[name] = value
    try:
        yield
    finally:
        names[name] = kept
