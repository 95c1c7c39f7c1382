"""``ocularist figures``: nothing is drawn unasked, and a place without a study is told."""

from pathlib import Path

import pytest

from study.cli import main
from study.data.database import open_database
from study.data.studies import register
from study.design.definition import read_definition


def test_nothing_is_drawn_where_nobody_sees_results(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    db = open_database(str(tmp_path / "study.sqlite3"))
    register(db, read_definition("thesis"))
    db.close()
    places = ["--data", str(tmp_path)]
    assert main(["figures", *places]) == 0
    assert capsys.readouterr().out.startswith("nothing to draw: no new answers, or nobody")
    assert main(["figures", *places, "--claimed-by", "a worker that has lost its claim"]) == 0
    assert capsys.readouterr().out == ""


def test_a_folder_without_a_database_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["figures", "--data", str(tmp_path / "none")]) == 1
    assert "ocularist figures: " in capsys.readouterr().err
