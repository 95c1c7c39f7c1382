"""The entry point: every command explains itself, errors are one line, nothing heavy is loaded."""

from __future__ import annotations

import errno
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from analysis.words.versions import own_version
from study.cli import COMMANDS, build_parser, main
from study.data.database import open_database

ROOT = Path(__file__).parent.parent
RATINGS = "participant,lod,rating\n" + "".join(
    f"P{person},{lod},{rating}\n"
    for person in range(1, 7)
    for rating, lod in enumerate(("low", "medium", "high", "ultra"), start=1 + person % 2)
)


def fails_with(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that must fail; return the one line it says on stderr."""
    try:
        status = main(arguments)
    except SystemExit as ending:  # argparse's own way
        status = int(ending.code or 0)
    out, err = capsys.readouterr()
    assert status > 0
    assert out == ""
    assert len(err.splitlines()) == 1, err
    return err.strip()


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(
    command: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    with pytest.raises(SystemExit) as ending:
        main([command, "--help"])
    assert ending.value.code == 0
    said = capsys.readouterr().out
    assert said.startswith(f"usage: ocularist {command}")
    assert len(said.split("\n\n")[1]) > 40  # a sentence on what it does
    example = " ".join(said.split("Example: ")[1].split())
    _, *words = shlex.split(example)
    assert build_parser().parse_args(words).command == command  # what it says can be typed


def test_help_parts_no_name_and_no_example(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit):
        main(["serve", "--help"])
    said = capsys.readouterr().out
    assert "(default: ocularist-data)" in " ".join(said.split())
    assert said.endswith(
        "ocularist serve thesis --host 0.0.0.0 --tls-cert cert.pem --tls-key key.pem\n"
    )


def test_the_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--help"])
    said = capsys.readouterr().out
    for command in COMMANDS:
        assert f"\n    {command}" in said


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ending:
        main(["--version"])
    assert ending.value.code == 0
    assert capsys.readouterr().out == f"ocularist {own_version()}\n"


def test_an_unknown_command_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    said = fails_with(capsys, "rendr")
    assert said.startswith("ocularist: argument COMMAND: invalid choice: 'rendr'")
    assert said.endswith("(see ocularist --help)")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("check", "thesi"), 'did you mean "thesis"?'),
        (("still", "--effect", "reflection=hihg"), 'unknown level "hihg"'),
        (("still", "--effect", "reflektion=high"), 'unknown effect "reflektion"; choose one of'),
        (("still", "--effect", "medium"), "no effect with a level; write NAME=LEVEL"),
        (("still", "--only-effect", "shine"), 'unknown effect "shine"'),
        (("still", "--distance", "middle"), "argument --distance: invalid choice: 'middle'"),
        (("still", "--size", "1920*1080"), "write width x height in pixels, like 1280x720"),
        (("still", "--size", "641x360"), "width: 641 is odd"),
        (("still", "--pupil", "12"), "pupil_mm: 12.0 lies outside 1.5 to 8.0"),
        (("still", "--iris", "purple"), '"purple" is no iris; write a seed, a colour'),
        (("still", "--out", "eye.jpg"), 'eye.jpg: unknown kind of picture ".jpg"'),
        (("still", "--environment", "none.exr"), "none.exr: No such file or directory"),
        (("export-scene", "--format", "obj"), "argument --format: invalid choice: 'obj'"),
        (("export-scene", "--left", "best"), "argument --left: invalid choice: 'best'"),
        (("still", "--environment-turn", "9"), "only a picture has one; give --environment FILE"),
        (("still", "--environment", "x.exr", "--sun", "0", "9"), "x.exr brings its own sun"),
        (("render", "--only", "8"), 'unknown clip "8"; the study has practice, 1, 2, 3'),
        (("still", "--frame", "151"), "--frame 151: the clip has frames 1 to 150"),
        (("still", "--azimuth", "nan"), '"nan" is no number; write one like 0.5'),
        (("simulate", "--seed", "-1"), '"-1" is no whole number; write one from 0 on'),
        (("check", "lod", "--translation", "../x"), '"../x" is no language; write its code'),
        (("check", "lod", "--translation", "en"), "--translation en: the study's own language"),
        (("run", "--data", "/dev/null/x"), "argument --data: /dev/null is a file, no folder"),
        (("worker", "--data", "none"), "none/study.sqlite3: no such database; ocularist run"),
        (("worker", "--database", "none.sqlite3"), "none.sqlite3: no such database"),
        (("figures", "--bench", "none.json"), "none.json: No such file or directory"),
        (("serve", "--port", "70000"), '"70000" is no port; write a number from 1 to 65535'),
        (("run", "--tls-cert", "a.pem"), "TLS needs both --tls-cert and --tls-key"),
        (("export", "--database", "sqlite:///none.sqlite3"), "none.sqlite3: no such database"),
        (("analyse", "none.csv"), "none.csv: not found"),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, tuple) else "",
)
def test_an_error_is_one_clear_line(
    arguments: tuple[str, ...],
    words: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    said = fails_with(capsys, *arguments)
    assert said.startswith(f"ocularist {arguments[0]}: ")
    assert words in said
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_told_with_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fill(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    open_database(str(tmp_path / "study.sqlite3")).close()
    monkeypatch.setattr("study.commands.preparing.find_study", lambda *_: None)
    monkeypatch.setattr("study.data.export.write", fill)
    out = tmp_path / "tables"
    said = fails_with(capsys, "export", "--data", str(tmp_path), "--out", str(out))
    assert said == f"ocularist export: {out}: No space left on device"


@pytest.mark.parametrize("command", ["check", "render"])
def test_a_study_whose_picture_cannot_light_a_scene_is_told_before_any_work(
    command: str, thesis_text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = 'environment = "park"\nsun_azimuth_deg = -15.0\nsun_elevation_deg = 42.0'
    assert scene in thesis_text
    (tmp_path / "study.toml").write_text(thesis_text.replace(scene, 'environment = "lobby.exr"'))
    (tmp_path / "lobby.exr").write_bytes(b"no picture")
    said = fails_with(capsys, command, str(tmp_path / "study.toml"))
    assert said.endswith("lobby.exr: not an OpenEXR file, whatever its name says")


def test_every_fault_of_a_study_file_is_told(
    thesis_text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    faulty = tmp_path / "faulty.toml"
    faulty.write_text(
        thesis_text.replace('reflection = "high"', 'reflection = "hihg"').replace(
            "fps = 30", "fps = 0"
        )
    )
    assert main(["check", str(faulty)]) == 1
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2
    assert all(line.startswith("ocularist check: faulty.toml: ") for line in lines)
    assert any("lods.high.reflection" in line for line in lines)
    assert any("orbit.fps" in line for line in lines)


def test_our_own_mistakes_show_their_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_name: str) -> None:
        raise KeyError("a mistake of ours")

    monkeypatch.setattr("study.design.definition.read_definition", fail)
    with pytest.raises(KeyError):
        main(["check"])


def test_a_traceback_can_be_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OCULARIST_TRACEBACK", "1")
    with pytest.raises(ValueError, match="thesi"):
        main(["check", "thesi"])


def run_without(blocked: str, code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run code in a Python where some packages cannot be imported."""
    block = f"import sys\nfor name in {blocked.split()!r}: sys.modules[name] = None\n"
    return subprocess.run(
        [sys.executable, "-c", block + code],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "MPLCONFIGDIR": str(folder)},
        capture_output=True,
        text=True,
        check=False,
    )


def test_analyse_needs_neither_web_nor_database_nor_gl(tmp_path: Path) -> None:
    (tmp_path / "ratings.csv").write_text(RATINGS)
    done = run_without(
        "fastapi starlette uvicorn sqlalchemy alembic argon2 moderngl glcontext imageio",
        "from study.cli import main; sys.exit(main(['analyse', 'ratings.csv', '--out', 'report']))",
        tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert list((tmp_path / "report").glob("*.html"))


def test_a_web_machine_needs_no_gl(tmp_path: Path) -> None:
    done = run_without(
        "moderngl glcontext", "from study.site.app import create_app; print('made')", tmp_path
    )
    assert done.stdout == "made\n", done.stderr


def test_a_render_machine_needs_no_database_and_no_web(tmp_path: Path) -> None:
    done = run_without(
        "fastapi starlette uvicorn sqlalchemy alembic",
        "from study.commands.render import wanted\n"
        "from study.design.definition import read_definition\n"
        "from renderer.production.batch import render_clip\n"
        "from renderer.studio import Studio\n"
        "print(len(wanted(read_definition('thesis'), only=['1'], sizes=None, fps=None)))",
        tmp_path,
    )
    assert done.stdout == "4\n", done.stderr


def test_a_missing_part_is_named(tmp_path: Path) -> None:
    done = run_without("uvicorn", "from study.cli import main; sys.exit(main(['serve']))", tmp_path)
    assert done.returncode == 1
    assert done.stderr == (
        "ocularist serve: needs uvicorn, which is not installed here; pip install uvicorn\n"
    )


def test_building_the_parser_loads_nothing_heavy() -> None:
    heavy = "numpy pandas matplotlib scipy moderngl fastapi sqlalchemy pydantic"
    code = (
        "import sys; from study.cli import build_parser; build_parser();"
        f"print(*(set({heavy.split()!r}) & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == []


def test_the_parser_knows_the_commands_of_the_design() -> None:
    options = build_parser().parse_args(["researcher", "add", "ada"])
    assert (options.command, options.action, options.name) == ("researcher", "add", "ada")


def test_a_margin_that_cannot_be_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["analyse", "ratings.csv", "--noticed-margin", "1.5"]) == 1
    message = capsys.readouterr().err.strip()
    assert message == (
        "ocularist analyse: noticed_margin: found 1.5; accepted: above 0 and below 1"
    )
