"""Settings: arguments before environment before defaults; a secret made once, for its owner."""

from __future__ import annotations

import stat
import threading
from pathlib import Path

import pytest

from study.settings import SettingsError, read_or_make_secret, read_settings


def test_everything_lies_in_one_folder_by_default() -> None:
    found = read_settings({})
    assert str(found.data_folder) == "ocularist-data"
    assert found.database_url == "sqlite:///ocularist-data/study.sqlite3"
    assert str(found.media_folder) == "ocularist-data/clips"
    assert (found.host, found.port, found.is_encrypted) == ("127.0.0.1", 8000, False)


def test_the_environment_moves_things_and_arguments_win() -> None:
    environ = {
        "OCULARIST_DATA": "/data",
        "OCULARIST_DATABASE": "postgresql://host/name",
        "OCULARIST_HOST": "0.0.0.0",
        "OCULARIST_PORT": "9000",
    }
    found = read_settings(environ)
    assert found.database_url == "postgresql://host/name"
    assert found.media_folder == Path("/data/clips")
    assert (found.host, found.port) == ("0.0.0.0", 9000)
    won = read_settings(
        environ, data_folder=Path("/d"), database="x.sqlite3", media=Path("/m"), host="h", port=1
    )
    assert (won.data_folder, won.database_url, won.media_folder) == (
        Path("/d"),
        "x.sqlite3",
        Path("/m"),
    )
    assert (won.host, won.port) == ("h", 1)
    assert read_settings({"OCULARIST_MEDIA": "/clips"}).media_folder == Path("/clips")


@pytest.mark.parametrize("port", ["x", "0", "65536", "-1"])
def test_a_port_that_is_none_is_refused(port: str) -> None:
    with pytest.raises(SettingsError, match=f'OCULARIST_PORT: "{port}" is no port; write a number'):
        read_settings({"OCULARIST_PORT": port})


def test_tls_needs_certificate_and_key() -> None:
    with pytest.raises(SettingsError, match="needs both --tls-cert and --tls-key"):
        read_settings({}, tls_cert=Path("c"))
    assert read_settings({}, tls_cert=Path("c"), tls_key=Path("k")).is_encrypted


def test_the_secret_is_made_once_and_for_its_owner_alone(tmp_path: Path) -> None:
    found = read_settings({}, data_folder=tmp_path / "data")
    secret = found.secret_key()
    assert len(secret) == 64
    assert found.secret_key() == secret
    assert stat.S_IMODE(found.secret_key_file.stat().st_mode) == 0o600
    assert [path.name for path in (tmp_path / "data").iterdir()] == ["secret-key"]


def test_many_who_come_first_get_the_same_secret(tmp_path: Path) -> None:
    secrets: list[str] = []
    gate = threading.Barrier(6)

    def read() -> None:
        gate.wait()
        secrets.append(read_or_make_secret(tmp_path / "secret-key"))

    threads = [threading.Thread(target=read) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(secrets) == 6
    assert len(set(secrets)) == 1


def test_a_file_that_holds_no_secret_is_refused(tmp_path: Path) -> None:
    (tmp_path / "secret-key").write_text("short")
    with pytest.raises(SettingsError, match="holds no secret of 32 or more characters"):
        read_or_make_secret(tmp_path / "secret-key")
