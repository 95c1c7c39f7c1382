"""A whole study in one file: read it, check it, ask it for its clips. Code names no clip.

Pure apart from reading the file. Every fault of a file is reported at once, with its place.
"""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import resources
from itertools import product
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidationError

from renderer.clip import DIRECTIONS, PATHS, ClipSpec
from renderer.detail import EFFECTS, Detail
from renderer.lod.choice import LodPolicy
from study.design.approach import Approach, PolicyData, policy_of
from study.design.calibration import Calibration
from study.design.certificate import Certificate
from study.design.checks import cross_faults
from study.design.completion import Completion
from study.design.device_check import DeviceCheck
from study.design.eyesight import Eyesight
from study.design.faults import DefinitionError, Fault, faults_of, suggestion
from study.design.files import find_files, without_later_keys, without_paths
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
from study.design.pauses import Attention, Breaks, Pause, all_pauses, late_faults
from study.design.per_person import Block, PerPerson, blocks_of, per_person_faults
from study.design.questions import Question
from study.design.recruiting import Recruiting
from study.design.texts import Consent, Contact, Page, Thanks
from study.design.translations import find_translations, translated, translation_faults


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


def built_in_names() -> list[str]:
    """Return the names of the studies that come with Ocularist."""
    folder = resources.files("study.design") / "definitions"
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in folder.iterdir()
        if entry.name.endswith(".toml") and entry.name.count(".") == 1  # lod.ar.toml is no study
    )


def read_definition(name_or_path: str | Path) -> StudyDefinition:
    """Read a built-in study by name or any study by the path of its file.

    Raises DefinitionError with every fault of the file.
    """
    text, source = _read_text(str(name_or_path))
    folder = Path() if str(name_or_path) in built_in_names() else Path(name_or_path).parent
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise DefinitionError(source, [Fault("", f"not a TOML file: {error}")]) from None
    found, absent = find_files(data, folder)
    found, untranslated = find_translations(found, _beside(str(name_or_path)))
    return parse_definition(found, source=source, faults=[*absent, *untranslated])


def _beside(name_or_path: str) -> Path:
    """Return the path of a study's own file, beside which its translations lie."""
    if name_or_path in built_in_names():
        return Path(str(resources.files("study.design") / "definitions" / f"{name_or_path}.toml"))
    return Path(name_or_path)


def parse_definition(
    data: Mapping[str, Any], *, source: str = "definition", faults: Sequence[Fault] = ()
) -> StudyDefinition:
    """Check the contents of a study file; raises DefinitionError with every fault at once.

    ``faults`` are those that reading its files has shown already.
    """
    faults = [*faults, *cross_faults(data)]
    try:
        definition = StudyDefinition.model_validate(dict(data))
    except ValidationError as error:
        faults = faults_of(error, StudyDefinition) + faults
    faults = faults or [
        *_clip_faults(definition),
        *_design_faults(definition),
        *_translation_faults(definition),
    ]
    if faults:
        raise DefinitionError(source, list(dict.fromkeys(faults)))
    return definition


def _translation_faults(definition: StudyDefinition) -> Iterator[Fault]:
    """Yield what the translations lack; a study must be whole in each of its languages."""
    for language, words in definition.translations.items():
        if language == definition.language:
            yield Fault(f"translations.{language}", "this is the study's own language")
        else:
            yield from translation_faults(definition, words, f"translations.{language}")


def _clip_faults(definition: StudyDefinition) -> Iterator[Fault]:
    """Yield what a clip refuses about an approach: its end may lie too near for a size's shape."""
    for size, clip in product(definition.sizes, definition.every_clip):
        if clip.motion == "approach":
            try:
                definition.clip_spec(clip, size=size, orbit_direction=DIRECTIONS[0])
            except ValueError as error:
                yield Fault("approach", f"{size}: {error}")


def _design_faults(definition: StudyDefinition) -> Iterator[Fault]:
    """Yield what only the whole design shows: blocks out of balance, pauses after the end."""
    faults = list(per_person_faults(definition.trial_clips, definition.per_person))
    yield from faults
    if not faults:
        count = definition.trial_count
        yield from late_faults(count, definition.breaks, definition.attention)
        for index, gold in enumerate(definition.gold):
            if gold.after >= count:
                place = f"gold.{index}.after"
                yield Fault(place, f"{gold.after} is no place among {count} trials")
        if definition.order.warm_up >= count:
            found = f"{definition.order.warm_up} of {count} trials"
            yield Fault("order.warm_up", f"{found}; no trial would be left")


def _read_text(name_or_path: str) -> tuple[str, str]:
    """Return the text and the name that messages give it."""
    names = built_in_names()
    if name_or_path in names:
        resource = resources.files("study.design") / "definitions" / f"{name_or_path}.toml"
        return resource.read_text(encoding="utf-8"), resource.name
    path = Path(name_or_path)
    try:
        return path.read_text(encoding="utf-8"), path.name
    except UnicodeDecodeError as error:
        raise DefinitionError(path.name, [Fault("", f"not UTF-8 text: {error}")]) from None
    except OSError as error:
        reason = (
            f"cannot be read ({error.strerror}); give the path of a TOML file or a built-in study: "
            f"{', '.join(names)}{suggestion(name_or_path, names)}"
        )
        raise DefinitionError(name_or_path, [Fault("", reason)]) from None
