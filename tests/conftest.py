"""What all tests share: a Ctrl-C that reaches the programs they start."""

from __future__ import annotations

import signal


def pytest_configure() -> None:
    """Heed SIGINT even where whoever started the tests ignores it, as a shell's ``&`` does.

    Programs started from here inherit what is ignored, and some tests press Ctrl-C on them.
    """
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
