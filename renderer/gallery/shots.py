"""A shot: one still of the gallery, a part of its picture, and how shots are taken.

Shots that differ in their eyes alone share a scene, so a strip lists those of a scene together.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Final

import numpy as np
from PIL import Image

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.frame.picture import Pixels
from renderer.frame.view_passes import PASSES
from renderer.studio import Studio

Crop = tuple[float, float, float, float]

# Parts of a picture as shares of its width and height: left, top, right, bottom.
WHOLE: Final = (0.0, 0.0, 1.0, 1.0)
LEFT_EYE: Final = (0.0, 0.17, 0.5, 0.70)  # of a macroscopic picture
LEFT_IRIS: Final = (0.135, 0.295, 0.365, 0.705)
BOTH_EYES: Final = (0.15, 0.32, 0.85, 0.68)  # of a near picture
FACE: Final = (0.32, 0.24, 0.68, 0.76)  # of a medium one
FAR_FACE: Final = (0.43, 0.40, 0.57, 0.60)


@dataclass(frozen=True)
class Shot:
    """One still: a clip's spec, where its camera stands, which part of the picture to keep.

    ``lines`` is the height of the picture in thousandths of the gallery's own: 1500 is half as
    much again. ``enlarge`` repeats pixels. ``until`` is the last pass of the frame that is drawn.
    With ``minus`` the shot is the difference of two specs, ``gain`` times as large, around grey.
    """

    label: str
    spec: ClipSpec
    crop: Crop = LEFT_EYE
    azimuth_deg: float = 12.0
    elevation_deg: float = 0.0
    lines: int = 1000
    enlarge: int = 1
    wireframe: bool = False
    until: str = PASSES[-1]
    minus: ClipSpec | None = None
    gain: float = 1.0


Captioned = tuple[str, Pixels]
Take = Callable[[Shot], Captioned]


class Shots:
    """Take shots in one studio at one picture size; close it to give the studio back."""

    def __init__(self, size: tuple[int, int]) -> None:
        self.size = size
        self._studio = Studio()
        # A strip of differences shows the same frame several times.
        self._frame = lru_cache(maxsize=4)(self._render)

    def take(self, shot: Shot) -> Captioned:
        """Return the shot's label and its part of the picture, (height, width, 3) uint8."""
        bare = replace(shot, label="", minus=None, crop=WHOLE, enlarge=1)
        pixels = self._frame(bare)
        if shot.minus is not None:
            pixels = difference(pixels, self._frame(replace(bare, spec=shot.minus)), shot.gain)
        part = part_of(pixels, shot.crop)
        return shot.label, part.repeat(shot.enlarge, axis=0).repeat(shot.enlarge, axis=1)

    def close(self) -> None:
        """Release the studio."""
        self._frame.cache_clear()
        self._studio.close()

    def _render(self, shot: Shot) -> Pixels:
        width, height = (2 * round(side * shot.lines / 2000) for side in self.size)
        renderer = self._studio.renderer(
            shot.spec.resized(width, height), wireframe=shot.wireframe, until=shot.until
        )
        return renderer.render(
            shot.azimuth_deg, time_s=2.0, elevation_deg=shot.elevation_deg
        ).pixels


def spec_of(lod: str | Detail = "ultra", **fields: Any) -> ClipSpec:
    """Return a clip whose eyes both have a LoD, given by name or as a row of levels."""
    detail = Detail.uniform(lod) if isinstance(lod, str) else lod
    return ClipSpec(**{"left": detail, "right": detail, **fields})


def left_only(lod: str | Detail = "ultra", **fields: Any) -> ClipSpec:
    """Return a clip for shots of the left eye: the right one, outside of them, costs nothing."""
    return spec_of(lod, right=Detail.uniform("off"), **fields)


def part_of(pixels: Pixels, crop: Crop) -> Pixels:
    """Return a part of a picture, given as shares of its width and height."""
    height, width = pixels.shape[:2]
    left, top, right, bottom = crop
    rows = slice(round(top * height), round(bottom * height))
    return np.asarray(pixels[rows, round(left * width) : round(right * width)])


def difference(pixels: Pixels, other: Pixels, gain: float) -> Pixels:
    """Return the difference of two pictures, ``gain`` times as large, around mid-grey."""
    signed = pixels.astype(np.float32) - other.astype(np.float32)
    return np.asarray(np.clip(np.rint(128.0 + gain * signed), 0, 255), np.uint8)


def fitted(pixels: Pixels, width: int) -> Pixels:
    """Return a picture resized to a width, never enlarged."""
    if pixels.shape[1] <= width:
        return pixels
    height = max(1, round(pixels.shape[0] * width / pixels.shape[1]))
    return np.asarray(Image.fromarray(pixels).resize((width, height), Image.Resampling.LANCZOS))
