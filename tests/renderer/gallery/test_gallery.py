"""The gallery: every effect, LoD and distance is shown, strips are laid out and kept."""

from __future__ import annotations

import itertools
import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest
from PIL import Image

from renderer.clip import ClipSpec
from renderer.clip_values import DISTANCES, IRIS_COLOURS
from renderer.detail import EFFECTS, STANDARD_LODS, Detail
from renderer.gallery import making, page, strips
from renderer.gallery.drawing import CAPTION_PX, GAP_PX, PAPER, TITLE_PX, draw_strip
from renderer.gallery.making import chosen, make_strips
from renderer.gallery.page import page_of
from renderer.gallery.sheets import AZIMUTHS_DEG, SHEETS
from renderer.gallery.shots import (
    Captioned,
    Shot,
    Shots,
    difference,
    fitted,
    left_only,
    part_of,
    spec_of,
)
from renderer.gallery.table import gallery_strips
from renderer.unrefraction.refusal import PhotographError

SIZE = (64, 36)


class Painter(Shots):
    """Takes shots of one grey each, without GL, and counts them."""

    opened: ClassVar[list[Painter]] = []

    def __init__(self, size: tuple[int, int]) -> None:
        self.size = size
        self.taken: list[Shot] = []
        Painter.opened.append(self)

    def take(self, shot: Shot) -> Captioned:
        self.taken.append(shot)
        return shot.label, np.full((9, 16, 3), 100, np.uint8)

    def close(self) -> None:
        """Nothing to give back."""


@pytest.fixture(autouse=True)
def no_painters() -> None:
    Painter.opened.clear()


def shots_of(name: str, table: tuple[strips.Strip, ...]) -> list[Shot]:
    """Return the shots that a strip takes."""
    (strip,) = chosen(table, [name])
    painter = Painter(SIZE)
    strip.tiles(painter.take)
    return painter.taken


def gallery(tmp_path: Path) -> tuple[strips.Strip, ...]:
    return gallery_strips(tmp_path / "no-certificate")


def test_names_are_unique_and_fit_a_file(tmp_path: Path) -> None:
    names = [strip.name for strip in (*gallery(tmp_path), *SHEETS)]
    assert len(set(names)) == len(names)
    assert all(name.replace("-", "").isalnum() for name in names)


def test_every_effect_is_left_out_once_and_shown_alone_once(tmp_path: Path) -> None:
    ultra = Detail.uniform("ultra")
    without = [shot.spec.left for shot in shots_of("without", gallery(tmp_path))]
    assert without == [ultra] + [ultra.with_levels(**{e: "off"}) for e in EFFECTS]
    alone = [shot.spec.left for shot in shots_of("alone", gallery(tmp_path))]
    assert alone == [Detail()] + [ultra.only(e) for e in EFFECTS]


@pytest.mark.parametrize("distance", DISTANCES)
def test_every_distance_shows_the_four_lods(tmp_path: Path, distance: str) -> None:
    shots = shots_of(f"lods-{distance}", gallery(tmp_path))
    assert [shot.label for shot in shots] == list(STANDARD_LODS)
    assert {shot.spec.distance for shot in shots} == {distance}


def test_every_iris_colour_is_shown(tmp_path: Path) -> None:
    shots = shots_of("iris-colours", gallery(tmp_path))
    assert [shot.spec.iris_colour for shot in shots] == list(IRIS_COLOURS)


def test_sheets_show_every_lod_and_distance_from_five_azimuths() -> None:
    assert AZIMUTHS_DEG == (-60, -30, 0, 30, 60)
    seen = {
        (shot.spec.distance, shot.spec.left, shot.spec.right, shot.azimuth_deg)
        for strip in SHEETS
        for shot in shots_of(strip.name, SHEETS)
    }
    lods = [Detail.uniform(lod) for lod in STANDARD_LODS]
    wanted = itertools.product(DISTANCES, lods, AZIMUTHS_DEG)
    assert seen == {(distance, lod, lod, azimuth) for distance, lod, azimuth in wanted}


def test_shots_of_the_left_eye_spend_nothing_on_the_right_one() -> None:
    assert left_only("high", pupil_mm=3.0) == ClipSpec(
        left=Detail.uniform("high"), right=Detail(), pupil_mm=3.0
    )
    assert spec_of("low").right == Detail.uniform("low")


def test_tiles_stand_in_rows_with_room_for_their_captions() -> None:
    tiles = [(str(i), np.full((40, 100, 3), 10 * i, np.uint8)) for i in range(3)]
    sheet = draw_strip("three", tiles, columns=2, tile_px=50)
    cell = (50 + GAP_PX, 20 + CAPTION_PX + GAP_PX)  # shrunk to 50 x 20
    assert sheet.shape == (2 * cell[1] + TITLE_PX + GAP_PX, 2 * cell[0] + GAP_PX, 3)
    for number, (column, row) in enumerate([(0, 0), (1, 0), (0, 1)]):
        x, y = GAP_PX + column * cell[0], TITLE_PX + row * cell[1]
        assert (sheet[y : y + 20, x : x + 50] == 10 * number).all()
        assert (sheet[y + 20 : y + 20 + CAPTION_PX, x : x + 50] < 128).any(), "no caption"
    assert (sheet[TITLE_PX + cell[1] :, cell[0] + GAP_PX :] == PAPER).all()


def test_a_strip_without_tiles_is_refused() -> None:
    with pytest.raises(ValueError, match='"empty": a strip needs at least one tile'):
        draw_strip("empty", [], columns=2, tile_px=50)


def test_parts_differences_and_sizes() -> None:
    pixels = np.arange(8 * 16 * 3, dtype=np.uint8).reshape(8, 16, 3)
    np.testing.assert_array_equal(part_of(pixels, (0.25, 0.5, 0.75, 1.0)), pixels[4:8, 4:12])
    one, two = np.full((1, 1, 3), 12, np.uint8), np.full((1, 1, 3), 10, np.uint8)
    assert difference(one, two, 8.0)[0, 0, 0] == 144
    assert difference(two, one, 800.0)[0, 0, 0] == 0
    assert fitted(pixels, 8).shape == (4, 8, 3)
    assert fitted(pixels, 99) is pixels


def test_a_current_strip_is_kept_and_a_damaged_one_drawn_again(tmp_path: Path) -> None:
    wanted = chosen(gallery(tmp_path), ["meshes", "alone"])

    def made() -> list[bool]:
        return [new for _, _, new in make_strips(wanted, tmp_path, size=SIZE, open_shots=Painter)]

    assert made() == [True, True]
    assert made() == [False, False]
    assert len(Painter.opened) == 1, "nothing to draw needs no studio"
    (tmp_path / "meshes.jpg").write_bytes(b"damaged")
    assert made() == [False, True]  # in the table's order
    (tmp_path / making.INDEX).write_text("no index")
    assert made() == [True, True]


def test_another_size_or_version_is_drawn_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = chosen(gallery(tmp_path), ["meshes"])

    def made(size: tuple[int, int] = SIZE, *, anew: bool = False) -> bool:
        ((_, path, new),) = make_strips(wanted, tmp_path, size=size, anew=anew, open_shots=Painter)
        with Image.open(path) as picture:
            assert picture.format == "JPEG"
        return new

    assert made()
    assert not made()
    assert made((128, 72))
    assert made((128, 72), anew=True)
    monkeypatch.setattr(making, "code_version", lambda: "another")
    assert made((128, 72))
    assert set(json.loads((tmp_path / making.INDEX).read_text())) == {"meshes.jpg"}


def test_an_unknown_strip_is_named_with_those_that_exist(tmp_path: Path) -> None:
    with pytest.raises(
        ValueError, match='unknown strip "sunn"; choose of lods-macroscopic, lods-near'
    ):
        chosen(gallery(tmp_path), ["sunn", "sun"])


def test_a_certificate_is_shown_where_there_is_one(tmp_path: Path) -> None:
    Image.new("RGB", (40, 20), "red").save(tmp_path / "blue-front.png")
    figures = {
        "pictures": [{"case": {"name": "blue-front"}}],
        "aims": [
            {"words": "RMS in the iris", "reached_percent": 2.34, "is_met": True},
            {"words": "furnace", "reached_percent": 9.0, "is_met": False},
        ],
    }
    (tmp_path / "certification.json").write_text(json.dumps(figures))
    (strip,) = chosen(gallery_strips(tmp_path), ["certificate"])
    assert strip.title == "Beside a path tracer: 1 of 2 aims met; RMS in the iris: 2.3 %"
    ((caption, pixels),) = strip.tiles(Painter(SIZE).take)
    assert caption == "blue front"
    assert pixels.shape == (20, 40, 3)
    assert "certificate" not in [strip.name for strip in gallery(tmp_path)]


def test_what_shows_no_eye_is_no_photograph(tmp_path: Path) -> None:
    (strip,) = chosen(gallery(tmp_path), ["photograph"])
    with pytest.raises(PhotographError, match="no eye found"):
        strip.tiles(Painter(SIZE).take)


def test_the_page_shows_every_strip_and_no_other(tmp_path: Path) -> None:
    table = gallery(tmp_path)
    files = {strip.name: f"{strip.name}.jpg" for strip in table}
    text = page_of(table, files, "| measured |")
    shown = re.findall(r"^!\[(.+)\]\((.+)\.jpg\)$", text, flags=re.MULTILINE)
    assert sorted(shown) == sorted((strip.title, strip.name) for strip in table)
    assert "| measured |" in text
    assert not re.search(r"^@", text, flags=re.MULTILINE)


def test_the_page_leaves_out_what_is_not_there(tmp_path: Path) -> None:
    text = page_of(gallery(tmp_path), {"sun": "sun.png"}, "")
    assert re.findall(r"\]\((.+)\)", text) == ["sun.png"]
    assert "bright side of the iris" in text
    assert "## Light, gaze, lids" in text
    assert "## What each effect does" not in text
    assert "does most of the way" not in text
    assert "## What still gives ultra away" in text


def test_the_page_measures_strands_on_the_irises_it_shows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    line = np.linspace(-1.0, 1.0, 512, dtype=np.float32)
    rings = 0.2 + 0.1 * np.sin(140 * np.arctan2(line[:, None], line[None, :]))
    albedo = rings.astype(np.float32)[..., None].repeat(3, axis=2)
    drawn = SimpleNamespace(albedo=albedo)
    monkeypatch.setattr(page, "iris_maps", lambda *_iris, **_size: drawn)
    rows = page.measured_strands().splitlines()
    assert rows[0] == "|  | photographs | blue, seed 1 | brown, seed 1 |"
    assert rows[3].startswith("| spacing | 91 to 117 µm, bundles 205 to 235 | 20")
    assert len(rows) == 2 + len(page.PHOTOGRAPHED)
