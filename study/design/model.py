"""What a study file says, as one model, and what follows from it: clips, blocks, files, words.

Pure. Its values are checked one by one; ``study.design.definition`` reads files and checks what
lies between the values. Code names no clip.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

from pydantic import Field

from renderer.clip import DIRECTIONS, PATHS, ClipSpec
from renderer.detail import EFFECTS, Detail
from renderer.lod.choice import LodPolicy
from study.design.approach import Approach, PolicyData, policy_of
from study.design.calibration import Calibration
from study.design.certificate import Certificate
from study.design.completion import Completion
from study.design.decision import DecisionRule
from study.design.device_check import DeviceCheck
from study.design.eyesight import Eyesight
from study.design.files import without_later_keys, without_paths
from study.design.gold import Gold
from study.design.irises import Iris
from study.design.order import Order
from study.design.pairings import CatchClip, Clip, Factors, LodRow, all_clips, detail_of
from study.design.parts import (
    Distance,
    Eye,
    Name,
    Orbit,
    Part,
    Scene,
    Size,
    SizeText,
    Text,
    clip_value,
)
from study.design.pauses import Attention, Breaks, Pause, all_pauses
from study.design.per_person import Block, PerPerson, blocks_of
from study.design.questions import Question
from study.design.recruiting import Recruiting
from study.design.texts import Consent, Contact, Page, Thanks
from study.design.translations import translated


@dataclass(frozen=True)
class WantedClip:
    """One clip to render for a study: which clip, how, and what it depends on."""

    clip: Clip
    size: Size
    orbit_direction: str
    spec: ClipSpec


class StudyDefinition(Part):
    """Everything that makes one study: what is shown, to whom, in which order, with which words."""

    key: Name
    version: Name
    title: Text
    language: Name = "en"
    translations: Annotated[dict[Name, dict[str, Any]], Field(default_factory=dict)]
    contact: Contact
    preset: Annotated[str, clip_value("preset")] = "thesis"
    sizes: Annotated[tuple[SizeText, ...], Field(min_length=1)]
    distances: Annotated[tuple[Distance, ...], Field(min_length=1)]
    orbit: Orbit = Orbit()
    approach: Approach = Approach()
    lod_policy: PolicyData | None = None
    eye: Eye = Eye()
    irises: dict[Name, Iris] = Field(default_factory=dict)
    scene: Scene = Scene()
    lods: Annotated[dict[Name, LodRow], Field(min_length=1)]
    practice: tuple[Clip, ...] = ()
    clips: tuple[Clip, ...] = ()
    factors: tuple[Factors, ...] = ()
    catch: tuple[CatchClip, ...] = ()
    gold: tuple[Gold, ...] = ()
    per_person: PerPerson | None = None
    order: Order = Order()
    breaks: Breaks | None = None
    attention: tuple[Attention, ...] = ()
    certificate: Certificate = Certificate()
    decision: DecisionRule | None = None
    consent: Consent
    about: tuple[Question, ...] = ()
    about_page: Page
    device_check: DeviceCheck | None = None
    calibration: Calibration | None = None
    eyesight: Eyesight | None = None
    instructions: Page
    questions: Annotated[tuple[Question, ...], Field(min_length=1)]
    thanks: Thanks
    completion: Completion | None = None
    recruiting: Recruiting | None = None

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

    @property
    def pauses(self) -> tuple[Pause, ...]:
        """What comes between trials, in order."""
        return all_pauses(self.breaks, self.attention)

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
            **self.scene.model_dump(),
        )

    def clip_specs(self, size: Size, orbit_direction: str) -> dict[str, ClipSpec]:
        """Return clip id -> spec of every clip, practice included, for one size and direction."""
        return {
            wanted.clip.id: wanted.spec
            for wanted in self._wanted
            if (wanted.size, wanted.orbit_direction) == (size, orbit_direction)
        }

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

    @property
    def endings(self) -> Completion:
        """What each outcome of a session leads to."""
        return self.completion or Completion()

    @property
    def entrance(self) -> Recruiting:
        """How people are let in."""
        return self.recruiting or Recruiting()

    @property
    def languages(self) -> tuple[str, ...]:
        """The languages that the study's words are written in, its own first."""
        return (self.language, *self.translations)

    def in_language(self, language: str) -> StudyDefinition:
        """Return the study with its words in one of its languages; as it is for any other."""
        return self._translated.get(language, self)

    @cached_property
    def _translated(self) -> dict[str, StudyDefinition]:
        return {
            language: translated(self, words, language)
            for language, words in self.translations.items()
        }

    def to_json(self) -> str:
        """Write the definition as JSON in the file's order; ``parse_definition`` reads it back."""
        return json.dumps(self.model_dump(mode="json"), ensure_ascii=False)

    @property
    def definition_hash(self) -> str:
        """16 hexadecimal digits over the contents.

        Comments, the order of keys and the places of pictures do not matter, nor do keys that came
        later as long as they are left out.
        """
        told = without_later_keys(self.model_dump(mode="json"))
        text = json.dumps(without_paths(told, PATHS), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]
