"""What the data layer will not do, each with a name that a page can answer calmly."""

from __future__ import annotations


class RefusedError(ValueError):
    """A request that would break the study's rules; nothing was stored."""


class NotReachedError(RefusedError):
    """The request concerns a step or trial that the participant has not come to yet."""


class NotWatchedError(RefusedError):
    """The questionnaire was finished before its clip was watched to the end."""


class WithdrawnError(RefusedError):
    """The participant has withdrawn; nothing more is stored."""


class UnusablePayloadError(RefusedError):
    """A key or payload that cannot be stored: too long, or not plain JSON."""


class TooManyError(RefusedError):
    """Too often in a short time; it may be tried again after ``wait_s`` seconds."""

    def __init__(self, wait_s: int) -> None:
        self.wait_s = wait_s
        super().__init__(f"too many requests; try again in {wait_s} s")


class FormUsedError(RefusedError):
    """A consent form whose participant has gone on since: it is somebody else's, or an old one."""


class StudyConflictError(RefusedError):
    """A study's file was changed after people took part, without a new version."""


class LinkUsedError(RefusedError):
    """A personal link that lets nobody in: used to the end, or by somebody who withdrew."""
