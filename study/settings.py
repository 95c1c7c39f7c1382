"""Where a study's data lie and where its site listens: from arguments, environment or defaults.

Everything lies in one data folder unless told otherwise. The key that signs cookies is made there
on first use, readable by its owner alone; no secret is ever part of the program.
"""

from __future__ import annotations

import os
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

DATA_FOLDER: Final = Path("ocularist-data")
DEFAULT_HOST: Final = "127.0.0.1"
DEFAULT_PORT: Final = 8000


class SettingsError(ValueError):
    """A setting cannot be used; the message says which and what is accepted."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Everything that differs from one installation to the next."""

    data_folder: Path = DATA_FOLDER
    database_url: str = f"sqlite:///{DATA_FOLDER}/study.sqlite3"
    media_folder: Path = DATA_FOLDER / "clips"
    bench_file: Path = DATA_FOLDER / "bench.json"
    host: str = DEFAULT_HOST
    port: int = DEFAULT_PORT
    tls_cert: Path | None = None
    tls_key: Path | None = None

    @property
    def is_encrypted(self) -> bool:
        """True if the site itself speaks TLS."""
        return self.tls_cert is not None

    @property
    def secret_key_file(self) -> Path:
        """The file of the key that signs cookies."""
        return self.data_folder / "secret-key"

    def secret_key(self) -> str:
        """Return the key that signs cookies; the first call makes it."""
        return read_or_make_secret(self.secret_key_file)


def read_settings(
    environ: Mapping[str, str],
    *,
    data_folder: Path | None = None,
    database: str | None = None,
    media: Path | None = None,
    bench: Path | None = None,
    host: str | None = None,
    port: int | None = None,
    tls_cert: Path | None = None,
    tls_key: Path | None = None,
) -> Settings:
    """Combine arguments, environment and defaults; an argument wins over the environment.

    The environment's names are OCULARIST_DATA, OCULARIST_DATABASE, OCULARIST_MEDIA,
    OCULARIST_BENCH, OCULARIST_HOST and OCULARIST_PORT. Raises SettingsError for a value that cannot
    be used.
    """
    folder = data_folder or Path(environ.get("OCULARIST_DATA") or DATA_FOLDER)
    media_text, bench_text = environ.get("OCULARIST_MEDIA"), environ.get("OCULARIST_BENCH")
    if (tls_cert is None) != (tls_key is None):
        raise SettingsError("TLS needs both --tls-cert and --tls-key")
    return Settings(
        data_folder=folder,
        database_url=database
        or environ.get("OCULARIST_DATABASE")
        or f"sqlite:///{folder}/study.sqlite3",
        media_folder=media or (Path(media_text) if media_text else folder / "clips"),
        bench_file=bench or (Path(bench_text) if bench_text else folder / "bench.json"),
        host=host or environ.get("OCULARIST_HOST") or DEFAULT_HOST,
        port=port or _port(environ.get("OCULARIST_PORT")),
        tls_cert=tls_cert,
        tls_key=tls_key,
    )


def read_or_make_secret(path: Path) -> str:
    """Return the secret in a file; if there is none, make 256 random bits, readable by the owner.

    Of several processes that come first at once all get the same secret.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists():
        made = path.with_name(f".{path.name}.{os.getpid()}-{secrets.token_hex(4)}")
        descriptor = os.open(made, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600)
        try:
            with os.fdopen(descriptor, "w", encoding="ascii") as file:
                file.write(secrets.token_hex(32))
                file.flush()
                os.fsync(file.fileno())
            _link(made, path)
        finally:
            made.unlink()
    secret = path.read_text(encoding="ascii").strip()
    if len(secret) < 32:
        raise SettingsError(f"{path}: holds no secret of 32 or more characters; delete the file")
    return secret


def _link(made: Path, path: Path) -> None:
    """Give a finished file its name unless another process was faster."""
    try:
        path.hardlink_to(made)
    except FileExistsError:
        return


def _port(text: str | None) -> int:
    if not text:
        return DEFAULT_PORT
    if not text.isdecimal() or not 0 < int(text) < 65536:
        raise SettingsError(f'OCULARIST_PORT: "{text}" is no port; write a number from 1 to 65535')
    return int(text)
