"""Colour-vision plates: whose digit vanishes for whom, by models other than the generator's."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import pytest

from study.design.plate_colours import Paint, hex_codes, linear_rgb
from study.design.plate_digits import DIGITS, is_on_digit
from study.design.plates import ORDER, Plate, dots, plate_svg, plates

# Machado, Oliveira & Fernandes 2009, table 1, severity 1.0: linear sRGB as a dichromat sees it.
MACHADO: Final = {
    "protan": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "deutan": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
}
# Brettel, Viénot & Mollon 1997 for tritans: another display's cones, and the cones' responses to
# the wavelengths 660 nm and 485 nm, which look alike to tritans and to everybody else.
BRETTEL_CONES: Final = np.array(
    [
        [0.05059983, 0.08585369, 0.00952420],
        [0.01893033, 0.08925308, 0.01370054],
        [0.00292202, 0.00975732, 0.07145979],
    ]
)
REDDISH: Final = np.array([0.0914, 0.007009, 0.0])
GREENISH: Final = np.array([0.1284, 0.2237, 0.3636])
XYZ_OF_RGB: Final = np.array(
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
)
KINDS: Final = ("protan", "deutan", "tritan")


def seen_by(kind: str, rgb: Any) -> Any:
    """Return linear sRGB, (n, 3), as somebody without one kind of cones sees it."""
    if kind in MACHADO:
        return np.clip(rgb @ MACHADO[kind].T, 0, None)
    if kind == "tritan":
        cones = rgb @ BRETTEL_CONES.T
        white = BRETTEL_CONES @ np.ones(3)
        greenish = cones[:, 1] / cones[:, 0] >= white[1] / white[0]
        normal = np.where(greenish[:, None], np.cross(white, GREENISH), np.cross(white, REDDISH))
        cones[:, 2] = -(normal[:, 0] * cones[:, 0] + normal[:, 1] * cones[:, 1]) / normal[:, 2]
        return np.clip(cones @ np.linalg.inv(BRETTEL_CONES).T, 0, None)
    return rgb


def lab(rgb: Any) -> Any:
    xyz = rgb @ XYZ_OF_RGB.T / XYZ_OF_RGB.sum(axis=1)
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.column_stack(
        [116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])]
    )


def contrast(kind: str, eye: str) -> tuple[float, float]:
    """Return how a plate's digit differs from its ground for an eye: colour, lightness (CIELAB).

    The colour is compared at one luminance, as the dots' jitter leaves nothing else; lightness in
    standard deviations of that jitter.
    """
    _, on_digit, rgb = dots(Plate(kind, 8, 11))
    seen = seen_by(eye, rgb)
    light = lab(seen)[:, 0]
    level = seen / (seen @ XYZ_OF_RGB[1])[:, None] * 0.2
    colour = lab(level)[:, 1:]
    apart = colour[on_digit].mean(axis=0) - colour[~on_digit].mean(axis=0)
    step = light[on_digit].mean() - light[~on_digit].mean()
    return float(np.hypot(*apart)), abs(float(step / light[~on_digit].std()))


@pytest.mark.parametrize("kind", KINDS)
def test_a_digit_vanishes_for_the_eye_that_its_plate_tests(kind: str) -> None:
    colour, light = contrast(kind, kind)
    assert colour < 3.0  # about what two patches side by side need to be told apart
    assert light < 0.35


@pytest.mark.parametrize("kind", KINDS)
def test_a_digit_stays_for_every_other_eye(kind: str) -> None:
    assert contrast(kind, "normal")[0] > 60
    others = [contrast(kind, eye)[0] for eye in KINDS if eye != kind]
    assert min(others) > 15


@pytest.mark.parametrize("eye", ["normal", *KINDS])
def test_everybody_reads_the_control_plate_by_its_lightness(eye: str) -> None:
    assert contrast("control", eye)[1] > 4


def test_a_participants_plates_come_from_their_seed_alone() -> None:
    assert plates(7) == plates(7) != plates(8)
    for seed in range(30):
        found = plates(seed)
        assert found[0].kind == "control"
        assert sorted(plate.kind for plate in found[1:]) == sorted(ORDER)
        assert len({plate.digit for plate in found}) == len(found)
    assert {plates(seed)[1].kind for seed in range(30)} == set(ORDER)
    assert {plate.digit for seed in range(30) for plate in plates(seed)} == set(DIGITS)


def test_a_picture_holds_dots_that_do_not_touch_and_names_nothing() -> None:
    plate = Plate("protan", 5, 1)
    placed, on_digit, rgb = dots(plate)
    gaps = np.hypot(*(placed[:, None, :2] - placed[None, :, :2]).transpose(2, 0, 1))
    gaps -= placed[:, None, 2] + placed[None, :, 2]
    assert gaps[~np.eye(len(placed), dtype=bool)].min() > 0
    assert (np.hypot(placed[:, 0], placed[:, 1]) + placed[:, 2]).max() <= 1 + 1e-9
    assert len(placed) > 350
    assert 60 < on_digit.sum() < len(placed) / 2
    drawn = plate_svg(plate)
    assert drawn.count("<circle") == len(placed) + 1
    assert hex_codes(rgb)[0] in drawn
    assert "protan" not in drawn
    assert "style" not in drawn  # the policy allows none
    assert plate_svg(Plate("protan", 5, 2)) != drawn


def test_digits_are_told_apart() -> None:
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 41)] * 2), axis=-1).reshape(-1, 2)
    shapes = {digit: is_on_digit(digit, grid) for digit in DIGITS}
    for one, first in shapes.items():
        assert 0.1 < first.mean() < 0.35
        for other, second in shapes.items():
            if one < other:
                assert (first ^ second).sum() / (first | second).sum() > 0.2, (one, other)


def test_a_colour_that_no_screen_shows_is_refused() -> None:
    with pytest.raises(ValueError, match=r"no colour of sRGB \(.* to 5\.67\d\)"):
        linear_rgb(Paint((2.0, 1.0, 1.0), 0.1, 0.2), np.array([0.9]))
