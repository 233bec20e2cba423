"""The calls of same_answers.py. Each returns what is compared, by part, and a few figures for people."""

from . import bases, grasps, manipulation, motions, robots, rounds
from .lookup import CALLS, SETTINGS, Skipped

__all__ = ["CALLS", "SETTINGS", "Skipped", "bases", "grasps", "manipulation", "motions", "robots", "rounds"]
