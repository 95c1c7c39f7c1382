"""Which LoD an eye of a given size on the picture is drawn with. Pure: no GL, no files, no camera.

The thesis chose by pixel count (section 3.4) and switched at once (section 6.3 left the blending
open). Here the measure is the iris's diameter in pixels: it does not change when the eye turns or
the lids close, and for a facing eye its square is the pixel count.

Both ways of switching stay on the safe side: an eye is never drawn coarser than its size allows.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

from renderer.detail import Detail

SWITCHINGS: Final = ("fixed", "blended", "instant")  # what an eye's LoD does as its size changes
WIDEST_PX: Final = 7680.0
"""No iris is wider than the widest picture that a clip may have."""


@dataclass(frozen=True)
class LodStep:
    """One LoD of a policy and the largest iris, in pixels of the picture, that it is enough for.

    ``up_to_iris_px`` is None for the finest: it is used for everything larger.
    """

    lod: str
    detail: Detail
    up_to_iris_px: float | None


@dataclass(frozen=True)
class LodPolicy:
    """LoDs from the coarsest to the finest, and how an eye passes from one to the next.

    ``hysteresis``: an eye that switches at once returns to a coarser LoD only where its iris is
    smaller by this share than the coarser one would be enough for. ``band``: an eye that blends
    begins to, smaller by this share, and ends exactly where the finer LoD is needed.
    """

    steps: tuple[LodStep, ...]
    hysteresis: float = 0.1
    band: float = 0.25

    def __post_init__(self) -> None:
        faults = list(self._faults())
        if faults:
            raise ValueError("; ".join(faults))

    def _faults(self) -> Iterable[str]:
        if not self.steps:
            yield "steps: empty; a policy needs at least one LoD"
            return
        limits = [step.up_to_iris_px for step in self.steps]
        if limits[-1] is not None:
            yield (
                f"steps.{len(limits) - 1}.up_to_iris_px: {limits[-1]:g}; the finest LoD, "
                f"{self.steps[-1].lod}, has none: it is used for everything larger"
            )
        last = 0.0
        for number, limit in enumerate(limits[:-1]):
            if limit is None or not last < limit <= WIDEST_PX:
                yield (
                    f"steps.{number}.up_to_iris_px: {limit}; the LoDs run from coarse to fine, and "
                    f"each needs a size in pixels above {last:g}, to {WIDEST_PX:g}, the widest "
                    "picture"
                )
            last = limit or last
        for name in ("hysteresis", "band"):
            if not 0.0 <= getattr(self, name) <= 0.9:
                yield f"{name}: {getattr(self, name)} lies outside 0 to 0.9"

    @property
    def finest(self) -> Detail:
        """The LoD that stands for the best there is."""
        return self.steps[-1].detail

    @property
    def limits_px(self) -> tuple[float, ...]:
        """The sizes between the LoDs: one fewer than there are steps."""
        return tuple(step.up_to_iris_px or math.inf for step in self.steps[:-1])

    def choose(self, iris_px: float, *, last: int | None = None) -> int:
        """Return the number of the step for an iris of this diameter on the picture.

        ``last`` is the step that the eye had a frame ago, None if it was not there: a finer step
        is taken as soon as it is needed, a coarser one only beyond the hysteresis.
        """
        needed = sum(iris_px > limit for limit in self.limits_px)
        if last is None or needed >= last:
            return needed
        kept = sum(iris_px > limit * (1.0 - self.hysteresis) for limit in self.limits_px)
        return min(kept, last)

    def mix(self, iris_px: float) -> float:
        """Return the place between the steps of an eye that blends: 1.25 is step 1 and a quarter

        of step 2. It is continuous and rises with the size: linear in its logarithm within a band,
        whole between bands. Bands never overlap, so at most two steps take part.
        """
        place, floor_px = 0.0, 0.0
        for limit in self.limits_px:
            start = max(limit * (1.0 - self.band), floor_px)
            place += _share_of_way(iris_px, start, limit)
            floor_px = limit
        return place

    def place(self, iris_px: float, switching: str, *, last: float | None = None) -> float:
        """Return the place between the steps for one of SWITCHINGS."""
        if switching == "blended":
            return self.mix(iris_px)
        if switching == "instant":
            return float(self.choose(iris_px, last=None if last is None else round(last)))
        return float(len(self.steps) - 1)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> LodPolicy:
        """Read what ``dataclasses.asdict`` made of a policy."""
        steps = tuple(
            LodStep(row["lod"], Detail(**row["detail"]), row["up_to_iris_px"])
            for row in values["steps"]
        )
        return cls(steps, hysteresis=values["hysteresis"], band=values["band"])


def _share_of_way(size: float, start: float, end: float) -> float:
    if size <= start:
        return 0.0
    if size >= end:
        return 1.0
    return math.log(size / start) / math.log(end / start)


def shares(place: float) -> tuple[tuple[int, float], ...]:
    """Split a place between steps into one or two steps with their shares, the coarser first."""
    lower = math.floor(place)
    upper_share = place - lower
    if upper_share == 0.0:
        return ((lower, 1.0),)
    return (lower, 1.0 - upper_share), (lower + 1, upper_share)
