"""Files: written under a temporary name and renamed, found relative to the file that names them."""

from __future__ import annotations

import hashlib
import os
import tempfile
from pathlib import Path

from ._core import IoError

ASSETS = Path(__file__).parent / "assets"
SCHEMAS = Path(__file__).parent / "schemas"


def shipped(path: str | os.PathLike[str]) -> Path:
    """The path itself, or with `asset:` in front the file of that name in the shipped assets."""
    text = os.fspath(path)
    return ASSETS / text.removeprefix("asset:") if text.startswith("asset:") else Path(text)


def check_folder(path: Path) -> None:
    """Raises IoError unless the folder is there or can be made: for calls that work long before they write."""
    there = path
    while not there.exists() and there != there.parent:
        there = there.parent
    if not there.is_dir():
        raise IoError(f"{path}: cannot be written: {there} is no folder")
    if not os.access(there, os.W_OK | os.X_OK):
        raise IoError(f"{path}: cannot be written: no permission to write into {there}")


def write_file(path: Path, content: str | bytes) -> None:
    """Writes all or nothing: a reader never sees half a file."""
    data = content.encode() if isinstance(content, str) else content
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, draft = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        raise IoError(f"{path}: cannot be written: {error.strerror or error}") from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(draft, 0o666 & ~umask)
        os.replace(draft, path)
    except OSError as error:
        raise IoError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        if os.path.exists(draft):
            os.unlink(draft)


def sha256_of(path: str | Path) -> str:
    try:
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()
    except OSError as error:
        raise IoError(f"{path}: cannot be read: {error.strerror or error}") from None
