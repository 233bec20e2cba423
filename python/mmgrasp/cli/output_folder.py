"""The folder that `mmgrasp plan` or `mmgrasp scan` writes: all of one run and nothing of an older one."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Set
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

from .._core import Error, InvalidInput, IoError
from .._files import (
    check_folder,
    draft_folder,
    printable,
    read_text,
    remove_dead_drafts,
    sha256_of,
    some_of,
    temporary_room,
)
from .signals import uninterrupted

LIST = "files.json"
PLAN_FILES = (
    *("plan.json", "timings.json", "drive_by.json", "report.html", LIST, "trajectories"),
    *("topview.png", "regions.png", "stop_*.png", "pick_*.png"),
)
_LARGEST_LIST = 100_000_000
_OLD = "old"  # in a draft: the files that it takes the place of


class OutputFolder:
    """One folder, made ready before the work and filled after it. `own`: patterns of the names that the command writes, the main file first, `folder`:
    which of them are folders of files, `goes_on`: those that the command goes on with and looks at itself: they get no checksums, and are
    replaced in one step, never out of the way.

    Everything is written beside its place and moved there at the end; what files.json lists of an earlier run goes. A folder that holds
    files under our names which it does not list is refused: they could be somebody's, and played for the new run's. So is one where a
    listed file is no longer the one that was written, or whose files.json is that of another command. What somebody else puts under our
    names while the command works is not replaced either.
    """

    def __init__(
        self,
        path: Path,
        own: tuple[str, ...] = PLAN_FILES,
        folder: str = "trajectories",
        *,
        goes_on: tuple[str, ...] = (),
    ) -> None:
        self.path = Path(os.path.realpath(path))
        self._own = own
        self._folder = folder
        self._goes_on = goes_on
        check_folder(self.path)
        listed = self._listed()
        others = sorted(name for name in listed if not any(fnmatchcase(name.split("/")[0], one) for one in own))
        if others:
            raise IoError(f"{path}: holds {others[0]}, written by another command of mmgrasp: choose another folder")
        foreign = sorted(self._own_files() - listed.keys())
        if foreign:
            raise IoError(
                f"{path}: holds {some_of(foreign)}, which {LIST} there does not list: remove them or choose another folder"
            )
        changed = sorted(name for name, known in listed.items() if known and sha256_of(self.path / name) not in known)
        if changed:
            raise IoError(
                f"{path}: holds {some_of(changed)}, changed since mmgrasp wrote it: move it away or choose another folder"
            )
        self._known = self._marks()

    def fill(self, write: Callable[[Path], object], *, added: bool = False, replacing: str = "") -> None:
        """Has `write` fill the folder (see `filled`). Where that fails, what was made is not lost: it is written into another folder, and the
        IoError that is raised names it."""
        try:
            with self.filled(added=added, replacing=replacing) as draft:
                write(draft)
        except IoError as error:
            kept = self._kept_elsewhere(write)
            if kept is None:
                raise
            raise IoError(f"{error}; what was to be written there is in {printable(str(kept))}") from None

    @contextlib.contextmanager
    def illustrated(self) -> Iterator[Path]:
        """As `filled`, for pictures and pages of what the folder holds already. Raises IoError that says so where they fail."""
        try:
            with self.filled(added=True) as draft:
                yield draft
        except BrokenPipeError:
            raise
        except KeyboardInterrupt as ended:  # or Ended, with the signal's number
            ended.args = (self._without_pictures(),)
            raise
        except (Error, OSError, MemoryError, ImportError) as error:
            reason = "out of memory" if isinstance(error, MemoryError) else error
            raise IoError(f"{reason}: {self._without_pictures()}") from None

    def _without_pictures(self) -> str:
        return f"the results are in {printable(str(self.path))}, without all of their pictures and report"

    @contextlib.contextmanager
    def filled(self, *, added: bool = False, replacing: str = "") -> Iterator[Path]:
        """A folder to write into; its files come to their places when the block ends without an error.

        `added`: to what is there already, instead of in the place of everything; older files of the pattern `replacing` go all the same.
        """
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise IoError(f"{self.path}: cannot be written: {error.strerror}") from None
        remove_dead_drafts(self.path)
        try:
            with draft_folder(self.path) as draft:
                with temporary_room(self.path):
                    yield draft
                with uninterrupted():
                    self._take_over(draft, added, replacing)
        except OSError as error:
            if isinstance(error, (IoError, BrokenPipeError)):
                raise
            raise IoError(f"{self.path}: cannot be written: {error.strerror or error}") from None

    def _take_over(self, draft: Path, added: bool, replacing: str) -> None:
        files = {str(p.relative_to(draft).as_posix()): p for p in draft.rglob("*") if p.is_file() and p.name != LIST}
        written = {name: set() if self._goes_on_with(name) else {sha256_of(path)} for name, path in files.items()}
        self._refuse_what_came()
        old = {name: known for name, known in self._listed().items() if name != LIST}
        new = {name: known for name, known in old.items() if added and not fnmatchcase(name, replacing)} | written
        both = {name: old.get(name, set()) | new.get(name, set()) for name in old | new}
        self._write_list(both, draft)  # whoever is killed between here and the end leaves only files that are listed
        self._exchange(draft, old.keys() - new.keys(), written.keys())
        self._write_list(new, draft)
        self._known = self._marks()

    def _exchange(self, draft: Path, gone: Set[str], written: Set[str]) -> None:
        """Puts the files of the draft in the place of what is there and of what is to go. Of the main files the old one goes first and the
        new one comes last: whoever is killed in between leaves none beside files of another run."""
        main_last = sorted(written, key=lambda name: (name == self._own[0], name))
        with _all_or_none() as move:
            for name in [*reversed(main_last), *sorted(gone)]:
                if not self._goes_on_with(name) and (self.path / name).exists():
                    move(self.path / name, draft / _OLD / name)
            for name in main_last:
                move(draft / name, self.path / name)
        for name in gone:
            with contextlib.suppress(FileNotFoundError):
                (self.path / name).unlink()
            with contextlib.suppress(OSError):
                (self.path / name).parent.rmdir()

    def _goes_on_with(self, name: str) -> bool:
        return any(fnmatchcase(name, pattern) for pattern in self._goes_on)

    def _refuse_what_came(self) -> None:
        """Raises IoError where, since the folder was last looked at, somebody wrote a file under a name of ours."""
        came = sorted(name for name, mark in self._marks().items() if self._known.get(name) != mark)
        if came:
            raise IoError(
                f"{printable(str(self.path))}: {some_of(came)}: written by somebody else in the meantime, and left alone"
            )

    def _marks(self) -> dict[str, tuple[int, int, int]]:
        """What tells each file under a name of ours from one that took its place."""
        marks = {}
        for name in self._own_files():
            with contextlib.suppress(FileNotFoundError):
                found = os.lstat(self.path / name)
                marks[name] = (found.st_ino, found.st_mtime_ns, found.st_size)
        return marks

    def _kept_elsewhere(self, write: Callable[[Path], object]) -> Path | None:
        """A new folder beside this one, or else among the temporary files, with what could not be written here; None where that fails, too."""
        for beside in (self.path.parent, None):
            try:
                place = Path(tempfile.mkdtemp(dir=beside, prefix=f"{self.path.name[:50]}."))
            except OSError:
                continue
            try:
                with OutputFolder(place, self._own, self._folder).filled() as draft:
                    write(draft)
            except IoError:
                shutil.rmtree(place, ignore_errors=True)
            else:
                return place
        return None

    def _write_list(self, files: dict[str, set[str]], draft: Path) -> None:
        listed = {name: sorted(known) for name, known in sorted((files | {LIST: set()}).items())}
        (draft / LIST).write_text(json.dumps({"format": "mmgrasp-files", "files": listed}, indent=1) + "\n")
        os.replace(draft / LIST, self.path / LIST)

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

    def _listed(self) -> dict[str, set[str]]:
        """Files that an earlier run wrote here, as files.json says, below this folder, and the checksums that each may have (none: not known)."""
        path = self.path / LIST
        if not path.is_file() or path.is_symlink():
            return {}
        try:
            content = json.loads(read_text(path, _LARGEST_LIST))
            if content["format"] != "mmgrasp-files":
                return {}
            files = content["files"]
            if not isinstance(files, dict):  # the list of names of earlier versions
                files = {name: [] for name in files}
            names = {PurePosixPath(name): {str(one) for one in known} for name, known in files.items()}
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError, InvalidInput):
            return {}
        good = [n for n in names if not n.is_absolute() and ".." not in n.parts and len(n.parts) <= 2]
        return {str(n): names[n] for n in good if (self.path / n).is_file() and not (self.path / n).is_symlink()}


@contextlib.contextmanager
def _all_or_none() -> Iterator[Callable[[Path, Path], None]]:
    """Hands out a function that moves a file to a name of its own; where one cannot be moved, all go back."""
    moved: list[tuple[Path, Path]] = []

    def move(source: Path, target: Path) -> None:
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(source, target)
        moved.append((source, target))

    try:
        yield move
    except OSError:
        for source, target in reversed(moved):
            with contextlib.suppress(OSError):
                os.replace(target, source)
        raise
