"""The cache of reachability databases: without a place that can be written, planning goes on."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

from . import _core
from ._core import IoError, JointGroup, ReachDatabase
from ._files import check_folder
from ._progress import Progress, heard, is_callers

_REPLACING = "replacing a damaged reachability database"  # stages that ReachDatabase.load_or_build reports
_NOT_KEPT = "the reachability database is not kept: "
_HINT = "planning goes on without the cache: set XDG_CACHE_HOME to a folder that can be written"


def cached_database(arm: JointGroup, progress: Progress = None, **options: Any) -> ReachDatabase:
    """The arm's database from the cache, or built now and kept there if that can be; options of ReachDatabase.build."""
    log = logging.getLogger("mmgrasp")
    progress = heard(progress)

    def hear(stage: str, fraction: float) -> None:
        if stage == _REPLACING:
            log.warning("the reachability database in %s is damaged: it is built anew", _core.cache_folder())
        if stage.startswith(_NOT_KEPT):
            log.warning("%s; %s", stage, _HINT)
        elif progress is not None:
            progress(stage, fraction)

    try:
        check_folder(Path(_core.cache_folder()))
        return ReachDatabase.load_or_build(arm, _core.cache_folder(), progress=hear, **options)
    except IoError as error:
        if is_callers(error):
            raise
        log.warning("%s; %s", error, _HINT)
        return ReachDatabase.build(arm, progress=progress, **options)
