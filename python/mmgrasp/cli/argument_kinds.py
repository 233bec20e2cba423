"""Kinds of values on the command line: each takes a text, or refuses it with one message."""

from __future__ import annotations

import argparse
import math
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..documents.reading import LONGEST_NAME


def path(text: str) -> Path:
    """A path that is not empty."""
    if not text or "\0" in text:
        raise argparse.ArgumentTypeError(f"{text!r}: must be a path that is not empty")
    return Path(text)


def plan(text: str) -> Path:
    """A plan's file, or the folder that `mmgrasp plan` filled."""
    given = path(text)
    inside = given / "plan.json"
    return inside if os.path.isdir(given) else given


def source(text: str) -> str:
    """Path of a file, or the name of a shipped one."""
    return str(path(text))


def name(text: str) -> str:
    """A name that can stand in a file and on a terminal; whether there is one is looked up later."""
    if not text or len(text) > LONGEST_NAME or not text.isprintable():
        raise argparse.ArgumentTypeError(f"{text!r:.80}: must be a name of 1 to {LONGEST_NAME} printable characters")
    return text


def address(text: str) -> str:
    """The address of a Dask scheduler."""
    found = re.fullmatch(r"[a-z]+://(?:\[[0-9a-fA-F:]+\]|[^\s/:]+):([0-9]{1,5})", text, re.ASCII)
    if not found or not 1 <= int(found[1]) <= 65535:
        raise argparse.ArgumentTypeError(f"{text!r:.80}: must be an address tcp://host:port")
    return text


@dataclass(frozen=True)
class Number:
    """A number in plain digits, with its bounds and their unit."""

    least: float
    most: float
    unit: str
    is_whole: bool = False
    scale: float = 1
    """The value taken is so much times what is written."""

    def __call__(self, text: str) -> Any:
        if self.is_whole:
            plain = text.isascii() and text.isdigit() and len(text) < 20
            if not plain or not self.least <= int(text) <= self.most:
                raise argparse.ArgumentTypeError(
                    f"{text!r}: must be a whole number, at least {self.least} and at most {self.most} {self.unit}".rstrip()
                )
            return int(text)
        value = number(text)
        if not self.least <= value <= self.most:
            raise argparse.ArgumentTypeError(
                f"{text!r}: must be a number from {self.least:.10g} to {self.most:.10g} {self.unit}".rstrip()
            )
        return value * self.scale


def count(least: int, most: int, unit: str) -> Number:
    """A whole number of something."""
    return Number(least, most, unit, is_whole=True)


threads = count(0, 1024, "threads")
seed = count(0, 2**31 - 1, "")

length = Number(0, 1, "m")
voxel = Number(1e-4, 10, "m")
sigmas = Number(0, 100, "")
incidence = Number(0.1, 1.5, "rad")
gate = Number(3, 1000, "standard deviations")
megabytes = Number(1, 1e7, "MB", scale=1e6)
coordinate = Number(-1e6, 1e6, "m or rad")


def direction(text: str) -> list[float]:
    """Three numbers X,Y,Z that are not all zero."""
    values = [number(part) for part in text.split(",")]
    if len(values) != 3 or not all(abs(x) <= 1e6 for x in values) or not any(abs(x) > 1e-6 for x in values):
        raise argparse.ArgumentTypeError(
            f"{text!r}: must be a direction X,Y,Z other than 0,0,0, of numbers up to 1e+06"
        )
    return values


def base(text: str) -> list[float]:
    """Where a robot's root stands: X,Y,Z,HEADING [m, m, m, rad]."""
    values = [number(part) for part in text.split(",")]
    if len(values) != 4 or not all(abs(x) <= 1e6 for x in values):
        raise argparse.ArgumentTypeError(f"{text!r}: must be X,Y,Z,HEADING, four numbers of at most 1e+06 m and rad")
    return values


def number(text: str) -> float:
    """NaN for what is none."""
    plain = text.isascii() and "_" not in text and text == text.strip()
    try:
        return float(text) if plain else math.nan
    except ValueError:
        return math.nan


def package(text: str) -> tuple[str, str]:
    """A ROS package's name and its folder, NAME=DIR."""
    key, found, folder = text.partition("=")
    if not found or not key or not folder:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=DIR")
    if not Path(folder).is_dir():
        raise argparse.ArgumentTypeError(f"{folder!r} is no folder")
    return key, folder


def mount(text: str) -> tuple[str, str]:
    """File of a robot and the link it is put on."""
    file, found, link = text.rpartition("=")
    if not found or not file or not link or not text.isprintable():
        raise argparse.ArgumentTypeError(f"{text!r:.80} is not FILE=LINK")
    return file, link


def xacro_argument(text: str) -> tuple[str, str]:
    """An argument of a xacro file and its value, NAME=VALUE."""
    key, found, value = text.partition("=")
    if not found or not key:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE")
    return key.removesuffix(":"), value  # xacro's own command writes NAME:=VALUE
