"""A frame with more and more people in it.

Two scenes: the clips' own, where two ultra eyes mirror everybody and the camera stands where most
of the crowd is in the picture; and the thesis's, where all characters face the camera, 30 of them
with 60 eyes, each at the LoD that its size asks for. From aside some eyes leave the picture or are
painted (from 50 degrees 38 are drawn), so the group is seen from the front.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from renderer.benchmark.clock import WARM_UP
from renderer.benchmark.result import Bench
from renderer.benchmark.stand import BOTH, Stand, Step
from renderer.clip_values import CROWDS
from renderer.crowd.group import GroupRenderer
from renderer.detail import Detail
from renderer.frame.frame import Frame

PART: Final = "crowd"
DISTANCE: Final = "far"
LOD: Final = "ultra"
GROUP: Final = "group"  # told as a row's distance: the camera sees everybody
FRONT: Final = 0.02  # of an orbit's azimuths: a degree and a bit to either side
BY_SIZE: Final = "by size"  # told as a group's LoD


def crowd_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return a step per scene, whose frames must be taken in turn; in a hurry of the extremes."""
    crowds = (CROWDS[0], CROWDS[-1]) if is_quick else CROWDS
    groups = CROWDS[-1:] if is_quick else CROWDS[1:]
    return [
        Step(PART, _title(crowds), _weight(crowds, rounds), partial(_measure, crowds=crowds)),
        Step(
            PART,
            f"group of {_title(groups)}",
            _weight(groups, rounds),
            partial(_measure_groups, crowds=groups),
        ),
    ]


def _title(crowds: tuple[int, ...]) -> str:
    return ", ".join(map(str, crowds)) + " people"


def _weight(crowds: tuple[int, ...], rounds: int) -> float:
    return len(crowds) * (1.5 * (rounds + WARM_UP) + 25)


def _measure(stand: Stand, bench: Bench, *, crowds: tuple[int, ...]) -> None:
    detail = Detail.uniform(LOD)
    specs = [stand.spec(detail, DISTANCE, eyes=BOTH, crowd=crowd) for crowd in crowds]
    shots = stand.time([stand.frames(spec, eyes=BOTH) for spec in specs], are_whole=True)
    bench.rows.extend(
        stand.frame_row(PART, spec, own, lod=LOD, eyes=len(BOTH), crowd=spec.crowd)
        for spec, own in zip(specs, shots, strict=True)
    )


def _measure_groups(stand: Stand, bench: Bench, *, crowds: tuple[int, ...]) -> None:
    detail = Detail.uniform(LOD)
    specs = [stand.spec(detail, DISTANCE, eyes=BOTH, crowd=crowd) for crowd in crowds]
    groups = [stand.studio.group_renderer(spec) for spec in specs]
    shots = stand.time([FromTheFront(group) for group in groups], are_whole=True)
    bench.rows.extend(
        stand.frame_row(PART, spec, own, **told_of(group))
        for spec, group, own in zip(specs, groups, shots, strict=True)
    )


@dataclass(frozen=True)
class FromTheFront:
    """Frames of a group whose cameras stay where every eye is in the picture."""

    group: GroupRenderer

    def render(self, azimuth_deg: float, *, time_s: float) -> Frame:
        """Draw a frame from FRONT of an azimuth and read it back."""
        return self.group.render(FRONT * azimuth_deg, time_s=time_s)

    def show(self, azimuth_deg: float, *, time_s: float) -> None:
        """Draw a frame from FRONT of an azimuth and leave it where it is."""
        self.group.show(FRONT * azimuth_deg, time_s=time_s)


def told_of(group: GroupRenderer) -> dict[str, Any]:
    """Return what a row tells of a group after its frames."""
    eyes = group.eyes_drawn
    largest = max((eye.iris_px for eye in eyes), default=0.0)  # small ones are painted
    return {
        "distance": GROUP,
        "iris_px": round(largest, 2),
        "lod": BY_SIZE,
        "eyes": len(eyes),
        "crowd": group.spec.crowd,
    }
