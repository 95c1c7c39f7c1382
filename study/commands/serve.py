"""``ocularist serve``: the site alone, on a machine that needs no GL."""

from __future__ import annotations

import argparse

from study.commands.options import add_listening, add_places, add_study, settings_of

HELP = "run the site alone"
DESCRIPTION = (
    "Run the participants' and the researchers' pages. Clips are rendered elsewhere: by ocularist "
    "worker on the same database and clips' folder, or beforehand by ocularist render."
)
GRACE_S = 5  # for answers on their way when the site is told to stop


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    add_places(parser)
    add_listening(parser)
    parser.add_argument("--quiet", action="store_true", help="do not print the addresses")


def run(options: argparse.Namespace) -> int:
    """Serve until stopped by Ctrl-C or SIGTERM."""
    import uvicorn

    from study.commands.listening import check_port, welcome
    from study.commands.preparing import prepare
    from study.commands.researcher import add_first
    from study.site.app import create_app

    settings = settings_of(options)
    check_port(settings)
    prepared = prepare(settings, options.study)
    password = add_first(prepared.db)
    prepared.db.close()  # the site opens its own
    if not options.quiet:
        print("\n".join(welcome(settings, prepared.study.title, password)), flush=True)
    uvicorn.run(
        create_app(settings, study=prepared.study),
        host=settings.host,
        port=settings.port,
        log_level="warning",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=GRACE_S,
        ssl_certfile=settings.tls_cert,
        ssl_keyfile=settings.tls_key,
    )
    return 0
