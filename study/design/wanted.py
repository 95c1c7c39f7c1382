"""The clips that follow from a study file: which there are, how each is rendered, in which order.

Pure. Code names no clip.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from renderer.clip import ClipSpec
from renderer.clip_values import DIRECTIONS
from renderer.detail import EFFECTS, Detail
from renderer.lod.choice import LodPolicy
from study.design.approach import policy_of
from study.design.contents import Contents
from study.design.pairings import Clip, all_clips, detail_of
from study.design.parts import Eye, Scene, Size
from study.design.per_person import Block, blocks_of


@dataclass(frozen=True)
class WantedClip:
    """One clip to render for a study: which clip, how, and what it depends on."""

    clip: Clip
    size: Size
    orbit_direction: str
    spec: ClipSpec


class WithClips(Contents):
    """What a study file says, and the clips that follow from it."""

    @cached_property
    def trial_clips(self) -> tuple[Clip, ...]:
        """The clips of the trials in the file's order, catch clips last; no practice, no gold."""
        return all_clips(self.clips, self.factors, self.catch)

    @property
    def every_clip(self) -> tuple[Clip, ...]:
        """Practice clips, then those of the trials, then gold."""
        return (*self.practice, *self.trial_clips, *self.gold)

    @cached_property
    def blocks(self) -> tuple[Block, ...]:
        """What one person sees of the trials' clips: one of these."""
        return blocks_of(self.trial_clips, self.per_person)

    @property
    def trial_count(self) -> int:
        """How many trials one person has, gold included and practice not."""
        return len(self.blocks[0]) + len(self.gold)

    def clip(self, clip_id: str) -> Clip:
        """Return the clip that the file calls ``clip_id``; raises KeyError."""
        return self._clips[clip_id]

    @cached_property
    def _clips(self) -> dict[str, Clip]:
        return {clip.id: clip for clip in self.every_clip}

    def eye_of(self, clip: Clip) -> Eye:
        """Return what both eyes of a clip share; raises KeyError for an iris not in the file."""
        if clip.iris is None:
            return self.eye
        return self.eye.model_copy(update=self.irises[clip.iris].fields())

    def scene_of(self, clip: Clip) -> Scene:
        """Return what is around the eyes of a clip."""
        if clip.crowd is None:
            return self.scene
        return self.scene.model_copy(update={"crowd": clip.crowd})

    def detail(self, lod: str) -> Detail:
        """Return a LoD's seven levels; raises KeyError for a name that the file does not define.

        Those of a LoD that switches are its policy's finest.
        """
        if self.lods[lod].switching is not None:
            return self._policy.finest
        return detail_of(self.lods, lod)

    def levels(self, lod: str) -> dict[str, str | None]:
        """Return effect -> level of a LoD, None for each where it switches."""
        if self.lods[lod].switching is not None:
            return dict.fromkeys(EFFECTS)
        return dict(self.detail(lod).levels())

    @cached_property
    def _policy(self) -> LodPolicy:
        return policy_of(self.lod_policy)

    def clip_spec(self, clip: Clip, *, size: Size, orbit_direction: str) -> ClipSpec:
        """Return everything that the frames of one clip depend on.

        An approach straight ahead is the same in both directions, and rendered once.
        """
        motion: dict[str, Any] = {"duration_s": self.orbit.duration_s}
        if clip.motion == "approach":
            motion = self.approach.fields(clip.distance)
            if self.approach.azimuth_deg == 0.0:
                orbit_direction = DIRECTIONS[0]
        switching = [self.lods[lod].switching or "fixed" for lod in (clip.left, clip.right)]
        return ClipSpec(
            left=self.detail(clip.left),
            right=self.detail(clip.right),
            left_switching=switching[0],
            right_switching=switching[1],
            lod_policy=None if switching == ["fixed", "fixed"] else self._policy,
            distance=clip.distance,
            orbit_deg=self.orbit.orbit_deg,
            orbit_direction=orbit_direction,
            fps=self.orbit.fps,
            **motion,
            width=size.width,
            height=size.height,
            preset=self.preset,
            **self.eye_of(clip).model_dump(),
            **self.scene_of(clip).model_dump(),
        )

    def wanted_specs(self) -> list[WantedClip]:
        """Return what to render in the order in which it is needed.

        The whole first size comes first, block by block: a participant can start as soon as the
        clips of one block in one direction are there. Directions take turns, so that the first
        blocks to be ready already balance them.
        """
        return list(self._wanted)

    def file_names(self, size: Size, orbit_direction: str) -> Mapping[str, str]:
        """Return clip id -> name of its rendered file, for one size and direction."""
        return self._file_names[size, orbit_direction]

    @cached_property
    def _file_names(self) -> dict[tuple[Size, str], dict[str, str]]:
        # Naming a file takes a hash over its whole spec, and every waiting browser asks for all.
        names: dict[tuple[Size, str], dict[str, str]] = {}
        for wanted in self._wanted:
            mine = names.setdefault((wanted.size, wanted.orbit_direction), {})
            mine[wanted.clip.id] = wanted.spec.clip_id
        return names

    @cached_property
    def _wanted(self) -> tuple[WantedClip, ...]:
        directions = self.orbit.directions
        in_order = dict.fromkeys(
            (size, directions[(number + lap) % len(directions)], clip.id)
            for size in self.sizes
            for lap in range(len(directions))
            for number, block in enumerate(self.blocks)
            for clip in (*self.practice, *block, *self.gold)
        )
        return tuple(
            WantedClip(
                clip := self.clip(name),
                size,
                direction,
                self.clip_spec(clip, size=size, orbit_direction=direction),
            )
            for size, direction, name in in_order
        )
