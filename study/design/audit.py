"""What a study can show before anybody takes part, and what in it will not be seen.

The facts about pairings come from ``analysis.audit``, which says the same in the report.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import ceil
from typing import Final

from analysis import Margins
from analysis.audit import Audit, ShownClip, audit_design
from study.design.definition import StudyDefinition
from study.design.duration import minutes, visit_parts
from study.design.pairings import Clip
from study.design.questions import each_asked
from study.design.schedule import order_rows
from study.design.unseen import unseen_differences

LONG_MIN: Final = 30.0  # BT.500 ends a sitting here
ANALYSED: Final = ("rating_left", "rating_right", "comparison", "noticed")
"""Questions that the analysis understands."""


def audit(definition: StudyDefinition) -> Audit:
    """Return the design's facts over the file's distances and LoDs, irises taken together.

    A LoD that only practice and gold clips show is no part of the design.
    """
    shown = audit_design(
        ShownClip(clip.pairing, clip.distance, clip.left, clip.right)
        for clip in _pairings(definition)
    )
    return replace(shown, distances=definition.distances, lods=_studied(definition))


def _pairings(definition: StudyDefinition) -> list[Clip]:
    """Return the trials' clips, of those that differ in the iris alone the first."""
    firsts: dict[tuple[object, ...], Clip] = {}
    for clip in definition.trial_clips:
        firsts.setdefault(clip.condition if clip.iris else (clip.id,), clip)
    return list(firsts.values())


def _studied(definition: StudyDefinition) -> tuple[str, ...]:
    around = {
        lod for clip in (*definition.practice, *definition.gold) for lod in (clip.left, clip.right)
    }
    shown = {lod for clip in definition.trial_clips for lod in (clip.left, clip.right)}
    return tuple(lod for lod in definition.lods if lod in shown or lod not in around)


def cell_table(definition: StudyDefinition) -> list[str]:
    """Return lines that count, per distance and LoD, the eyes that the trials show."""
    lods, rows = _studied(definition), definition.distances
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
    told = (_visit(definition), *_plan(definition), *_rule(definition))
    return [*told, *audit(definition).statements()]


def _visit(definition: StudyDefinition) -> str:
    """Say how many clips one visit has, and how long it takes."""
    practice, gold = len(definition.practice), len(definition.gold)
    kinds = [f"{practice} for practice", *([f"{gold} gold"] if gold else [])]
    parts = [f"{name} {ceil(seconds)} s" for name, seconds in visit_parts(definition).items()]
    return (
        f"One visit has {practice + definition.trial_count} clips ({', '.join(kinds)}) and takes "
        f"about {minutes(definition):.1f} minutes ({', '.join(parts)})."
    )


def _plan(definition: StudyDefinition) -> Iterator[str]:
    """Say how clips and orders are shared out over people."""
    blocks, directions = len(definition.blocks), len(definition.orbit.directions)
    if definition.per_person is not None:
        yield (
            f"One person sees {len(definition.blocks[0])} of {len(definition.trial_clips)} clips. "
            f"{blocks} blocks x {directions} direction{'s' * (directions > 1)} are "
            f"{blocks * directions} arms: after so many people every clip was shown equally often "
            "in each direction."
        )
    if rows := len(order_rows(definition)):
        things = "kinds of trial" if definition.per_person else "clips"
        yield (
            f"Orders are {rows} rows of a Williams design: after {rows} people the {things} stood "
            "at every place, and each came right after each other, equally often."
        )


def _rule(definition: StudyDefinition) -> Iterator[str]:
    """Say by which margins LoDs will be called enough, where the file declares them."""
    rule = definition.decision
    if rule is None:
        return
    tested = f"; tested in this order: {', '.join(rule.sequence)}" if rule.sequence else ""
    yield (
        f"Declared before data: a LoD is enough if it is rated less than {rule.realism_margin:g} "
        f"points lower than the best one and noticed beside it by less than "
        f"{100 * rule.noticed_margin:g} % of people beyond false alarms, each with "
        f"{100 * rule.confidence:g} % confidence{tested}."
    )


def warnings(definition: StudyDefinition) -> list[str]:
    """Return what may be meant, but is worth a second look, most general first."""
    return [*_general(definition), *unseen_differences(definition)]


def _general(definition: StudyDefinition) -> Iterator[str]:
    if not (definition.contact.email or definition.contact.details):
        yield (
            "contact: neither email nor details; name someone who can be reached in a copy of "
            "this file before people take part"
        )
    if definition.decision is None:
        own = Margins()
        yield (
            f"decision: no margins; the analysis takes {own.realism_points:g} points and "
            f"{100 * own.noticed_share:g} % of people, and the report says that they were set at "
            "analysis"
        )
    if definition.decision is not None and not definition.catch:
        yield (
            "catch: no equal pairs, so false alarms stay unknown, and no LoD can be called enough "
            "by the rule of decision, however many people take part"
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
    asked = {question.id for question in each_asked(definition.questions)}
    lacking = [name for name in ANALYSED if name not in asked]
    if len(lacking) == len(ANALYSED):
        yield (
            f"questions: none is called {', '.join(lacking)}; ocularist analyse knows these alone "
            "and will have nothing to say about the answers, so give these names to questions that "
            "ask the same"
        )
    else:
        yield from (f"questions: none is called {n}; the analysis goes without it" for n in lacking)
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
