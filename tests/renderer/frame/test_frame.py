"""Whole frames on real GL: reproducible, fair between the eyes, true to what "off" means."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import moderngl
import numpy as np
import pytest

from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, TABLE, Detail
from renderer.eye_rectangles import eye_rectangles
from renderer.frame.frame import Frame, FrameRenderer
from renderer.gl.context import identify
from renderer.production.batch import render_clip
from renderer.scene import Scene
from renderer.view import cropped

LOW, ULTRA = Detail.uniform("low"), Detail.uniform("ultra")
SPEC = ClipSpec(left=LOW, right=ULTRA, width=320, height=180, duration_s=0.1, orbit_deg=60)


@pytest.fixture(scope="module")
def scene(standard_scene: Scene) -> Scene:
    return standard_scene


def render(gl: moderngl.Context, scene: Scene, spec: ClipSpec, azimuth_deg: float = 0.0) -> Frame:
    return FrameRenderer(gl, spec, scene=scene).render(azimuth_deg, time_s=0.5)


@dataclass
class Shared:
    """A source of frames in the scene that all tests share."""

    gl: moderngl.Context
    scene: Scene

    @property
    def gl_renderer(self) -> str:
        return identify(self.gl).renderer

    @property
    def gl_version(self) -> str:
        return identify(self.gl).version

    def frames(self, spec: ClipSpec, numbers: Sequence[int] | None = None) -> Iterator[Frame]:
        renderer = FrameRenderer(self.gl, spec, scene=self.scene)
        for number in range(spec.frame_count) if numbers is None else numbers:
            yield renderer.render_number(number)


def test_another_process_renders_the_same_clip_bit_for_bit(
    gl: moderngl.Context, scene: Scene, tmp_path: Path
) -> None:
    code = (
        "import sys; from pathlib import Path; from renderer.production.batch import render_clip;"
        "from renderer.clip import ClipSpec; from renderer.studio import Studio; import json;"
        "spec = ClipSpec.from_dict(json.loads(sys.argv[2]));"
        "print(render_clip(spec, Path(sys.argv[1]), source=Studio(), with_flip=False)"
        ".raw_sha256)"
    )
    spec = replace(SPEC, width=160, height=90, cube_size="auto")  # smaller mirrors, the same code
    told = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "other"), json.dumps(spec.to_dict())],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    here = render_clip(spec, tmp_path / "here", source=Shared(gl, scene), with_flip=False)
    assert told.strip() == here.raw_sha256
    assert min(min(row) for row in here.visible_px) > 0


def test_one_eye_alone_is_drawn_without_the_other(gl: moderngl.Context, scene: Scene) -> None:
    frame = FrameRenderer(gl, SPEC, scene=scene, eyes=(1,)).render(0.0)
    assert frame.visible_px[0] == 0
    assert frame.visible_px[1] > 500


def test_a_part_of_a_view_shows_what_the_whole_shows_there(
    gl: moderngl.Context, scene: Scene
) -> None:
    """The background too, which looks along each pixel's direction by the view's projection."""
    spec = replace(SPEC, right=LOW, distance="far")
    whole = FrameRenderer(gl, spec, scene=scene)
    part = FrameRenderer(gl, spec.resized(100, 80), scene=scene)
    (view,) = views(spec, 20.0)
    shown = part.render_views((cropped(view, (20, 30, 100, 80)),), time_s=0.5).pixels
    expected = whole.render(20.0, time_s=0.5).pixels[70:150, 20:120]
    assert np.abs(shown.astype(int) - expected).mean() < 1.0
    assert expected.std() > 5.0


@pytest.mark.parametrize("effect", EFFECTS)
def test_off_is_the_same_frame_as_a_level_that_table_5_1_calls_none(
    gl: moderngl.Context, scene: Scene, effect: str
) -> None:
    same = [
        level
        for level in ("low", "medium", "high", "ultra")
        if TABLE[effect][level].settings == TABLE[effect]["off"].settings
    ]
    if effect in ("texture", "tessellation", "sclera"):
        assert not same
        return
    frames = [
        render(gl, scene, replace(SPEC, left=ULTRA.with_levels(**{effect: level}))).pixels
        for level in ("off", *same)
    ]
    assert all(np.array_equal(frames[0], other) for other in frames[1:])
    assert "low" in same


@pytest.mark.parametrize("effect", EFFECTS)
def test_every_effect_changes_the_ultra_eye_and_only_its_own_eye(
    gl: moderngl.Context, scene: Scene, effect: str
) -> None:
    both = replace(SPEC, left=ULTRA, right=ULTRA)
    full = render(gl, scene, both, 20.0).pixels.astype(int)
    without = replace(both, left=ULTRA.with_levels(**{effect: "off"}))
    changed = np.abs(render(gl, scene, without, 20.0).pixels.astype(int) - full).max(axis=-1)
    left, right = eye_rectangles(both, 20.0)
    assert changed[left].max() >= 8, f"{effect} off cannot be seen"
    assert changed[right].max() == 0, f"{effect} off on the left changes the right eye"


def test_swapping_the_eyes_renders_anew_and_leaves_the_face_alone(
    gl: moderngl.Context, scene: Scene
) -> None:
    one = render(gl, scene, SPEC).pixels.astype(int)
    two = render(gl, scene, SPEC.swapped()).pixels.astype(int)
    changed = np.abs(one - two).max(axis=-1)
    left, right = eye_rectangles(SPEC, 0.0)
    assert changed[left].mean() > 2
    assert changed[right].mean() > 2
    assert not np.array_equal(two, one[:, ::-1])
    changed[left] = changed[right] = 0
    assert (changed > 1).mean() < 0.02  # a step or less: the light that both eyes scatter


def test_the_crowd_moves_in_the_dynamic_reflection_only(gl: moderngl.Context, scene: Scene) -> None:
    for level, moves in (("high", False), ("ultra", True)):
        eye = ULTRA.with_levels(reflection=level)
        renderer = FrameRenderer(gl, replace(SPEC, left=eye, right=eye), scene=scene)
        now = renderer.render(0.0, time_s=0.0).pixels
        later = renderer.render(0.0, time_s=1.3).pixels
        rows, columns = eye_rectangles(SPEC, 0.0)[0]
        assert bool((now[rows, columns] != later[rows, columns]).any()) is moves, level
