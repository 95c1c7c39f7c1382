"""What the page asks for: eyes, camera and picture, read from an address and checked."""

from __future__ import annotations

from dataclasses import replace
from typing import Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, LEVELS, Detail
from renderer.lod.choice import LodPolicy

LETTERS: Final = {level[0]: level for level in LEVELS}
LARGEST_PX: Final = 1200.0  # of an iris on 1080 lines: nearer, the camera meets the lashes
STEEPEST_DEG: Final = 80.0  # of elevation: over the pole, up and down would change places
CODE: Final = f"^[{''.join(LETTERS)}]{{{len(EFFECTS)}}}$"
FIXED: Final = "fixed"
Switching = Literal["fixed", "blended", "instant"]
EYES: Final = {"both": (0, 1), "halves": (0, 1), "left": (0,), "right": (1,)}


class Look(BaseModel):
    """One picture that the page wants.

    ``left`` and ``right`` are the eyes' levels, a letter per effect in the order of EFFECTS: o(ff),
    l(ow), m(edium), h(igh), u(ltra). An eye whose switching is not "fixed" takes its LoD from its
    size instead; no picture knows the one before, so that nothing delays a switch. ``distance`` is
    an iris's diameter on 1080 lines in pixels, angles are in degrees, ``time`` in s. ``eyes`` is
    what is in view: both in one picture, each in its half, or one alone. ``divide`` makes width and
    height so many times smaller.
    """

    model_config = ConfigDict(extra="forbid")

    left: str = Field("u" * len(EFFECTS), pattern=CODE)
    right: str = Field("u" * len(EFFECTS), pattern=CODE)
    left_switching: Switching = "fixed"
    right_switching: Switching = "fixed"
    azimuth: float = Field(0.0, ge=-180.0, le=180.0)
    elevation: float = Field(0.0, ge=-STEEPEST_DEG, le=STEEPEST_DEG)
    distance: float = Field(160.0, ge=4.0, le=LARGEST_PX)
    time: float = Field(0.0, ge=0.0, le=3600.0)
    eyes: Literal["both", "halves", "left", "right"] = "both"
    wireframe: bool = False
    divide: int = Field(1, ge=1, le=8)

    def spec(self, base: ClipSpec, policy: LodPolicy) -> ClipSpec:
        """Return the clip whose frame is asked for: the command's, with these levels and size.

        ``policy`` is what eyes switch by.
        """
        size = [max(64, side // self.divide // 2 * 2) for side in (base.width, base.height)]
        is_left_fixed, is_right_fixed = self.left_switching == FIXED, self.right_switching == FIXED
        return replace(
            base,
            left=detail_of(self.left) if is_left_fixed else policy.finest,
            right=detail_of(self.right) if is_right_fixed else policy.finest,
            left_switching=self.left_switching,
            right_switching=self.right_switching,
            lod_policy=None if is_left_fixed and is_right_fixed else policy,
            distance="near" if self.eyes == "both" else "macroscopic",
            width=size[0],
            height=size[1],
        )


def detail_of(code: str) -> Detail:
    """Return the levels that a code of letters names."""
    return Detail(**{name: LETTERS[at] for name, at in zip(EFFECTS, code, strict=True)})


def code_of(detail: Detail) -> str:
    """Return a LoD as a code of letters."""
    return "".join(level[0] for level in detail.levels().values())
