"""``ocularist links`` and ``ocularist erase``: personal links to send out, people to forget."""

from __future__ import annotations

import csv
import errno
import os
import stat
from pathlib import Path

import pytest

from study.cli import main
from study.data import enrolment, links, participants, studies
from study.data.database import Database, open_database
from study.design.definition import read_definition


@pytest.fixture
def folder(tmp_path: Path, empty_file: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A data folder with a database, and the working folder of the test."""
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "study.sqlite3").write_bytes(empty_file.read_bytes())
    monkeypatch.chdir(tmp_path)
    return tmp_path


def opened(folder: Path) -> Database:
    return open_database(str(folder / "data" / "study.sqlite3"))


def test_links_are_written_once_for_their_owner_alone(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["links", "thesis", "--count", "2", "--data", "data"]
    assert main([*arguments, "--url", "https://study.example.org/"]) == 0
    path = folder / "links-thesis.csv"
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["number"] for row in rows] == ["1", "2"]
    addresses = [row["link"] for row in rows]
    assert all(one.startswith("https://study.example.org/link/") for one in addresses)
    db = opened(folder)
    found = [links.find(db, one.rpartition("/")[2]) for one in addresses]
    assert [link.number for link in found if link] == [1, 2]
    assert main(arguments) == 1
    assert "links-thesis.csv: there is such a file" in capsys.readouterr().err
    assert main([*arguments, "--out", "more.csv"]) == 0
    assert "2 new personal links; in all 0 used and 4 unused." in capsys.readouterr().out
    assert ",http://127.0.0.1:8000/link/" in (folder / "more.csv").read_text()
    assert (folder / "more.csv").read_text().splitlines()[1].startswith("3,")
    db.close()


def test_no_link_is_made_where_the_disk_has_no_room_for_it(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", refuse)
    assert main(["links", "thesis", "--count", "2", "--data", "data"]) == 1
    said = capsys.readouterr().err.splitlines()[-1]
    assert said.endswith("links-thesis.csv: cannot be written (No space left on device)")
    assert not list(folder.glob("*.csv"))
    db = opened(folder)
    assert links.counts(db, studies.all_studies(db)[0]).unused == 0
    db.close()


def test_a_site_without_a_scheme_is_refused_before_links_are_made(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["links", "--count", "1", "--data", "data", "--url", "study.example.org"]) == 1
    assert "begin it with https:// or http://" in capsys.readouterr().err
    assert not list(folder.glob("*.csv"))


def test_somebody_who_asks_is_erased_by_pseudonym(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    db = opened(folder)
    study = studies.register(db, read_definition("thesis"))
    name = enrolment.enrol(db, study).participant.public_id
    monkeypatch.setattr("builtins.input", lambda _question: "no")
    assert main(["erase", name, "--data", "data"]) == 1
    assert "nothing was erased" in capsys.readouterr().err
    assert participants.by_name(db, name) is not None
    assert main(["erase", name, "--yes", "--data", "data"]) == 0
    assert capsys.readouterr().out == f"{name} is erased.\n"
    assert participants.by_name(db, name) is None
    assert main(["erase", name, "--yes", "--data", "data"]) == 1
    assert f"{name}: nobody has this pseudonym or this code" in capsys.readouterr().err
    db.close()
