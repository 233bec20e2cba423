"""The command `mmgrasp`: arguments, what each command does, and what it prints."""

from .commands import main as main
