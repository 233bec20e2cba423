"""The folder that `mmgrasp plan` or `mmgrasp scan` writes: all of one run and nothing of an older one."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

from .._core import InvalidInput, IoError
from .._files import DRAFT, check_folder, read_text, temporary_room, write_file
from .signals import uninterrupted

LIST = "files.json"
PLAN_FILES = (
    *("plan.json", "timings.json", "drive_by.json", "report.html", LIST, "trajectories"),
    *("topview.png", "regions.png", "stop_*.png", "pick_*.png"),
)
_LARGEST_LIST = 100_000_000


@contextlib.contextmanager
def _removed_draft(path: Path) -> Iterator[Path]:
    """A folder to write into, gone after the block: also where no more files can be opened, for which one handle is kept back."""
    try:
        spare = os.open(os.devnull, os.O_RDONLY)
        draft = Path(tempfile.mkdtemp(dir=path, prefix=DRAFT))
    except OSError as error:
        raise IoError(f"{path}: cannot be written: {error.strerror}") from None
    try:
        yield draft
    finally:
        os.close(spare)
        for folder, _, files in os.walk(draft, topdown=False):  # one handle at a time, unlike shutil.rmtree
            for name in files:
                os.unlink(os.path.join(folder, name))
            os.rmdir(folder)


class OutputFolder:
    """One folder, made ready before the work and filled after it. `own`: patterns of the names that the command writes, `folder`:
    which of them are folders of files.

    Everything is written beside its place and moved there at the end; what files.json lists of an earlier run goes. A folder that holds
    files under our names which it does not list is refused: they could be somebody's, and played for the new run's. So is one
    whose files.json is that of another command.
    """

    def __init__(self, path: Path, own: tuple[str, ...] = PLAN_FILES, folder: str = "trajectories") -> None:
        self.path = Path(os.path.realpath(path))
        self._own = own
        self._folder = folder
        check_folder(self.path)
        listed = self._listed()
        others = sorted(name for name in listed if not any(fnmatchcase(name.split("/")[0], one) for one in own))
        if others:
            raise IoError(f"{path}: holds {others[0]}, written by another command of mmgrasp: choose another folder")
        foreign = sorted(self._own_files() - listed)
        if foreign:
            names = ", ".join(foreign[:3]) + (f" and {len(foreign) - 3} more" if len(foreign) > 3 else "")
            raise IoError(
                f"{path}: holds {names}, which {LIST} there does not list: remove them or choose another folder"
            )

    @contextlib.contextmanager
    def filled(self, *, added: bool = False, replacing: str = "") -> Iterator[Path]:
        """A folder to write into; its files come to their places when the block ends without an error.

        `added`: to what is there already, instead of in the place of everything; older files of the pattern `replacing` go all the same.
        """
        self.path.mkdir(parents=True, exist_ok=True)
        for left in self.path.glob(f"{DRAFT}*"):  # of a run that was killed
            shutil.rmtree(left, ignore_errors=True)
        with _removed_draft(self.path) as draft:
            try:
                with temporary_room(self.path):
                    yield draft
                with uninterrupted():
                    self._take_over(draft, added, replacing)
            except OSError as error:
                if isinstance(error, (IoError, BrokenPipeError)):
                    raise
                raise IoError(f"{self.path}: cannot be written: {error.strerror or error}") from None

    def _take_over(self, draft: Path, added: bool, replacing: str) -> None:
        written = {str(p.relative_to(draft).as_posix()) for p in draft.rglob("*") if p.is_file()} | {LIST}
        old = self._listed()
        new = written | {name for name in old if added and not fnmatchcase(name, replacing)}
        self._write_list(old | new)  # whoever is killed between here and the end leaves only files that are listed
        for name in sorted(written - {LIST}):
            (self.path / name).parent.mkdir(exist_ok=True)
            os.replace(draft / name, self.path / name)
        for name in sorted(old - new):
            with contextlib.suppress(FileNotFoundError):
                (self.path / name).unlink()
            with contextlib.suppress(OSError):
                (self.path / name).parent.rmdir()
        self._write_list(new)

    def _write_list(self, names: set[str]) -> None:
        write_file(self.path / LIST, json.dumps({"format": "mmgrasp-files", "files": sorted(names)}, indent=1) + "\n")

    def _own_files(self) -> set[str]:
        """What lies under names of ours: whatever is in folders of ours, and links, folders or devices in the place of a file."""
        found = {p.name for pattern in self._own for p in self.path.glob(pattern)}
        found |= {name for name in self._own if os.path.lexists(self.path / name)}
        for name in sorted(found):
            inside = self.path / name
            if fnmatchcase(name, self._folder) and inside.is_dir() and not inside.is_symlink():
                found.remove(name)
                found |= {f"{name}/{p.name}" for p in inside.iterdir()}
        return found

    def _listed(self) -> set[str]:
        """Files that an earlier run wrote here, as files.json says: below this folder, and files."""
        path = self.path / LIST
        if not path.is_file() or path.is_symlink():
            return set()
        try:
            content = json.loads(read_text(path, _LARGEST_LIST))
            if content["format"] != "mmgrasp-files":
                return set()
            names = [PurePosixPath(name) for name in content["files"]]
        except (ValueError, KeyError, TypeError, RecursionError, InvalidInput):
            return set()
        good = [n for n in names if not n.is_absolute() and ".." not in n.parts and len(n.parts) <= 2]
        return {str(n) for n in good if (self.path / n).is_file() and not (self.path / n).is_symlink()}
