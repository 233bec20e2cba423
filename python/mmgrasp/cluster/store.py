"""A folder of finished shards: one file each, named by the hash of what went in, checked by the hash of what came out."""

from __future__ import annotations

import hashlib
import pickle
from pathlib import Path
from typing import Any

from .._files import write_file

MAGIC = b"mmgrasp shard 1\n"


class ShardStore:
    """Results by key. A file that is damaged or of another kind counts as missing and is written anew."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self._kept: dict[str, Any] = {}  # without a folder

    def path(self, key: str) -> Path | None:
        """File of a shard; None without a folder."""
        return None if self.folder is None else self.folder / key[:2] / f"{key}.shard"

    def get(self, key: str) -> tuple[bool, Any]:
        """(found, result)."""
        path = self.path(key)
        if path is None:
            return key in self._kept, self._kept.get(key)
        try:
            data = path.read_bytes()
        except OSError:
            return False, None
        head, payload = data[: len(MAGIC) + 32], data[len(MAGIC) + 32 :]
        if head != MAGIC + hashlib.sha256(payload).digest():
            return False, None
        return True, pickle.loads(payload)

    def put(self, key: str, result: Any) -> None:
        """Keeps a result: in its file, written whole or not at all, or in memory."""
        path = self.path(key)
        if path is None:
            self._kept[key] = result
            return
        payload = pickle.dumps(result, protocol=5)
        write_file(path, MAGIC + hashlib.sha256(payload).digest() + payload)
