"""How objects of the C++ module come back from a pickle: through a constructor, so that none is ever there half made."""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

Made = TypeVar("Made", covariant=True)


class _Restorable(Protocol[Made]):
    def _from_state(self, state: tuple[Any, ...]) -> Made: ...


def restored(kind: _Restorable[Made], state: tuple[Any, ...]) -> Made:
    """An object of this class with the state that its `__reduce__` gave."""
    return kind._from_state(state)
