"""The folder that `mmgrasp plan` writes: all of one plan and nothing of an older one."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from .._core import InvalidInput, IoError
from .._files import check_folder, read_text, write_file

LIST = "files.json"
OWN = ("plan.json", "drive_by.json", "report.html", LIST, "trajectories")
PICTURES = ("topview.png", "regions.png", "stop_*.png", "pick_*.png")
_DRAFT = ".writing."
_LARGEST_LIST = 100_000_000


class OutputFolder:
    """One folder, made ready before the planning and filled after it.

    Everything is written beside its place and moved there at the end; what files.json lists of an earlier plan goes. A folder that holds
    files under our names which it does not list is refused: they could be somebody's, and played for the new plan's.
    """

    def __init__(self, path: Path) -> None:
        self.path = Path(os.path.realpath(path))
        check_folder(self.path)
        foreign = sorted(self._own_files() - self._listed())
        if foreign:
            names = ", ".join(foreign[:3]) + (f" and {len(foreign) - 3} more" if len(foreign) > 3 else "")
            raise IoError(
                f"{path}: holds {names}, which {LIST} there does not list: remove them or choose another folder"
            )

    @contextlib.contextmanager
    def filled(self, *, added: bool = False) -> Iterator[Path]:
        """A folder to write into; its files come to their places when the block ends without an error.

        `added`: to what this run has written already, instead of in the place of everything.
        """
        self.path.mkdir(parents=True, exist_ok=True)
        for left in self.path.glob(f"{_DRAFT}*"):  # of a run that was killed
            shutil.rmtree(left, ignore_errors=True)
        draft = Path(tempfile.mkdtemp(dir=self.path, prefix=_DRAFT))
        try:
            yield draft
            self._take_over(draft, added)
        except OSError as error:
            if isinstance(error, IoError):
                raise
            raise IoError(f"{self.path}: cannot be written: {error.strerror or error}") from None
        finally:
            shutil.rmtree(draft, ignore_errors=True)

    def _take_over(self, draft: Path, added: bool) -> None:
        new = {str(p.relative_to(draft).as_posix()) for p in draft.rglob("*") if p.is_file()} | {LIST}
        old = self._listed()
        replaced = set(new)
        if added:
            new |= old
        self._write_list(old | new)  # whoever is killed between here and the end leaves only files that are listed
        for name in sorted(old - new):
            with contextlib.suppress(FileNotFoundError):
                (self.path / name).unlink()
            with contextlib.suppress(OSError):
                (self.path / name).parent.rmdir()
        for name in sorted(replaced - {LIST}):
            (self.path / name).parent.mkdir(exist_ok=True)
            os.replace(draft / name, self.path / name)
        self._write_list(new)

    def _write_list(self, names: set[str]) -> None:
        write_file(self.path / LIST, json.dumps({"format": "mmgrasp-files", "files": sorted(names)}, indent=1) + "\n")

    def _own_files(self) -> set[str]:
        """What lies under names of ours: whatever is in `trajectories`, and links, folders or devices in the place of a file."""
        found = {p.name for pattern in (*OWN, *PICTURES) for p in self.path.glob(pattern)}
        found |= {name for name in OWN if os.path.lexists(self.path / name)}
        inside = self.path / "trajectories"
        if inside.is_dir() and not inside.is_symlink():
            found.remove("trajectories")
            found |= {f"trajectories/{p.name}" for p in inside.iterdir()}
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
