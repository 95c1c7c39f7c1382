"""What a study can show before anybody takes part, and what in it will not be seen.

The facts about pairings come from ``analysis.audit``, which says the same in the report.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from analysis.audit import Audit, ShownClip, audit_design
from renderer.camera import iris_px, iris_px_of_frame
from renderer.detail import EFFECTS
from study.design.definition import StudyDefinition
from study.design.pairings import Clip
from study.design.parts import Size
from study.design.visibility import hidden_effects

TRIAL_S: Final = 45.0  # watch a five-second clip once or twice, answer six questions
BEFORE_S: Final = 180.0  # consent, questions about you, instructions
LONG_MIN: Final = 30.0  # BT.500 ends a sitting here


def audit(definition: StudyDefinition) -> Audit:
    """Return the design's facts over all LoDs and distances that the file names."""
    shown = audit_design(
        ShownClip(clip.id, clip.distance, clip.left, clip.right) for clip in definition.trial_clips
    )
    return replace(shown, distances=definition.distances, lods=tuple(definition.lods))


def cell_table(definition: StudyDefinition) -> list[str]:
    """Return lines that count, per distance and LoD, the eyes that the trials show."""
    lods, rows = list(definition.lods), definition.distances
    eyes = [
        (clip.distance, lod) for clip in definition.trial_clips for lod in (clip.left, clip.right)
    ]
    width = max(len(name) for name in (*lods, "distance")) + 2
    lines = [f"{'distance':14}" + "".join(f"{lod:>{width}}" for lod in lods)]
    for distance in rows:
        counts = (eyes.count((distance, lod)) for lod in lods)
        cells = "".join(f"{count or '-':>{width}}" for count in counts)
        lines.append(f"{distance:14}{cells}")
    return lines


def statements(definition: StudyDefinition) -> list[str]:
    """Say in sentences what the design shows and what it cannot answer."""
    trials, practice = len(definition.trial_clips), len(definition.practice)
    return [
        f"One visit has {trials + practice} clips ({practice} for practice) and takes about "
        f"{round(minutes(definition))} minutes.",
        *audit(definition).statements(),
    ]


def minutes(definition: StudyDefinition) -> float:
    """Estimate how long one visit takes."""
    return (BEFORE_S + TRIAL_S * len(definition.every_clip)) / 60


def warnings(definition: StudyDefinition) -> list[str]:
    """Return what may be meant, but is worth a second look, most general first."""
    return [*_general(definition), *_hidden(definition)]


def _general(definition: StudyDefinition) -> Iterator[str]:
    if not (definition.contact.email or definition.contact.details):
        yield (
            "contact: neither email nor details; name someone who can be reached in a copy of "
            "this file before people take part"
        )
    if not definition.practice:
        yield "practice: no clip; people learn the task on the first trials"
    if len(definition.orbit.directions) == 1:
        yield (
            "orbit.directions: only one; the eye that is seen last is always the same, and its "
            "advantage cannot be told from its LoD's"
        )
    if minutes(definition) > LONG_MIN:
        yield f"clips: a visit of about {round(minutes(definition))} minutes tires people"
    asked = {question.id for question in definition.questions}
    for name in ("rating_left", "rating_right", "comparison", "noticed"):
        if name not in asked:
            yield f"questions: none is called {name}; the analysis goes without it"
    for distance in definition.distances:
        motions = {c.motion for c in definition.trial_clips if c.distance == distance}
        if len(motions) > 1:
            yield (
                f"clips: at {distance} some turn around the eyes and some approach them; the "
                "tables do not tell them apart"
            )
    used = {lod for clip in definition.every_clip for lod in (clip.left, clip.right)}
    bases = {row.base for row in definition.lods.values()}
    for lod in definition.lods:
        if lod not in used | bases:
            yield f"lods.{lod}: no clip shows it"


def _hidden(definition: StudyDefinition) -> Iterator[str]:
    """Warn of effects whose difference is smaller than a pixel, clip by clip."""
    for clip in definition.trial_clips:
        one, other = definition.detail(clip.left), definition.detail(clip.right)
        differing = [e for e in EFFECTS if getattr(one, e) != getattr(other, e)]
        for size in definition.sizes:
            diameter = largest_iris_px(definition, clip, size)
            hidden = hidden_effects(one, other, diameter)
            if not hidden:
                continue
            listed = ", ".join(f"{e} (from {s.iris_px:g} px)" for e, s in hidden.items())
            line = (
                f"clip {clip.id} ({clip.distance}, {clip.left} | {clip.right}) at {size}: the iris "
                f"is {diameter:.0f} px wide; differences smaller than a pixel: {listed}"
            )
            yield line + ("; nothing else differs" if set(differing) == set(hidden) else "")


def largest_iris_px(definition: StudyDefinition, clip: Clip, size: Size) -> float:
    """Return the iris's largest diameter in a clip, in pixels."""
    spec = definition.clip_spec(clip, size=size, orbit_direction=definition.orbit.directions[0])
    if spec.motion == "orbit":
        return max(iris_px(spec, 0.0))  # facing the camera
    ends = (iris_px_of_frame(spec, frame) for frame in (0, spec.frame_count - 1))
    return max(map(max, ends))
