"""Where the site listens: whether it can, whether it does, and how that is told."""

from __future__ import annotations

import errno
import socket
import ssl
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError

if TYPE_CHECKING:
    from study.settings import Settings

EVERYWHERE: Final = {"0.0.0.0": "127.0.0.1", "::": "::1", "": "127.0.0.1"}
"""Hosts that mean every address of this machine, with one at which it can be reached from here."""


def welcome(settings: Settings, title: str, password: str | None) -> list[str]:
    """Return the lines that are printed once the site is up."""
    from study.commands.researcher import FIRST_NAME

    address = address_of(settings)
    lines = ["", title, f"  participants  {address}/", f"  researchers   {address}/researcher"]
    if password is not None:
        lines += [f"                name {FIRST_NAME}, password {password}"]
        lines += ["                (shown this once; ocularist researcher add makes another)"]
    return [*lines, "  stop          Ctrl-C", ""]


def address_of(settings: Settings) -> str:
    """Return the address to type into a browser."""
    scheme = "https" if settings.is_encrypted else "http"
    host = socket.gethostname() if settings.host in EVERYWHERE else settings.host
    return f"{scheme}://{f'[{host}]' if ':' in host else host}:{settings.port}"


def check_port(settings: Settings) -> None:
    """Raise CommandError if the site could not listen where the settings say."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    try:
        socket.create_server((settings.host, settings.port), family=family).close()
    except OSError as error:
        raise CommandError(_why_no_port(error, settings)) from None


def check_certificate(settings: Settings) -> None:
    """Raise CommandError, or OSError naming a file, if the site could not speak TLS with these."""
    cert, key = settings.tls_cert, settings.tls_key
    if cert is None or key is None:
        return
    for file in (cert, key):  # ssl's own error does not say which
        file.open("rb").close()
    try:
        # Without the callback OpenSSL would ask the terminal for a password.
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(cert, key, password=lambda: "")
    except (ssl.SSLError, ValueError) as error:
        raise CommandError(
            f"{cert} and {key}: no certificate with its private key ({_reason(error)}); both have "
            "to be PEM files, and the key may not be locked with a password"
        ) from None


def _reason(error: Exception) -> str:
    return getattr(error, "reason", None) or str(error)


def _why_no_port(error: OSError, settings: Settings) -> str:
    if error.errno == errno.EADDRINUSE:
        return (
            f"port {settings.port} on {settings.host} is in use, perhaps by another study; stop "
            "that one or choose another port with --port"
        )
    if error.errno == errno.EACCES:
        return f"port {settings.port} may not be used; choose one from 1024 on with --port"
    return f"cannot listen on {settings.host}, port {settings.port}: {error.strerror or error}"


def answers(settings: Settings) -> bool:
    """Say whether somebody listens at the site's port."""
    host = EVERYWHERE.get(settings.host, settings.host)
    try:
        socket.create_connection((host, settings.port), timeout=1.0).close()
    except OSError:
        return False
    return True
