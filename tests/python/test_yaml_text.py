"""YAML texts that are refused with the line, and YAML 1.2's numbers."""

from __future__ import annotations

import math

import pytest

import mmgrasp as mg
from mmgrasp.documents.yaml_text import parse_yaml

BOMB = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{new}: &{new} [{', '.join(['*' + old] * 10)}]\n" for old, new in zip("abcdefgh", "bcdefghi", strict=True)
)
NESTED_ALIASES = "a0: &a0 [x]\n" + "".join(f"a{i + 1}: &a{i + 1} [*a{i}]\n" for i in range(60))

REFUSED = {
    "a bomb of aliases": (BOMB, "more than 100000 values"),
    "aliases nested too deeply": (NESTED_ALIASES, "nested more than 50 deep"),
    "an alias of itself": ("a: &a [1, *a]\n", "nothing that is complete"),
    "an unknown alias": ("a: *b\n", "nothing that is complete"),
    "an anchor twice": ("a: &x 1\nb: &x 2\n", "the anchor 'x' is given twice"),
    "a bool tag": ("name: !!bool abc\n", "tag"),
    "a timestamp tag": ("name: !!timestamp abc\n", "tag"),
    "a python tag": ("a: !!python/object:os.system x\n", "tag"),
    "a tagged list": ("a: !!set {x, y}\n", "tag"),
    "3000 brackets": ("a: " + "[" * 3000, "deep"),
    "900 brackets": ("a: " + "[" * 900 + "]" * 900, "deep"),
    "900 levels of a block": ("".join("  " * i + "a:\n" for i in range(900)), "deep"),
    "a key twice": ("a: 1\nb: 2\na: 3\n", ":3: a: is given twice"),
    "a key that is a number": ("1: 2\n", "a key must be a name"),
    "a key that is a list": ("? [a]\n: 2\n", "a key must be a name"),
    "two documents": ("a: 1\n---\nb: 2\n", "one document"),
    "an open bracket": ("a: [1, 2\nb: 3\n", "is no valid YAML"),
    "a control character": ("a: \x07\n", "is no valid YAML"),
    "a tab for blanks": ("a:\n\t- 1\n", "is no valid YAML"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refused(what: str) -> None:
    text, piece = REFUSED[what]
    with pytest.raises(mg.InvalidInput) as caught:
        parse_yaml(text, "file.yaml")
    assert str(caught.value).startswith("file.yaml"), caught.value
    assert piece in str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("010", 10), ("0o10", 8), ("0x1F", 31), ("1:30", "1:30"), ("1_000", "1_000"), ("1e-3", 0.001), ("1e3", 1000.0),
        ("+.5", 0.5), ("-1.", -1.0), (".inf", math.inf), ("-.INF", -math.inf), ("yes", "yes"), ("on", "on"),
        ("True", True), ("FALSE", False), ("~", None), ("", None), ("null", None), ("'010'", "010"),
        ("!!str 10", "10"), ("2001-01-01", "2001-01-01"), ("0b101", "0b101"), ("<<", "<<"), ("1e400", math.inf),
    ],
)  # fmt: skip
def test_scalars_are_those_of_yaml_1_2(text: str, value: object) -> None:
    read = parse_yaml(f"a: {text}\n", "file.yaml")[0]["a"]
    assert read == value
    assert type(read) is type(value)


def test_aliases_are_values_and_lines_are_known() -> None:
    values, lines = parse_yaml("pose: &p {xyz: [1, 2, 3]}\nother:\n  - *p\n", "file.yaml")
    assert values == {"pose": {"xyz": [1, 2, 3]}, "other": [{"xyz": [1, 2, 3]}]}
    assert lines[("other",)] == 2
    assert lines[("pose", "xyz")] == 1
    assert math.isnan(parse_yaml("a: .nan", "f")[0]["a"])
    assert parse_yaml("", "f")[0] == {}
