"""The errors of Waymark. Each message says what is wrong, where, and what to do."""

import re

_PLACE = re.compile(r"^([^\n]+?):(\d+)(?::(\d+))?: ")


class Error(Exception):
    """The base of all errors that Waymark raises on purpose.

    ``file``, ``line`` and ``column`` are the place that the message begins with, else None.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        place = _PLACE.match(message)
        self.file: str | None = place.group(1) if place else None
        self.line: int | None = int(place.group(2)) if place else None
        self.column: int | None = int(place.group(3)) if place and place.group(3) else None


class UsageError(Error, ValueError):
    """An argument does not exist or does not fit: an unknown modeling, a wrong option value."""


class InputError(Error, ValueError):
    """An input is wrong: a drive.yaml, a log, arrays, a graph."""


class OutputError(Error, OSError):
    """An output could not be written. No partial file is left under its name."""


class PluginError(Error, RuntimeError):
    """Code of a plugin failed."""


class NotConverged(UserWarning):
    """No minimum was reached. The result is the best state so far, and its warnings say why."""


class DriveWarning(UserWarning):
    """Something about a drive is or may be wrong."""
