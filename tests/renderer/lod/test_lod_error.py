"""A coarse part of the policy's derivation, measured again: the committed figures still hold."""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib import resources
from typing import Any, Final, cast

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye_rectangles import eye_rectangles
from renderer.frame.frame import FrameRenderer
from renderer.lod.derivation import LodError
from renderer.lod.error import Look, Sight, measure_errors, render_rectangles
from renderer.lod.policy import DEFAULT_NAME, default_policy
from renderer.lod.visibility import JUST_NOTICEABLE
from renderer.scene import Scene
from renderer.studio import Studio

SIZES: Final = (6.0, 45.0)
ULTRA: Final = Detail.uniform("ultra")
# Seen in front, where the sun's image stands in the pupil, errors are largest: these lie amid them.
AZIMUTHS_DEG: Final = (-35.0, 35.0)
# Four of the policy's twelve cases stand for all.
TOLERANCE: Final = 0.35


@dataclass
class SharedStudio:
    """A studio in the tests' context and scene."""

    gl: moderngl.Context
    scene: Scene

    def renderer(self, spec: ClipSpec) -> FrameRenderer:
        return FrameRenderer(self.gl, spec, scene=self.scene)


@pytest.fixture(scope="module")
def studio(gl: moderngl.Context, standard_scene: Scene) -> Studio:
    return cast(Studio, SharedStudio(gl, standard_scene))


@pytest.fixture(scope="module")
def errors(studio: Studio) -> list[LodError]:
    return measure_errors(
        studio,
        {name: Detail.uniform(name) for name in ("low", "high")},
        reference=ULTRA,
        sights=[Sight(size, azimuth) for size in SIZES for azimuth in AZIMUTHS_DEG],
        looks=[Look()],
    )


def mean_error(errors: list[LodError], lod: str, size: float) -> float:
    return float(np.mean([row.error for row in errors if (row.lod, row.iris_px) == (lod, size)]))


def test_the_committed_figures_are_measured_again(errors: list[LodError]) -> None:
    text = (resources.files("renderer.lod") / DEFAULT_NAME).read_text(encoding="utf-8")
    committed: dict[str, Any] = json.loads(text)["provenance"]["mean_error"]
    low = mean_error(errors, "low", 45.0)
    assert low == pytest.approx(committed["low"]["45"], rel=TOLERANCE)
    assert mean_error(errors, "low", 6.0) < 0.6 * low
    assert mean_error(errors, "high", 45.0) < 3 * committed["high"]["45"]


def test_the_default_policy_draws_no_lod_that_shows(errors: list[LodError]) -> None:
    policy = default_policy()
    chosen = {size: policy.steps[policy.choose(size)].lod for size in SIZES}
    assert chosen == {6.0: "low", 45.0: "high"}
    for size, lod in chosen.items():
        assert mean_error(errors, lod, size) < JUST_NOTICEABLE
    assert mean_error(errors, "low", 45.0) > 1.5 * JUST_NOTICEABLE


def test_a_rectangle_is_the_one_of_the_whole_frame(studio: Studio) -> None:
    """Cut from the frustum, an eye looks as in a frame of 1920 x 1080."""
    detail, sight = Detail.uniform("low"), Sight(30.0, 20.0)
    ((_, part),) = render_rectangles(studio, detail, sights=[sight], look=Look())
    spec = ClipSpec(left=detail, right=detail, motion="approach", approach_end_px=30.0)
    whole = studio.renderer(spec).render(20.0).pixels[eye_rectangles(spec, 20.0)[1]]
    assert part.shape == whole.shape
    # Glare of what lies outside the part is missing, and that is all.
    assert np.abs(part.astype(float) - whole).mean() < 2.0
