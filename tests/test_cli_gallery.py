"""``ocularist gallery``: one strip on real GL, the list, and what a wrong name is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from study.cli import main


def test_one_strip_is_drawn_from_real_frames(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status = main(
        ["gallery", "--only", "caustics", "--size", "160x90", "--png", "--out", str(tmp_path)]
    )
    assert status == 0
    assert capsys.readouterr().out.startswith("caustics ")
    with Image.open(tmp_path / "caustics.png") as picture:
        pixels = np.asarray(picture).astype(np.float32)
    # Three tiles of 80 x 48: two eyes that nearly agree, and their difference around mid-grey.
    ours, painted, change = (pixels[44:92, x : x + 80] for x in (6, 92, 178))
    assert ours.std() > 20.0, "an eye has dark and bright parts"
    assert 0.0 < np.abs(ours - painted).mean() < 20.0
    np.testing.assert_allclose(
        change, np.clip(128.0 + 2.0 * (painted - ours), 0.0, 255.0), atol=0.6
    )


def test_the_list_says_each_strips_title(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gallery", "--list", "--only", "sun", "--only", "without"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(maxsplit=1) for line in lines] == [
        ["without", "Ultra without one effect"],
        ["sun", "The sun moves the caustic"],
    ]


def test_a_wrong_name_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gallery", "--sheets", "--only", "sheet"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith('ocularist gallery: unknown strip "sheet"; choose of sheet-macroscopic')
    assert len(err.splitlines()) == 1
