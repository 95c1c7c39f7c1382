"""Strips that need a scene of their own for each tile: sun, gaze, vergence, blink, surroundings."""

from __future__ import annotations

from typing import Final

from renderer.frame.view_passes import PASSES
from renderer.gallery.shots import (
    BOTH_EYES,
    LEFT_EYE,
    LEFT_IRIS,
    WHOLE,
    Shot,
    left_only,
    spec_of,
)
from renderer.gallery.strips import Strip, of_shots

SUN_AZIMUTHS_DEG: Final = (-60, -30, 0, 30, 60)
SUN_ELEVATIONS_DEG: Final = (5, 15, 35, 50, 65)


def _sun() -> list[Shot]:
    places = [(azimuth, 25) for azimuth in SUN_AZIMUTHS_DEG]
    places += [(-30, elevation) for elevation in SUN_ELEVATIONS_DEG]
    return [
        Shot(
            f"azimuth {azimuth:+d}, elevation {elevation}",
            left_only(sun_azimuth_deg=azimuth, sun_elevation_deg=elevation),
            LEFT_IRIS,
            azimuth_deg=0.0,
        )
        for azimuth, elevation in places
    ]


def _gaze() -> list[Shot]:
    return [
        Shot(
            f"yaw {yaw:+d}, pitch {pitch:+d}",
            spec_of(distance="near", gaze_yaw_deg=yaw, gaze_pitch_deg=pitch),
            BOTH_EYES,
            azimuth_deg=0.0,
        )
        for yaw, pitch in ((-30, 0), (30, 0), (0, 20), (0, -30), (20, 12), (-20, -20))
    ]


def _vergence() -> list[Shot]:
    return [
        Shot(
            f"vergence {vergence} degrees",
            spec_of(distance="near", vergence_deg=vergence),
            BOTH_EYES,
            azimuth_deg=0.0,
        )
        for vergence in (0, 10, 20)
    ]


def _blink() -> list[Shot]:
    return [
        Shot(f"blink {share:g}", left_only(blink=share), LEFT_EYE)
        for share in (0.0, 0.25, 0.5, 0.75, 0.9, 1.0)
    ]


def _passes() -> list[Shot]:
    """Return one frame after each of its passes."""
    return [
        Shot(
            f"{number}: {name}",
            spec_of(distance="near", crowd=30),
            WHOLE,
            azimuth_deg=35.0,
            until=name,
        )
        for number, name in enumerate(PASSES, start=1)
    ]


SCENES: Final = (
    Strip("passes", "How a frame comes about", of_shots(_passes()), 3, 600),
    Strip("sun", "The sun moves the caustic", of_shots(_sun()), 5, 300),
    Strip("gaze", "The lids follow the gaze", of_shots(_gaze()), 2, 720),
    Strip("vergence", "Both eyes on one point", of_shots(_vergence()), 3, 600),
    Strip("blink", "A blink", of_shots(_blink()), 3),
)
