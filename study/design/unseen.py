"""Which differences between the eyes of a clip are smaller than a pixel, told by their cause.

A cause is an effect and the iris diameter from which on its difference shows. Clips that share one
are told together, by their LoDs and distances, however many irises, sides and sizes they have.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from renderer.camera import iris_px, iris_px_of_frame
from renderer.detail import EFFECTS
from study.design.definition import StudyDefinition
from study.design.pairings import Clip
from study.design.parts import Size
from study.design.visibility import Switch, hidden_effects


@dataclass(frozen=True)
class Cause:
    """Why a difference is too small; ``is_all``: nothing else differs where it is."""

    effect: str
    switch: Switch
    is_all: bool

    @property
    def order(self) -> tuple[bool, int, float]:
        """What shows no difference at all comes first, then effect by effect."""
        return (not self.is_all, EFFECTS.index(self.effect), self.switch.iris_px)


@dataclass(frozen=True)
class Place:
    """Where a difference is too small: a clip in one size of picture, its iris in whole pixels."""

    clip: Clip
    size: Size
    iris_px: int

    @property
    def lods(self) -> frozenset[str]:
        """The two LoDs, whichever side they stand on."""
        return frozenset((self.clip.left, self.clip.right))


def unseen_differences(definition: StudyDefinition) -> Iterator[str]:
    """Yield one sentence per cause of differences that no pixel shows, with all of its places."""
    causes: dict[Cause, list[Place]] = {}
    for clip in _unlike(definition):
        for cause, place in _unseen(definition, clip):
            causes.setdefault(cause, []).append(place)
    for cause in sorted(causes, key=lambda each: each.order):
        end = "; nothing else differs there" if cause.is_all else ""
        yield (
            f"{cause.effect}: differences are smaller than a pixel below an iris of "
            f"{cause.switch.iris_px:g} px, as {cause.switch.because}: "
            f"{'; '.join(_told(causes[cause], definition))}{end}"
        )


def _unlike(definition: StudyDefinition) -> list[Clip]:
    """Return the trials' clips, of those that differ in iris or side alone the first."""
    firsts: dict[tuple[object, ...], Clip] = {}
    for clip in definition.trial_clips:
        key = (clip.distance, frozenset((clip.left, clip.right)), clip.motion)
        firsts.setdefault(key, clip)
    return list(firsts.values())


def _unseen(definition: StudyDefinition, clip: Clip) -> Iterator[tuple[Cause, Place]]:
    one, other = definition.detail(clip.left), definition.detail(clip.right)
    differing = {effect for effect in EFFECTS if getattr(one, effect) != getattr(other, effect)}
    for size in definition.sizes:
        place = Place(clip, size, round(largest_iris_px(definition, clip, size)))
        hidden = hidden_effects(one, other, place.iris_px)
        for effect, switch in hidden.items():
            yield Cause(effect, switch, is_all=differing == set(hidden)), place


def _told(places: Sequence[Place], definition: StudyDefinition) -> Iterator[str]:
    """Yield the distances with the iris's pixels, each time for the pairs of LoDs they hold for."""
    pairs: dict[frozenset[str], dict[str, list[Place]]] = {}
    for place in places:
        own = pairs.setdefault(place.lods, {})
        own.setdefault(place.clip.id, []).append(place)
    alike: dict[str, list[str]] = {}
    for lods, clips in pairs.items():
        where = (
            f"{each[0].clip.distance} ({_pixels(each, definition.sizes)})"
            for each in clips.values()
        )
        name = " | ".join(lod for lod in definition.lods if lod in lods)
        alike.setdefault(", ".join(where), []).append(name)
    for distances, names in alike.items():
        yield f"{', '.join(names)} at {distances}"


def _pixels(places: Sequence[Place], sizes: Sequence[Size]) -> str:
    """Name the sizes of picture only where the difference is too small in some of them."""
    if len(places) == len(sizes):
        return f"{' and '.join(str(place.iris_px) for place in places)} px"
    return " and ".join(f"{place.iris_px} px at {place.size}" for place in places)


def largest_iris_px(definition: StudyDefinition, clip: Clip, size: Size) -> float:
    """Return the iris's largest diameter in a clip, in pixels."""
    spec = definition.clip_spec(clip, size=size, orbit_direction=definition.orbit.directions[0])
    if spec.motion == "orbit":
        return max(iris_px(spec, 0.0))  # facing the camera
    ends = (iris_px_of_frame(spec, frame) for frame in (0, spec.frame_count - 1))
    return max(map(max, ends))
