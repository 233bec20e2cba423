"""Files: read and written with care, found relative to the file that names them."""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from ._core import IoError

ASSETS = Path(__file__).parent / "assets"
LARGEST_FILE = 4_000_000_000  # of a mesh or any other part of a robot [bytes], as in C++
DRAFT = ".writing."  # begins the names of folders that are being filled
_NO_PLACES = ("/dev", "/proc", "/sys")
SCHEMAS = Path(__file__).parent / "schemas"


def shipped(path: str | os.PathLike[str]) -> Path:
    """The path itself, or with `asset:` in front the file of that name in the shipped assets."""
    text = os.fspath(path)
    return ASSETS / text.removeprefix("asset:") if text.startswith("asset:") else Path(text)


def check_folder(path: Path) -> None:
    """Raises IoError unless files can be written into the folder, which is made for the trial and removed again: for calls that work long before they write."""
    made: list[Path] = []
    try:
        real = os.path.realpath(path)
        if any(os.path.commonpath([real, place]) == place for place in _NO_PLACES) and not real.startswith("/dev/shm"):
            raise IoError(f"{printable(os.fspath(path))}: cannot be written: devices and processes are there, no files")
        for folder in reversed([path, *path.parents]):
            if not folder.exists():
                folder.mkdir()
                made.append(folder)
            elif not folder.is_dir():
                raise IoError(f"{printable(os.fspath(path))}: cannot be written: {folder} is no folder")
        handle, trial = tempfile.mkstemp(dir=path, prefix=".trial.")
        os.close(handle)
        os.unlink(trial)
    except IoError:
        raise
    except FileExistsError:
        raise IoError(f"{printable(os.fspath(path))}: cannot be written: a link on the way leads nowhere") from None
    except (OSError, ValueError) as error:
        raise _cannot_write(path, error) from None
    finally:
        for folder in reversed(made):
            with contextlib.suppress(OSError):
                folder.rmdir()


PNG = b"\x89PNG\r\n\x1a\n"  # begins pictures


def check_file(path: Path, begins: bytes) -> None:
    """Raises IoError unless a file can be written there: see check_folder. What is there already must begin with `begins`, as what is to
    be written does: anything else may be what is about to be read, or somebody's, and is not replaced."""
    target = _target(path)
    check_folder(target.parent)
    if target.exists() and read_head(target, len(begins)) not in (b"", begins):
        raise IoError(
            f"{printable(os.fspath(path))}: is there already, not as an earlier result, and is not replaced: give another name"
        )


def check_new_file(path: Path) -> None:
    """Raises IoError unless nothing is there and a file can be written there."""
    if os.path.lexists(path):
        raise IoError(f"{printable(os.fspath(path))}: is there already and is not replaced: give another name")
    check_folder(_target(path).parent)


@contextlib.contextmanager
def temporary_room(folder: Path) -> Iterator[None]:
    """Within the block temporary files may be made: in the folder where no place for them can be written. (Drawing needs one.)"""
    try:
        tempfile.gettempdir()
    except FileNotFoundError:
        folder.mkdir(parents=True, exist_ok=True)
        with draft_folder(folder) as draft:
            tempfile.tempdir = str(draft)
            try:
                yield
            finally:
                tempfile.tempdir = None
    else:
        yield


@contextlib.contextmanager
def draft_folder(within: Path) -> Iterator[Path]:
    """A folder to write into, gone after the block. It is locked until then, which tells it from that of a run that was killed.

    Goes also where no more files can be opened: the lock's handle is given back first. Raises OSError.
    """
    draft, handle = _locked_draft(within)
    try:
        yield draft
    finally:
        os.close(handle)
        for folder, _, files in os.walk(draft, topdown=False):  # one handle at a time, unlike shutil.rmtree
            with contextlib.suppress(FileNotFoundError):  # no longer locked: another run may remove it, too
                for name in files:
                    os.unlink(os.path.join(folder, name))
                os.rmdir(folder)


def _locked_draft(within: Path) -> tuple[Path, int]:
    """A new folder and the handle that holds its lock. Until it is locked another run may take it for a dead one and remove it: then the next is tried."""
    while True:
        draft = Path(tempfile.mkdtemp(dir=within, prefix=DRAFT))
        try:
            handle = os.open(draft, os.O_RDONLY | os.O_DIRECTORY)
        except FileNotFoundError:
            continue
        except BaseException:
            draft.rmdir()
            raise
        try:
            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(handle, fcntl.LOCK_EX)
            if draft.is_dir():  # nobody removes it any more
                return draft, handle
        except BaseException:
            with contextlib.suppress(OSError):
                draft.rmdir()
            os.close(handle)
            raise
        os.close(handle)


def remove_dead_drafts(within: Path) -> None:
    """Removes the drafts of runs that were killed: those that nobody holds."""
    for left in within.glob(f"{DRAFT}*"):
        with contextlib.suppress(OSError):
            handle = os.open(left, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)  # raises where somebody writes there
                shutil.rmtree(left, ignore_errors=True)
            finally:
                os.close(handle)


def _cannot_write(path: Path, error: Exception) -> IoError:
    reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return IoError(f"{printable(os.fspath(path))}: cannot be written: {reason}")


def _target(path: Path) -> Path:
    """Where a file is really written: links are followed, and nothing but a regular file is replaced."""
    try:
        target = Path(os.path.realpath(path))
        kind = os.lstat(target).st_mode
    except FileNotFoundError:
        return target
    except (OSError, ValueError) as error:
        raise _cannot_write(path, error) from None
    if not stat.S_ISREG(kind):
        what = "is a folder" if stat.S_ISDIR(kind) else "is no regular file"
        raise IoError(f"{printable(os.fspath(path))}: cannot be written: {what}")
    return target


def write_file(path: Path, content: str | bytes) -> None:
    """Writes all or nothing: a reader never sees half a file. Of a link the file is replaced that it leads to. What has no UTF-8 (of a path's name, say) is written as escapes."""
    data = content.encode(errors="backslashreplace") if isinstance(content, str) else content
    target = _target(path)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, draft = tempfile.mkstemp(dir=target.parent, prefix=".draft.")
    except (OSError, ValueError) as error:
        raise _cannot_write(path, error) from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(draft, 0o666 & ~umask)
        os.replace(draft, target)
    except OSError as error:
        raise _cannot_write(path, error) from None
    finally:
        if os.path.exists(draft):
            os.unlink(draft)


def write_files(folder: Path, contents: dict[str, str], *patterns: str) -> list[Path]:
    """Writes files of one result into a folder; returns their paths. Raises IoError, and writes nothing, where the folder holds others of
    the patterns: those of an older result could be taken for this one's."""
    older = sorted(p.name for pattern in patterns for p in folder.glob(pattern) if p.name not in contents)
    if older:
        raise IoError(
            f"{printable(os.fspath(folder))}: holds {printable(some_of(older))} of another result: remove them or choose another folder"
        )
    for name, content in contents.items():
        write_file(folder / name, content)
    return [folder / name for name in contents]


def write_result(path: Path, content: str) -> None:
    """As write_file, for what took long to find: where it cannot be written it is put among the temporary files, and the IoError names the place."""
    try:
        write_file(path, content)
    except IoError as error:
        try:
            kept = Path(tempfile.mkdtemp(prefix="mmgrasp.")) / path.name
            write_file(kept, content)
        except OSError:
            raise error from None
        raise IoError(f"{error}; what was to be written there is in {printable(os.fspath(kept))}") from None


def read_text(path: Path, most: int) -> str:
    """The text of a regular file of at most `most` bytes; raises IoError otherwise."""
    try:
        return read_bytes(path, most).decode("utf-8")
    except UnicodeDecodeError as error:
        raise IoError(f"{printable(os.fspath(path))}: is no UTF-8 text (byte {error.start})") from None


def read_bytes(path: Path, most: int) -> bytes:
    """The content of a regular file of at most `most` bytes; raises IoError otherwise."""
    return _read(path, None, most)


def read_head(path: Path, count: int) -> bytes:
    """The first `count` bytes of a regular file, or all it has; raises IoError."""
    return _read(path, count, None)


def _read(path: Path, count: int | None, most: int | None) -> bytes:
    with _regular_file(path) as file:
        # Not read(most): Python sets aside as much memory as it is asked for.
        fits = most is None or os.fstat(file.fileno()).st_size <= most
        data = file.read(-1 if count is None else count) if fits else None
        if data is None or (most is not None and len(data) > most):
            raise IoError(f"{printable(os.fspath(path))}: cannot be read: is larger than {most} bytes")
    return data


@contextlib.contextmanager
def _regular_file(path: Path) -> Iterator[BinaryIO]:
    shown = printable(os.fspath(path))
    try:
        with open(path, "rb", opener=_open_now) as file:
            found = os.fstat(file.fileno())
            if stat.S_ISDIR(found.st_mode):
                raise IoError(f"{shown}: cannot be read: is a folder")
            if not stat.S_ISREG(found.st_mode):
                raise IoError(f"{shown}: cannot be read: is no regular file")
            yield file
    except OSError as error:
        if isinstance(error, IoError):
            raise
        raise IoError(f"{shown}: cannot be read: {error.strerror or error}") from None
    except ValueError as error:
        raise IoError(f"{shown}: cannot be read: {error}") from None


def _open_now(path: str, flags: int) -> int:
    return os.open(path, flags | os.O_NONBLOCK)  # a pipe without a writer does not block


def some_of(names: list[str]) -> str:
    """The first of the names, and how many more there are."""
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def printable(text: str) -> str:
    """The text with what would move a terminal's cursor, or cannot be encoded, written as escapes."""
    return "".join(
        c if c.isprintable() or c == "\n" else c.encode("unicode_escape", "surrogatepass").decode() for c in text
    )


def sha256_of(path: str | Path) -> str:
    """SHA-256 of a regular file; raises IoError."""
    found = hashlib.sha256()
    with _regular_file(Path(path)) as file:
        while block := file.read(1 << 20):
            found.update(block)
    return found.hexdigest()
