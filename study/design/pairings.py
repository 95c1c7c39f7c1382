"""Pairings of LoDs at distances: clips written out, clips generated from factors, catch clips.

Pure. A pairing names LoDs and a distance, and an iris or a crowd where a study has several; sizes
and light come from the rest of the study.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product
from typing import Annotated, Literal, NamedTuple

from pydantic import Field, field_validator

from renderer.detail import EFFECTS, LEVELS, Detail
from study.design.faults import refuse, unknown
from study.design.parts import Distance, Motion, Name, Part, People


class LodRow(Part):
    """One LoD: the level of each effect; ``base`` names the LoD that fills in unnamed effects.

    A row with ``switching`` has no levels: the eye's LoD follows from its size on the picture.
    """

    base: str | None = None
    switching: Literal["blended", "instant"] | None = None
    texture: str | None = None
    refraction: str | None = None
    reflection: str | None = None
    subsurface: str | None = None
    caustics: str | None = None
    tessellation: str | None = None
    sclera: str | None = None

    @field_validator(*EFFECTS)
    @classmethod
    def _check_level(cls, level: str | None) -> str | None:
        if level is not None and level not in LEVELS:
            raise refuse(unknown("level", level, LEVELS))
        return level

    def levels(self) -> dict[str, str]:
        """Return effect -> level of the effects that this row names itself."""
        return {e: getattr(self, e) for e in EFFECTS if getattr(self, e) is not None}


def detail_of(lods: dict[str, LodRow], name: str) -> Detail:
    """Return a LoD's seven levels, its bases followed."""
    row = lods[name]
    if row.base is None:
        return Detail(**row.levels())
    return detail_of(lods, row.base).with_levels(**row.levels())


class Condition(NamedTuple):
    """What a clip compares and from where: its LoDs, distance, motion and crowd."""

    distance: str
    left: str
    right: str
    motion: str
    crowd: int | None

    def swapped(self) -> Condition:
        """Exchange left and right."""
        return self._replace(left=self.right, right=self.left)


class Clip(Part):
    """One pairing at one distance. Left and right are the viewer's.

    ``iris`` names one of the study's irises; None is that of ``[eye]``. ``crowd`` is the number of
    other characters; None is that of ``[scene]``.
    """

    id: Name
    distance: Distance
    left: str
    right: str
    motion: Motion = "orbit"
    iris: str | None = None
    crowd: People | None = None

    @property
    def is_catch(self) -> bool:
        """Both eyes have the same LoD: who notices a difference here measures false alarms."""
        return self.left == self.right

    @property
    def condition(self) -> Condition:
        """What is compared, from where and amid whom: all but the iris."""
        return Condition(self.distance, self.left, self.right, self.motion, self.crowd)

    @property
    def pairing(self) -> str:
        """The clip's id without its iris."""
        return self.id.removesuffix(f"-{self.iris}") if self.iris else self.id


class CatchClip(Part):
    """The same LoD in both eyes, written shortly."""

    id: Name | None = None
    distance: Distance
    lod: str
    motion: Motion = "orbit"
    iris: str | None = None
    crowd: People | None = None

    def clip(self) -> Clip:
        """Return the clip that shows this LoD twice."""
        return Clip(
            id=self.id or _named(f"catch-{self.distance}-{self.lod}", self.crowd, self.iris),
            distance=self.distance,
            left=self.lod,
            right=self.lod,
            motion=self.motion,
            iris=self.iris,
            crowd=self.crowd,
        )


def _named(pairing: str, crowd: int | None, iris: str | None) -> str:
    """Return a clip's id: its pairing, then crowd and iris where it has its own."""
    ends = (None if crowd is None else f"crowd-{crowd}", iris)
    return "-".join([pairing, *(end for end in ends if end is not None)])


class Factors(Part):
    """Every LoD of ``lods`` beside every LoD of ``against`` at every distance.

    ``sides``: "given" puts ``lods`` on the left, "swapped" on the right, "both" shows each pairing
    both ways round, "alternating" changes sides from one pairing to the next. With ``irises``
    every pairing is shown with each of them, with ``crowds`` amid each of them.
    """

    distances: Annotated[tuple[Distance, ...], Field(min_length=1)]
    lods: Annotated[tuple[str, ...], Field(min_length=1)]
    against: Annotated[tuple[str, ...], Field(min_length=1)]
    sides: Literal["given", "swapped", "both", "alternating"] = "both"
    motion: Motion = "orbit"
    irises: tuple[str, ...] = ()
    crowds: tuple[People, ...] = ()

    @field_validator("crowds")
    @classmethod
    def _check_crowds(cls, crowds: tuple[int, ...]) -> tuple[int, ...]:
        if len(set(crowds)) < len(crowds):
            raise refuse("a crowd is listed twice")
        return crowds

    def clips(self) -> Iterator[Clip]:
        """Generate the clips, named ``near-low-ultra``: distance, left, right.

        An approach's names begin with ``approach-``; those of several crowds or irises end with
        theirs.
        """
        pairs = [
            (distance, lod, other)
            for distance in self.distances
            for other in self.against
            for lod in self.lods
            if lod != other
        ]
        for index, (distance, lod, other) in enumerate(pairs):
            is_odd = index % 2 == 1
            if self.sides in ("given", "both") or (self.sides == "alternating" and not is_odd):
                yield from self._pair(distance, lod, other)
            if self.sides in ("swapped", "both") or (self.sides == "alternating" and is_odd):
                yield from self._pair(distance, other, lod)

    def _pair(self, distance: str, left: str, right: str) -> Iterator[Clip]:
        start = "approach-" if self.motion == "approach" else ""
        for crowd, iris in product(self.crowds or (None,), self.irises or (None,)):
            yield Clip(
                id=_named(f"{start}{distance}-{left}-{right}", crowd, iris),
                distance=distance,
                left=left,
                right=right,
                motion=self.motion,
                iris=iris,
                crowd=crowd,
            )


def all_clips(
    clips: Iterable[Clip], factors: Iterable[Factors], catch: Iterable[CatchClip]
) -> tuple[Clip, ...]:
    """Return the trials' clips in the file's order: written out, generated, catch."""
    generated = [clip for block in factors for clip in block.clips()]
    return (*clips, *generated, *(entry.clip() for entry in catch))
