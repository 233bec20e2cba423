"""Texts are str: bytes, of which nobody knows the encoding, are refused by every call, in lists and dicts as well."""

from __future__ import annotations

from typing import Any

import pytest

import mmgrasp as mg
from argument_calls import CALLS, callable_of, other_arguments
from number_tables import QUICK

WRONG: dict[str, Any] = {"str": b"table", "collections.abc.Sequence[str]": [b"table"], "str | None": b"table"}
OWN = {"where", "message"}  # of a Fault, whose other arguments here are none either
TEXTS = [(c, p) for c in CALLS for p in c.parameters if p.annotation in WRONG and p.name not in OWN and not c.is_setter]


def test_there_are_many() -> None:
    assert len(TEXTS) > 60


@pytest.mark.parametrize(("call", "parameter"), TEXTS, ids=lambda x: getattr(x, "function", getattr(x, "name", "")))
def test_bytes_are_no_texts(call: Any, parameter: Any) -> None:
    needed = tuple(p.name for p in call.parameters if p.is_needed and p.name != parameter.name)
    keywords = {**other_arguments(call.function, parameter.name, needed), **QUICK.get(call.function, dict)()}
    with pytest.raises((TypeError, mg.InvalidInput)) as refused:
        callable_of(call.function)(**{**keywords, parameter.name: WRONG[parameter.annotation]})
    assert "bytes" not in str(refused.value).split(":")[0]
    assert parameter.name in str(refused.value)
