"""Colours that people with colour-blindness tell apart: every palette as they see it.

Simulated after Machado, Oliveira and Fernandes 2009 (IEEE TVCG 15), severity 1, in linear light;
differences are CIE 1976 Lab distances. What shares a colour's lightness differs in marker too.
"""

import itertools

import numpy as np
import pytest

from analysis.charts.style import (
    CHOICE_COLOURS,
    LOD_COLOURS,
    NOTICE_COLOURS,
    VERDICT_COLOURS,
    lod_marker,
    scale_colours,
)

SIGHTS = {
    "all cones": np.eye(3),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
         [-0.011820, 0.042940, 0.968881]]
    ),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
         [-0.003882, -0.048116, 1.051998]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
         [0.004733, 0.691367, 0.303900]]
    ),
}  # fmt: skip
PALETTES = {
    "LoDs": tuple(LOD_COLOURS.values()),
    "choices": CHOICE_COLOURS,
    "noticed": NOTICE_COLOURS,
    "verdicts": tuple(VERDICT_COLOURS.values()),
    "ratings 1 to 5": tuple(scale_colours(5)),
}
XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
     [0.0193339, 0.1191920, 0.9503041]]
)  # fmt: skip
CLEAR = 18.0  # several times what is just noticed: told apart in small symbols too


def seen(colour: str, sight: str) -> np.ndarray:
    """Return Lab of a colour as #rrggbb for one sight."""
    srgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    xyz = XYZ @ np.clip(SIGHTS[sight] @ linear, 0, 1) / XYZ.sum(axis=1)
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("name", PALETTES)
def test_colours_of_one_chart_are_told_apart(name: str, sight: str) -> None:
    for one, other in itertools.combinations(PALETTES[name], 2):
        away = float(np.linalg.norm(seen(one, sight) - seen(other, sight)))
        assert away > CLEAR, (name, sight, one, other)


def test_red_and_green_of_one_lightness_would_not_pass() -> None:
    away = np.linalg.norm(seen("#CC5500", "deuteranopia") - seen("#7F7F00", "deuteranopia"))
    assert away < CLEAR


def test_every_lod_has_a_marker_of_its_own() -> None:
    lods = [*LOD_COLOURS, "a", "b", "c", "d", "e", "f"]
    assert len({lod_marker(lod, lods) for lod in lods}) == len(lods)
