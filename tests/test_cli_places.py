"""Where commands write is asked about before any work begins."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import pytest

from study.cli import COMMANDS, build_parser, main
from study.commands.places import new_file, new_folder


def options_of(command: str) -> list[argparse.Action]:
    (commands,) = (a for a in build_parser()._actions if isinstance(a.choices, dict))
    return list(commands.choices[command]._actions)


WRITERS = [c for c in COMMANDS if any("--out" in a.option_strings for a in options_of(c))]


@pytest.mark.parametrize("command", WRITERS)
def test_every_command_refuses_a_place_beneath_a_file_before_it_works(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "notes").write_text("here")
    wanted = [a for a in options_of(command) if a.required or not a.option_strings]
    given = [
        word
        for action in wanted
        if action.nargs != "?"
        for word in (*action.option_strings[:1], "1")
    ]
    with pytest.raises(SystemExit) as ended:
        main([command, *given, "--out", str(tmp_path / "notes" / "new.png")])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert f"argument --out: {tmp_path}/notes is a file, no folder; choose another place" in said
    assert len(said.splitlines()) == 1


def test_a_folder_is_no_file_and_a_locked_one_no_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert new_folder(str(tmp_path / "a" / "b")) == tmp_path / "a" / "b"
    assert list(tmp_path.iterdir()) == []
    assert new_file("still.png") == Path("still.png")
    with pytest.raises(argparse.ArgumentTypeError, match="is a folder; write the file's name too"):
        new_file(str(tmp_path))
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write anywhere
    with pytest.raises(argparse.ArgumentTypeError, match="may not be written to; choose another"):
        new_folder(str(tmp_path / "a"))
