"""Which errors are the user's to mend, and how they are told: a line each, no traceback."""

from __future__ import annotations

import errno
from collections.abc import Sequence
from pathlib import Path
from typing import Final


class CommandError(Exception):
    """A command cannot go on; the message says why and what to do."""


# What our own modules raise with a message written for users: ValueError for input that does not
# fit, OSError for files and ports, RuntimeError for a missing driver, ImportError for a part that
# this machine was set up without. Anything else is our mistake and shows its traceback.
USER_ERRORS: Final = (CommandError, ValueError, OSError, RuntimeError, ImportError)
_OF_A_DISK: Final = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS}


def is_ours(error: Exception) -> bool:
    """Say whether an error is a mistake in the program although its type is a user's error."""
    ours = ("analysis", "renderer", "study")
    return isinstance(error, ImportError) and (error.name or "").partition(".")[0] in ours


def one_line(place: str, error: Exception) -> str:
    """Write an error as ``place: message``, one line per fault that the message holds."""
    return "\n".join(f"{place}: {line}" for line in message_of(error).splitlines())


def name_place(error: Exception, places: Sequence[Path | None]) -> Exception:
    """Say where: a full disk ends a write without naming what was written.

    ``places`` are those that the command writes to; the first that is there is named.
    """
    if isinstance(error, OSError) and error.errno in _OF_A_DISK and error.filename is None:
        error.filename = next((str(place) for place in places if place is not None), None)
    return error


def message_of(error: Exception) -> str:
    """Return the words of an error, completed where Python's own say too little."""
    if isinstance(error, ImportError) and error.name:
        package = error.name.partition(".")[0]
        return f"needs {package}, which is not installed here; pip install {package}"
    if isinstance(error, OSError) and error.strerror and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return str(error) or type(error).__name__
