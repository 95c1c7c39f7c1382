"""What one eye asks of a GPU, apart from any clock: triangles, fetches and arithmetic per pixel.

One eye at macroscopic, seen from the front. Each variant's shader counts itself (``counting``);
all read the maps of the ultra eye, whose sizes change no count. A LoD's figures are means over the
pixels that it shades, an effect's over those where it does something.
"""

from __future__ import annotations

from functools import partial
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.benchmark.counting import counted
from renderer.benchmark.effects import levels_of
from renderer.benchmark.result import Bench, Work
from renderer.benchmark.samples import OURS, SAMPLES
from renderer.benchmark.stand import ONE, Stand, Step
from renderer.camera import views
from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, STANDARD_LODS, Detail
from renderer.eye.model import eye_constants
from renderer.eye.place import eye_centre_mm
from renderer.eye.silhouette import detail_mesh, hull_mesh, vertex_array
from renderer.frame.frame import FrameRenderer
from renderer.gl.program import build_program

PART: Final = "work"
ULTRA: Final = Detail.uniform("ultra")

Counts = npt.NDArray[np.float32]


def work_steps(*, is_quick: bool) -> list[Step]:
    """Return the one step; in a hurry it leaves the effects' levels out."""
    variants = 4 + len(SAMPLES) + len(OURS) + (0 if is_quick else 25)
    weight = 10.0 + 3.0 * variants
    return [Step(PART, "counting", weight, partial(_measure, has_effects=not is_quick))]


def _measure(stand: Stand, bench: Bench, *, has_effects: bool) -> None:
    frames = stand.frames(stand.spec(ULTRA))
    for lod in STANDARD_LODS:
        detail = Detail.uniform(lod)
        seen, fetches, arithmetic = np.moveaxis(_counts(stand, frames, detail), -1, 0)
        bench.work.append(
            Work(
                lod=lod,
                triangles=len(detail_mesh(detail).triangles),
                pixels=int(seen.sum()),
                fetches=_mean(fetches, seen > 0),
                arithmetic=_mean(arithmetic, seen > 0),
            )
        )
    ultra = _counts(stand, frames, ULTRA)
    without = _counts(stand, frames, ULTRA.with_levels(subsurface="off"))
    for level in OURS:
        ours = _counts(stand, frames, ULTRA.with_levels(subsurface=level))
        bench.work.append(_effect(ours, without, effect="subsurface", level=level, samples=0))
    for samples in SAMPLES:
        sums = _counts(stand, frames, ULTRA, subsurface_samples=samples)
        bench.work.append(
            _effect(sums, without, effect="subsurface", level="ultra", samples=samples)
        )
    for effect in EFFECTS if has_effects else ():
        off = _counts(stand, frames, ULTRA.with_levels(**{effect: "off"}))
        for level in levels_of(effect)[1:]:
            is_own = level == "ultra"
            own = ultra if is_own else _counts(stand, frames, ULTRA.with_levels(**{effect: level}))
            bench.work.append(_effect(own, off, effect=effect, level=level))


def _effect(own: Counts, off: Counts, **says: Any) -> Work:
    """Return what an effect adds where it adds anything, of counts with it and without it."""
    both = (own[..., 0] > 0) & (off[..., 0] > 0)
    more = own[..., 1:] - off[..., 1:]
    acts = both & np.any(more != 0, axis=-1)
    return Work(
        base="ultra",
        pixels=int(acts.sum()),
        fetches=_mean(more[..., 0], acts),
        arithmetic=_mean(more[..., 1], acts),
        **says,
    )


def _mean(values: Counts, where: npt.NDArray[np.bool_]) -> float:
    return round(float(values[where].mean()), 2) if where.any() else 0.0


def _counts(stand: Stand, frames: FrameRenderer, detail: Detail, **changes: Any) -> Counts:
    """Return (height, width, 3): whether the eye shaded a pixel, its fetches, its arithmetic."""
    spec = stand.spec(detail, **changes)
    return count_pixels(stand.studio.gl, spec, frames.eye_models[0].values)


def count_pixels(gl: moderngl.Context, spec: ClipSpec, values: dict[str, Any]) -> Counts:
    """Draw the left eye of a clip with a shader that counts itself, on the maps in ``values``.

    Returns (height, width, 3) float32, first row on top: 1 where the eye is seen between the lids,
    fetches, arithmetic.
    """
    program = build_program(
        gl,
        "eye.vert",
        fragment="eye.frag",
        constants=eye_constants(spec.left, spec) | {"OWN_FACE": 1},
        rewrite_fragment=counted,
    )
    is_fine = spec.left.setting("tessellation", "normals") == "analytic"
    mesh = vertex_array(gl, program, hull_mesh() if is_fine else detail_mesh(spec.left))
    view = views(spec, 0.0, eyes=ONE)[0]
    distance_mm = float(np.linalg.norm(view.position_mm - eye_centre_mm(0)))
    program.set(
        **values,
        u_view_matrix=view.view_matrix,
        u_projection=view.projection,
        u_camera_mm=view.position_mm,
        u_mm_per_px=2 * distance_mm / (float(view.projection[1, 1]) * spec.height),
    )
    size = (spec.width, spec.height)
    target = gl.framebuffer([gl.texture(size, 4, dtype="f4")], gl.depth_renderbuffer(size))
    with gl.scope(target, moderngl.CULL_FACE | moderngl.DEPTH_TEST):
        target.clear()
        mesh.render()
    pixels = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
    return np.roll(pixels.reshape(spec.height, spec.width, 3)[::-1], 1, axis=-1)
