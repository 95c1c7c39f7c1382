"""Eyes that change their LoD on real GL: blended without a seam, at once with a jump."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Final

import moderngl
import numpy as np
import pytest

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.geometry import eye_mesh
from renderer.eye.morph import laid_on
from renderer.eye_rectangles import eye_rectangles
from renderer.frame.frame import FrameRenderer
from renderer.lod.choice import LodPolicy, LodStep
from renderer.lod.path import places_of_clip
from renderer.scene import Scene

LOW, HIGH = Detail.uniform("low"), Detail.uniform("high")
LIMIT_PX: Final = 20.0  # of the picture: 120 px on 1080 lines
POLICY: Final = LodPolicy((LodStep("low", LOW, LIMIT_PX), LodStep("high", HIGH, None)), band=0.05)
SWITCHING: Final = ClipSpec(
    left=HIGH,
    right=HIGH,
    motion="approach",
    width=320,
    height=180,
    duration_s=15 / 30,
    approach_start_px=112.0,
    approach_end_px=122.0,
    left_switching="blended",
    right_switching="instant",
    lod_policy=POLICY,
)
KEEPING: Final = replace(
    SWITCHING, left_switching="fixed", right_switching="fixed", lod_policy=None
)
LARGEST_STEP: Final = 1.15  # of the largest step of an eye that keeps its LoD
DARK: Final = 30  # of 255: pupils, and little else
SEAM_LEVELS: Final = 0.25  # of 255, the mean where a blend begins and ends


@pytest.fixture(scope="module")
def renderers(gl: moderngl.Context, standard_scene: Scene) -> tuple[FrameRenderer, FrameRenderer]:
    switching = FrameRenderer(gl, SWITCHING, scene=standard_scene)
    return switching, FrameRenderer(gl, KEEPING, scene=switching.scene)


def eyes_of(renderer: FrameRenderer, frame: int) -> tuple[np.ndarray, np.ndarray]:
    """Return both eyes' rectangles of the clip's middle, as one frame shows them."""
    middle = renderer.spec.frame_count // 2
    places = eye_rectangles(renderer.spec, 0.0, distance_px=renderer.spec.distance_px(middle))
    pixels = renderer.render_number(frame).pixels.astype(np.float32)
    return pixels[places[0]], pixels[places[1]]


def test_blending_changes_no_frame_more_than_the_approach_does(
    renderers: tuple[FrameRenderer, FrameRenderer],
) -> None:
    switching, keeping = (
        [eyes_of(renderer, frame) for frame in range(SWITCHING.frame_count)]
        for renderer in renderers
    )

    def steps(frames: list[tuple[np.ndarray, np.ndarray]], eye: int) -> np.ndarray:
        return np.array(
            [
                np.abs(after[eye] - before[eye]).mean()
                for before, after in itertools.pairwise(frames)
            ]
        )

    blended, fixed_left = steps(switching, 0), steps(keeping, 0)
    instant, fixed_right = steps(switching, 1), steps(keeping, 1)
    places = places_of_clip(SWITCHING)
    assert (places[0], places[-1]) == ((0.0, 0.0), (1.0, 1.0)), "the way passes the threshold"
    assert blended.max() < LARGEST_STEP * fixed_left.max(), (blended, fixed_left)
    assert instant.max() > 1.5 * fixed_right.max(), (instant, fixed_right)
    jump = next(n for n, row in enumerate(places) if row[1] == 1.0) - 1
    assert int(instant.argmax()) == jump


def test_a_blend_begins_as_the_one_and_ends_as_the_other(
    renderers: tuple[FrameRenderer, FrameRenderer],
) -> None:
    renderer = renderers[0]
    size = 110.0
    place = eye_rectangles(SWITCHING, 0.0, distance_px=size)[0]
    seen = views(SWITCHING, 0.0, distance_px=size)

    def eye(at: float) -> np.ndarray:
        shown = renderer.render_views(seen, places=(at, 1.0)).pixels
        return shown[place].astype(np.float32)

    low, little, half, nearly, high = (eye(at) for at in (0.0, 1e-3, 0.5, 1 - 1e-3, 1.0))
    assert np.abs(low - little).mean() < SEAM_LEVELS
    assert np.abs(high - nearly).mean() < SEAM_LEVELS
    assert np.abs(high - low).mean() > 10 * SEAM_LEVELS, "the LoDs differ, so the test can fail"
    assert np.abs(half - low).mean() < np.abs(high - low).mean()
    assert np.abs(half - high).mean() < np.abs(high - low).mean()


def test_from_the_side_a_blending_eye_has_one_pupil(
    renderers: tuple[FrameRenderer, FrameRenderer],
) -> None:
    """Low does not refract and high does: their pupils lie beside each other."""
    azimuth_deg, size = 45.0, 240.0
    seen = views(SWITCHING, azimuth_deg, distance_px=size)
    place = eye_rectangles(SWITCHING, azimuth_deg, distance_px=size)[0]

    def dark(at: float) -> np.ndarray:
        shown = renderers[0].render_views(seen, places=(at, 1.0)).pixels[place]
        return shown.max(axis=-1) < DARK

    low, half, high = (dark(at) for at in (0.0, 0.5, 1.0))
    assert (low & high).sum() < 0.8 * min(low.sum(), high.sum()), "a fade would keep but this"
    assert half.sum() > 0.9 * min(low.sum(), high.sum())


def test_a_frame_alone_is_the_frame_of_the_clip(
    renderers: tuple[FrameRenderer, FrameRenderer],
) -> None:
    frame = next(n for n, row in enumerate(places_of_clip(SWITCHING)) if 0.3 < row[0] < 0.7)
    first = renderers[0].render_number(frame).pixels
    renderers[0].render_number(SWITCHING.frame_count - 1)
    np.testing.assert_array_equal(renderers[0].render_number(frame).pixels, first)


@pytest.mark.parametrize(("coarse", "fine"), [(150, 500), (150, 8000), (500, 2000)])
def test_a_fine_mesh_lies_on_the_coarse_one_vertex_by_vertex(coarse: int, fine: int) -> None:
    target, points = eye_mesh(coarse), eye_mesh(fine).positions
    laid = laid_on(points, target)
    lengths = np.linalg.norm(points, axis=1), np.linalg.norm(laid, axis=1)
    np.testing.assert_allclose(np.cross(points, laid), 0.0, atol=1e-9)
    moved = lengths[0] - lengths[1]
    # Chords lie inside the globe: by at most the sagitta of the coarse mesh's longest edge.
    edges = target.positions[target.triangles]
    longest = np.linalg.norm(edges - np.roll(edges, 1, axis=1), axis=-1).max()
    assert moved.min() > -0.15, "but for the limbus, which is hollow"
    assert 0.0 < moved.max() < longest**2 / (4 * 7.0)
    corners = laid_on(target.positions, target)
    np.testing.assert_allclose(corners, target.positions, atol=1e-9)
