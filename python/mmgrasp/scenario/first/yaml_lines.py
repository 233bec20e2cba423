"""Values as YAML, with comments."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..._files import printable

_PLAIN = re.compile(r"[A-Za-z_./][A-Za-z0-9_./+ -]*\Z")
_WORDS = ("true", "false", "null", "yes", "no", "none", "on", "off", "~")
_WIDTH = 140


def flow(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{flow(key)}: {flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, str):
        plain = _PLAIN.match(value) and value.lower() not in _WORDS and value == value.strip()
        return value if plain else json.dumps(value, ensure_ascii=False)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Sequence):
        return "[" + ", ".join(flow(item) for item in value) + "]"
    return _number(float(value)) if isinstance(value, float) else str(value)


def _number(value: float) -> str:
    text = f"{value + 0.0:.8g}"
    text = text if float(text) == value else repr(value)
    return text if any(c in text for c in ".e") else text + ".0"


def section(name: str, rows: Mapping[str, Any], notes: Mapping[str, str] | None = None) -> list[str]:
    """A key with a mapping below it, a row a line, and what is said of a row behind it or, where that is too long, before it."""
    lines = [f"{name}:"]
    for key, value in rows.items():
        line = f"  {flow(key)}: {flow(value)}"
        note = printable((notes or {}).get(key, ""))
        if len(line) > _WIDTH and isinstance(value, Mapping):
            lines += [f"  # {note}"] if note else []
            lines.append(f"  {flow(key)}:")
            lines += [f"    {flow(k)}: {flow(v)}" for k, v in value.items()]
        elif note and len(line) + len(note) + 4 > _WIDTH:
            lines += [f"  # {note}", line]
        else:
            lines.append(line + (f"  # {note}" if note else ""))
    return lines


def rounded(values: Sequence[float] | np.ndarray, digits: int = 4) -> list[float]:
    """Plain numbers, without a minus before zero."""
    return [round(float(x), digits) + 0.0 for x in values]
