"""The reflection's cube map by size: static, drawn once, against dynamic, drawn every frame.

Frames of one ultra eye that mirrors such a cube minus frames of the same eye that mirrors nothing.
A dynamic one is a static one of its size with the moving people in front. Beside them whole frames
of two ultra eyes with the cubes that clips have: the table's, and those that the size asks for.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from renderer.benchmark.clock import WARM_UP
from renderer.benchmark.result import Bench
from renderer.benchmark.spread import difference
from renderer.benchmark.stand import BOTH, Stand, Step
from renderer.clip_values import CUBE_SIZES
from renderer.crowd.cube import CrowdCube
from renderer.detail import Detail
from renderer.eye.cube_size import cube_px
from renderer.frame.frame import FrameRenderer

PART: Final = "cubes"
SIZES_PX: Final = (128, 256, 512, 1024, 2048)
BASE: Final = Detail.uniform("ultra")  # what the other effects are
LEVEL: Final = {"static": "high", "dynamic": "ultra"}  # whose shader reads such a cube


def cube_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return a step per size, from the smallest, then clips'; in a hurry the largest and these."""
    weight = 3.0 * (rounds + WARM_UP + 8)
    return [
        *(
            Step(PART, f"{size} pixels a face", weight, partial(_measure, size_px=size))
            for size in SIZES_PX[-1 if is_quick else 0 :]
        ),
        Step(PART, "as clips have them", weight, _measure_clips),
    ]


def _measure(stand: Stand, bench: Bench, *, size_px: int) -> None:
    off = stand.spec(BASE.with_levels(reflection="off"))
    specs = {kind: stand.spec(BASE.with_levels(reflection=level)) for kind, level in LEVEL.items()}
    frames = [mirroring(stand, kind, size_px) for kind in LEVEL]
    without, *shots = stand.time([stand.frames(off), *frames])
    bench.rows.extend(
        stand.row(
            PART,
            specs[kind],
            difference(own, without),
            effect="reflection",
            level=LEVEL[kind],
            base="ultra",
            cube=kind,
            cube_px=size_px,
        )
        for kind, own in zip(LEVEL, shots, strict=True)
    )


def _measure_clips(stand: Stand, bench: Bench) -> None:
    specs = [stand.spec(BASE, eyes=BOTH, cube_size=choice) for choice in CUBE_SIZES]
    shots = stand.time([stand.frames(spec, eyes=BOTH) for spec in specs], are_whole=True)
    bench.rows.extend(
        stand.frame_row(
            PART,
            spec,
            own,
            lod="ultra",
            eyes=len(BOTH),
            cube=spec.cube_size,
            cube_px=cube_px(BASE, spec),
        )
        for spec, own in zip(specs, shots, strict=True)
    )


def mirroring(stand: Stand, kind: str, size_px: int) -> FrameRenderer:
    """Return frames of an ultra eye that mirrors a cube of another size than its level's."""
    detail = BASE.with_levels(reflection=LEVEL[kind])
    own_px = cube_px(detail, stand.spec(detail))
    scene = stand.frames(stand.spec(BASE.with_levels(reflection="off"))).scene
    kept = scene.crowd_cubes.get(own_px)
    scene.crowd_cubes[own_px] = CrowdCube(stand.studio.gl, size_px, scene.crowd)
    frames = stand.frames(stand.spec(detail))
    del scene.crowd_cubes[own_px]
    if kept:
        scene.crowd_cubes[own_px] = kept
    frames.eye_models[0].values["u_static_cube"] = scene.surroundings.cube(size_px)
    return frames
