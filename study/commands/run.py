"""``ocularist run``: site and renderer side by side, and how far the clips are."""

from __future__ import annotations

import argparse
import signal
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from study.commands.listening import answers, check_certificate, check_port, welcome
from study.commands.options import add_listening, add_places, add_study, settings_of

if TYPE_CHECKING:
    from study.commands.preparing import Prepared
    from study.commands.processes import Kept
    from study.settings import Settings

HELP = "run a study: site and renderer"
DESCRIPTION = (
    "Start the site and the renderer as two processes, print the addresses, and show how far the "
    "clips are. Ctrl-C stops both; everything that was answered or rendered stays."
)
EXAMPLE = "my-study.toml --port 8080"
TICK_S: Final = 0.5
NICENESS: Final = 10  # pages come first when the processor is busy drawing


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    add_places(parser)
    add_listening(parser)


def run(options: argparse.Namespace) -> int:
    """Run until stopped."""
    from study.commands.preparing import prepare
    from study.commands.processes import stop_all
    from study.commands.rendering import Rendering
    from study.commands.researcher import add_first

    settings = settings_of(options)
    check_port(settings)
    check_certificate(settings)
    prepared = prepare(settings, options.study)
    password = add_first(prepared.db)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    rendering = Rendering(prepared)
    kept = _kept(settings, options.study, say=rendering.say)
    try:
        _start_site(kept, settings, prepared, password)
        while True:
            for entry in kept:
                entry.tick()
            rendering.show()
            time.sleep(TICK_S)
    except KeyboardInterrupt:
        rendering.say("Stopping.")
        return 0
    finally:
        rendering.close()
        stop_all(kept)
        prepared.db.close()


def _start_site(
    kept: list[Kept], settings: Settings, prepared: Prepared, password: str | None
) -> None:
    """Start both, wait until the site answers, then print the addresses once."""
    from study.commands.processes import start_all

    start_all(kept, lambda: answers(settings))
    print("\n".join(welcome(settings, prepared.study.title, password)), flush=True)


def _kept(settings: Settings, study: str, *, say: Callable[[str], None]) -> list[Kept]:
    from study.commands.processes import Kept
    from study.commands.starting import start_rendering, start_serving

    return [
        Kept("site", lambda: start_serving(settings, study), say),
        Kept("renderer", lambda: start_rendering(settings, niceness=NICENESS), say),
    ]
