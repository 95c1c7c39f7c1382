"""What ``ocularist render`` says and asks about encoding."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.manifest import ClipRecord
from study.cli import build_parser, main
from study.commands.encoding import encoding_choices, warn_of_missed

SPEC = ClipSpec(left=Detail(), right=Detail())


def test_flip_is_measured_and_no_master_kept_unless_told_otherwise() -> None:
    parse = build_parser().parse_args
    assert encoding_choices(parse(["render"])) == {"with_master": False, "with_flip": True}
    asked = encoding_choices(parse(["render", "--master", "--no-flip"]))
    assert asked == {"with_master": True, "with_flip": False}


def test_a_master_does_not_travel(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["--out", str(tmp_path)]
    assert main(["render", "--master", "--workers", "2", *out]) == 1
    assert main(["render", "--master", "--scheduler", "tcp://nowhere:1", *out]) == 1
    said = capsys.readouterr().err.splitlines()
    assert said[0].endswith("--master: only where this process renders; leave out --workers")
    assert said[1].endswith("--master: only where this process renders; leave out --scheduler")


def test_a_bound_that_is_missed_is_told_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    whole = ClipRecord(
        **{"clip_id": SPEC.clip_id, "spec": SPEC.to_dict(), "file": "a.mp4", "file_sha256": "0"},
        **{"file_bytes": 1, "raw_sha256": "0", "frame_count": 1, "width": 1920, "height": 1080},
        **{"fps": 30, "iris_px": [], "visible_px": [], "psnr_db": [], "ssim": []},
        **{"frame_ms_median": 1.0, "render_s": 1.0, "gl_renderer": "", "gl_version": ""},
        code_version="",
    )
    missed = ["the file has 9.25 MB; at most 8.00 MB are accepted"]
    warn_of_missed([whole, replace(whole, missed=missed)])
    assert capsys.readouterr().err == (
        f"macroscopic, 1920x1080 ({SPEC.clip_id}): the file has 9.25 MB; at most 8.00 MB are "
        "accepted. It is kept.\n"
    )
