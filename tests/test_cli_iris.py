"""``ocularist iris`` from a photograph to a still, and what is told when it cannot be."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np
import pytest
from PIL import Image

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.gl.context import create_context
from renderer.unrefraction.portrait import developed, portrait
from study.cli import main
from study.commands.eye_options import iris
from study.design.definition import StudyDefinition, read_definition
from study.design.faults import DefinitionError


@pytest.fixture(scope="module")
def photo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A brown eye's portrait as a JPEG."""
    gl: moderngl.Context = create_context()
    spec = ClipSpec(left=Detail.uniform("ultra"), right=Detail(), iris_seed=5, iris_colour="brown")
    path = tmp_path_factory.mktemp("photo") / "anna.jpg"
    Image.fromarray(developed(portrait(gl, spec, size_px=500))).save(path, quality=92)
    gl.release()
    return path


@pytest.fixture
def study_with(
    thesis_with: Callable[[str, str], str], tmp_path: Path
) -> Callable[[str], StudyDefinition]:
    """What reads the thesis's study with other eyes from a file."""

    def read(eye: str) -> StudyDefinition:
        path = tmp_path / "study.toml"
        path.write_text(thesis_with("eye", eye), encoding="utf-8")
        return read_definition(path)

    return read


def test_a_photograph_becomes_an_iris_that_stills_and_studies_name(
    photo: Path,
    study_with: Callable[[str], StudyDefinition],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder = tmp_path / "anna"
    assert main(["iris", str(photo), "--out", str(folder), "--distance", "400"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("pupil ")
    assert out.splitlines()[-1] == str(folder / "iris.npz")
    assert "Iris: looking for the eye" in err
    found = json.loads((folder / "found.json").read_text(encoding="utf-8"))
    data = (folder / "iris.npz").read_bytes()
    assert found["iris_sha256"] == hashlib.sha256(data).hexdigest()
    assert found["pupil_true_mm"] == pytest.approx(4.0, abs=0.1)
    with Image.open(folder / "preview.png") as preview:
        panels = np.asarray(preview).astype(np.float32)
    assert panels.shape == (720, 3 * 720 + 24, 3)
    ring = np.s_[160:240, 330:390]  # above the pupil: the photograph's iris and the drawn one
    seen, drawn = (panels[:, x : x + 720][ring].mean(axis=(0, 1)) for x in (0, 1464))
    np.testing.assert_allclose(drawn, seen, atol=14.0)
    named = iris(str(folder / "iris.npz"))
    assert named == {"iris_file": str(folder / "iris.npz"), "iris_sha256": found["iris_sha256"]}
    first = study_with('iris_file = "anna/iris.npz"').wanted_specs()[0].spec
    assert {name: getattr(first, name) for name in named} == named


def test_a_study_without_its_iris_file_is_refused_with_its_place(
    study_with: Callable[[str], StudyDefinition], tmp_path: Path
) -> None:
    with pytest.raises(DefinitionError) as caught:
        study_with('iris_file = "gone.npz"\niris_colour = "brown"')
    message = str(caught.value)
    assert f"eye.iris_file: {tmp_path}/gone.npz: No such file or directory" in message
    assert "eye.iris_colour: gone.npz brings its own colours; leave this out" in message


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["absent.jpg"], "absent.jpg: No such file or directory"),
        (["{}/text.jpg"], "text.jpg: is no picture that Pillow can open"),
        (["{}/grey.png"], "grey.png: no eye found; a sharp photograph of one open eye"),
        (["x.jpg", "--limbus-mm", "5"], "--limbus-mm: 5 lies outside 9 to 14 mm"),
        (["x.jpg", "--focal", "5"], "--focal: 5 lies outside 10 to 2000 mm"),
        (["x.jpg", "--distance", "5"], "--distance: 5 lies outside 60 to 5000 mm"),
    ],
)
def test_what_cannot_be_is_told_in_one_line(
    arguments: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "text.jpg").write_text("hello", encoding="utf-8")
    Image.new("RGB", (400, 300), (120, 120, 120)).save(tmp_path / "grey.png")
    assert main(["iris", *(text.format(tmp_path) for text in arguments)]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err.splitlines()[-1]
    assert err.splitlines()[-1].startswith("ocularist iris: ")


def test_a_wrong_iris_for_a_still_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["still", "--iris", "gone.npz"])
    assert "gone.npz: No such file or directory; ocularist iris PHOTO" in capsys.readouterr().err
