"""The scenes whose rates were aimed at for a GPU, at the size of the aims whatever the rest has.

On software GL no GPU can be timed, but what it would wait for can: the processor's time for frames
that are drawn as a GPU gets them, everything whole and nothing read back on the way.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

from renderer.benchmark.clock import WARM_UP
from renderer.benchmark.crowd import FromTheFront, told_of
from renderer.benchmark.result import Bench
from renderer.benchmark.stand import BOTH, Stand, Step
from renderer.benchmark.verdicts import GPU_AIMS, SIZE
from renderer.clip import ClipSpec
from renderer.clip_values import CROWDS
from renderer.crowd.group import GroupRenderer
from renderer.detail import Detail
from renderer.eye.cube_size import cube_px
from renderer.frame.frame import FrameRenderer
from renderer.gl import context

PART: Final = "aims"
LOD: Final = Detail.uniform("ultra")
CUBES: Final = "table"  # 2048 pixels a face
_NAMES: Final = "SOFTWARE"  # what software GL is known by, a constant but for here


def aim_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return a step per aim; being in a hurry changes nothing but the rounds."""
    frames = (8.0 if is_quick else 2.0) * (rounds + WARM_UP)  # larger than the others in a hurry
    measures = {"macroscopic": (_measure_eyes, 60.0), "group": (_measure_group, 20.0)}
    return [
        Step(PART, GPU_AIMS[at].title, frames + setting_up, measure)
        for at, (measure, setting_up) in measures.items()
    ]


def _spec(**changes: Any) -> ClipSpec:
    width, height = SIZE
    return ClipSpec(left=LOD, right=LOD, width=width, height=height, cube_size=CUBES, **changes)


@contextmanager
def drawn_as_on_a_gpu() -> Iterator[None]:
    """Let what is made meanwhile draw its parts whole on software GL, too (``chooses_parts``)."""
    names = context.SOFTWARE
    setattr(context, _NAMES, ())
    try:
        yield
    finally:
        setattr(context, _NAMES, names)


def _measure_eyes(stand: Stand, bench: Bench) -> None:
    spec = _spec()
    with drawn_as_on_a_gpu():
        frames = FrameRenderer(stand.studio.gl, spec)  # a scene of its own: others choose parts
        (shots,) = stand.time([frames], are_whole=True)
    bench.rows.append(
        stand.frame_row(
            PART,
            spec,
            shots,
            lod="ultra",
            eyes=len(BOTH),
            cube=CUBES,
            cube_px=cube_px(LOD, spec),
        )
    )


def _measure_group(stand: Stand, bench: Bench) -> None:
    spec = _spec(crowd=CROWDS[-1])
    with drawn_as_on_a_gpu():
        group = GroupRenderer(stand.studio.gl, spec)
        (shots,) = stand.time([FromTheFront(group)], are_whole=True)
    bench.rows.append(stand.frame_row(PART, spec, shots, **told_of(group)))
