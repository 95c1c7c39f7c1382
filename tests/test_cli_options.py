"""What the options of ``still``, ``render``, ``run`` and ``researcher`` come to."""

from __future__ import annotations

import hashlib
import io
import re
import socket
from pathlib import Path

import pytest

from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, Detail
from renderer.lod.choice import LodPolicy, LodStep
from renderer.lod.policy import Evidence, PolicyFile, default_policy, write_policy
from study.cli import build_parser, main
from study.commands.analyse import source_of
from study.commands.errors import CommandError
from study.commands.eye_options import spec_of, viewpoint_of
from study.commands.listening import address_of, check_certificate, check_port, welcome
from study.commands.progress import time_left
from study.commands.render import wanted
from study.commands.researcher import new_password
from study.data import researchers
from study.data.database import open_database
from study.design.definition import read_definition
from study.settings import Settings


def still(*arguments: str) -> ClipSpec:
    return spec_of(build_parser().parse_args(["still", *arguments]))


def test_a_still_shows_two_ultra_eyes_unless_told_otherwise() -> None:
    assert still() == ClipSpec(left=Detail.uniform("ultra"), right=Detail.uniform("ultra"))


def test_an_effect_is_set_in_both_eyes_or_in_one() -> None:
    spec = still("--right", "low", "--effect", "reflection=medium", "--effect", "left.caustics=off")
    assert spec.left == Detail.uniform("ultra").with_levels(reflection="medium", caustics="off")
    assert spec.right == Detail.uniform("low").with_levels(reflection="medium")


def test_one_effect_or_some_are_shown_alone() -> None:
    spec = still("--left", "high", "--only-effect", "caustics", "--only-effect", "texture")
    levels = dict.fromkeys(EFFECTS, "off")
    assert spec.left.levels() == {**levels, "caustics": "high", "texture": "high"}


def test_an_effect_shown_alone_keeps_the_level_that_was_set() -> None:
    spec = still("--effect", "reflection=low", "--only-effect", "reflection")
    assert spec.right == Detail(reflection="low")


def test_a_still_takes_everything_that_a_clip_depends_on() -> None:
    spec = still(
        *("--distance", "medium", "--size", "640x360", "--gaze", "-10", "5", "--pupil", "3"),
        *("--iris", "7:brown", "--sun", "20", "60", "--crowd", "0", "--preset", "calibrated"),
    )
    assert (spec.distance, spec.width, spec.height) == ("medium", 640, 360)
    assert (spec.gaze_yaw_deg, spec.gaze_pitch_deg, spec.pupil_mm) == (-10, 5, 3)
    assert (spec.iris_seed, spec.iris_colour) == (7, "brown")
    assert (spec.sun_azimuth_deg, spec.sun_elevation_deg) == (20, 60)
    assert (spec.crowd, spec.preset) == (0, "calibrated")


def test_a_still_takes_its_surroundings_from_a_picture(tmp_path: Path) -> None:
    picture = tmp_path / "lobby.exr"
    picture.write_bytes(b"whatever")
    spec = still(
        *("--environment", str(picture), "--environment-turn", "30", "--environment-exposure", "-1")
    )
    assert spec.environment == "image"
    assert spec.environment_file == str(picture)
    assert spec.environment_sha256 == hashlib.sha256(b"whatever").hexdigest()
    assert (spec.environment_turn_deg, spec.environment_exposure_ev) == (30.0, -1.0)


def test_the_camera_stands_at_an_azimuth_or_where_a_frame_has_it() -> None:
    options = build_parser().parse_args(["still", "--azimuth", "20", "--elevation", "5"])
    assert viewpoint_of(options, still()) == {
        "azimuth_deg": 20.0,
        "elevation_deg": 5.0,
        "time_s": 0.0,
    }
    first = build_parser().parse_args(["still", "--frame", "31"])
    spec = still()
    assert viewpoint_of(first, spec) == {
        "azimuth_deg": spec.azimuth_deg(30),
        "elevation_deg": 0.0,
        "time_s": 1.0,
    }


def test_a_still_shows_any_size_with_the_lods_that_follow_from_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    drawn: list[ClipSpec] = []
    monkeypatch.setattr("renderer.still.write_still", lambda _out, spec, **_: drawn.append(spec))
    assert main(["still", "--iris-px", "30", "--switching", "blended"]) == 0
    (spec,) = drawn
    assert (spec.motion, spec.approach_end_px) == ("approach", 30.0)
    assert (spec.left_switching, spec.right_switching) == ("blended", "blended")
    assert spec.lod_policy == default_policy()
    capsys.readouterr()
    assert main(["still", "--iris-px", "30", "--frame", "2"]) == 1
    assert "--frame: a frame has its own distance" in capsys.readouterr().err
    assert main(["still", "--switching", "instant", "--effect", "caustics=off"]) == 1
    assert "--switching: takes the levels from a policy" in capsys.readouterr().err
    assert main(["still", "--iris-px", "80", "--switching", "blended", "--right", "low"]) == 1
    assert "leave --left and --right out" in capsys.readouterr().err
    assert main(["still", "--iris-px", "300"]) == 1
    assert "approach_end_px: 300 is too large; one camera shows" in capsys.readouterr().err


def test_a_still_takes_the_policy_of_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    drawn: list[ClipSpec] = []
    monkeypatch.setattr("renderer.still.write_still", lambda _out, spec, **_: drawn.append(spec))
    steps = [LodStep("low", Detail.uniform("low"), 20.0)]
    steps += [LodStep("ultra", Detail.uniform("ultra"), None)]
    own = LodPolicy(tuple(steps), hysteresis=0.2)
    path = tmp_path / "lod_policy.json"
    write_policy(PolicyFile(own, (Evidence(), Evidence()), "by hand"), path)
    given = ["still", "--iris-px", "30", "--switching", "instant", "--lod-policy"]
    assert main([*given, str(path)]) == 0
    assert drawn[0].lod_policy == own
    capsys.readouterr()
    assert main(["still", "--lod-policy", str(path)]) == 1
    said = capsys.readouterr().err
    assert "--lod-policy: says where eyes switch; add --switching, or --view crowd" in said
    assert main([*given, str(tmp_path / "none.json")]) == 1
    assert "none.json: No such file or directory" in capsys.readouterr().err
    path.write_text("{}")
    assert main([*given, str(path)]) == 1
    assert "lod_policy.json: not a LoD policy of schema 1: no 'schema'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "seed", "colour"), [("7", 7, "blue"), ("green", 1, "green"), ("3:grey", 3, "grey")]
)
def test_an_iris_is_named_by_seed_colour_or_both(text: str, seed: int, colour: str) -> None:
    spec = still("--iris", text)
    assert (spec.iris_seed, spec.iris_colour) == (seed, colour)


def test_render_takes_the_study_in_its_own_order() -> None:
    definition = read_definition("thesis")
    specs = wanted(definition, only=None, sizes=None, fps=None)
    assert specs == [entry.spec for entry in definition.wanted_specs()]


def test_render_narrows_clips_and_changes_size_and_rate() -> None:
    definition = read_definition("thesis")
    specs = wanted(definition, only=["7"], sizes=[(640, 360)], fps=10)
    assert {(s.distance, s.width, s.height, s.fps) for s in specs} == {("far", 640, 360, 10)}
    assert sorted(s.orbit_direction for s in specs) == sorted(definition.orbit.directions)


def test_a_port_in_use_is_one_clear_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        with pytest.raises(Exception, match=f"^port {port} on 127.0.0.1 is in use") as error:
            check_port(Settings(port=port))
    assert "choose another port with --port" in str(error.value)
    check_port(Settings(port=port))


def test_tls_files_are_looked_at_before_the_site_starts(tmp_path: Path) -> None:
    notes, none = tmp_path / "notes.pem", tmp_path / "none.pem"
    notes.write_text("no certificate")
    check_certificate(Settings())
    for cert, key in ((none, notes), (notes, none)):
        with pytest.raises(FileNotFoundError) as missing:
            check_certificate(Settings(tls_cert=cert, tls_key=key))
        assert missing.value.filename == str(none)
    with pytest.raises(
        CommandError, match=r"notes\.pem: no certificate with its private key"
    ) as bad:
        check_certificate(Settings(tls_cert=notes, tls_key=notes))
    assert "both have to be PEM files" in str(bad.value)


def test_the_addresses_are_those_to_type_into_a_browser() -> None:
    assert address_of(Settings(port=8080)) == "http://127.0.0.1:8080"
    assert address_of(Settings(host="::1")) == "http://[::1]:8000"
    everywhere = Settings(host="0.0.0.0", tls_cert=Path("a"), tls_key=Path("b"))
    assert address_of(everywhere) == f"https://{socket.gethostname()}:8000"


def test_the_password_is_shown_on_the_first_run_only() -> None:
    first = "\n".join(welcome(Settings(), "A study", "secret-word"))
    later = "\n".join(welcome(Settings(), "A study", None))
    for text in (first, later):
        assert "http://127.0.0.1:8000/\n" in text
        assert "http://127.0.0.1:8000/researcher\n" in text
    assert "password secret-word" in first
    assert "password" not in later


def test_generated_passwords_are_long_and_differ() -> None:
    passwords = {new_password() for _ in range(100)}
    assert len(passwords) == 100
    assert all(re.fullmatch(r"([2-9a-z]{4}-){3}[2-9a-z]{4}", password) for password in passwords)


def test_an_added_researcher_can_sign_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("a long enough password\n"))
    assert main(["researcher", "add", "ada", "--data", str(tmp_path)]) == 0
    assert capsys.readouterr().out == "ada can sign in now.\n"
    db = open_database(f"sqlite:///{tmp_path}/study.sqlite3")
    signed_in = researchers.sign_in(db, "ada", "a long enough password", address="here")
    db.close()
    assert signed_in is not None
    assert signed_in.name == "ada"


def test_a_generated_password_is_printed_and_works(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["researcher", "add", "ada", "--generate", "--data", str(tmp_path)]) == 0
    password = capsys.readouterr().out.splitlines()[1].removeprefix("Password: ")
    db = open_database(f"sqlite:///{tmp_path}/study.sqlite3")
    signed_in = researchers.sign_in(db, "ada", password, address="here")
    db.close()
    assert signed_in is not None


@pytest.mark.parametrize(
    ("left_s", "words"),
    [
        (None, ""),
        (1.0, ", about 5 s left"),
        (42.0, ", about 40 s left"),
        (200.0, ", about 3 min left"),
        (9000.0, ", about 2.5 h left"),
    ],
)
def test_the_time_left_is_told_as_people_would(left_s: float | None, words: str) -> None:
    assert time_left(left_s) == words


def test_analyse_takes_a_database_by_its_file_or_its_data_folder(tmp_path: Path) -> None:
    open_database(str(tmp_path / "study.sqlite3")).close()
    url = f"sqlite:///{tmp_path}/study.sqlite3"
    assert source_of(str(tmp_path)) == source_of(str(tmp_path / "study.sqlite3")) == url
    (tmp_path / "ratings.csv").write_text("participant,lod,rating\n")
    for other in (str(tmp_path), str(tmp_path / "ratings.csv"), "none.csv", url):
        assert source_of(other) == other
