"""The rows of the tables: what one participant's trials and answers say, column by column.

Pure: from what ``study.data.collection`` has read to plain values. Missing is None, never zero.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from datetime import datetime
from typing import Any, Final

from renderer.detail import lod_rank
from study.data import angles, devices, own_answers
from study.data.arms import arm_of
from study.data.collection import Collected, CollectedTrial
from study.data.devices import plausible
from study.data.progress import early_step
from study.data.schema import ParticipantRow
from study.data.studies import Study
from study.data.trials import ANSWERED, complete_plays
from study.data.validity import tally_of
from study.design.certificate import judge_trial
from study.design.definition import StudyDefinition
from study.design.gold import Gold
from study.design.order_codes import OrderCode
from study.design.pairings import Clip
from study.design.parts import read_size
from study.design.pixels import median_iris_px

Row = dict[str, Any]
COMPLETED: Final = "completed"


def _who(study: Study, person: Collected) -> Row:
    return {
        "study": study.key,
        "study_version": study.version,
        "simulated": person.row.simulated,
        "participant": person.row.public_id,
    }


def trial_row(study: Study, person: Collected, collected: CollectedTrial) -> Row:
    """Return what the two tables about trials share."""
    trial, row = collected.trial, person.row
    plays = complete_plays(trial.completed_at, collected.events)
    clip = study.definition.clip(trial.clip)
    left_px, right_px = _iris_px(study.definition, person, collected)
    width_px, calibration = read_size(row.size or "").width, person.checks.get("calibration")
    verdict = judge_trial(plays, study.definition.certificate)
    return {
        **_who(study, person),
        "session": f"{row.public_id}-{collected.sitting}" if collected.sitting else None,
        "trial": f"{row.public_id}-{trial.position:02d}",
        "position": trial.number,
        "clip": trial.clip,
        "distance": clip.distance,
        **angles.shown(plays, width_px=width_px),
        "orbit_direction": row.orbit_direction,
        **_iris(study.definition, clip),
        "crowd": study.definition.scene_of(clip).crowd,
        "is_practice": trial.is_practice,
        "is_catch": clip.is_catch,
        "is_warm_up": study.definition.order.is_warm_up(
            trial.number, is_practice=trial.is_practice
        ),
        "is_gold": isinstance(clip, Gold),
        "certified": verdict.certified,
        "uncertified_because": " ".join(verdict.reasons) or None,
        "dropped_frames": _total(plays, "dropped_frames"),
        "views": trial.views,
        **_response(collected),
        "started_at": _iso(trial.started_at),
        "_iris_px": (left_px, right_px),
        "_iris_deg": [
            angles.iris_angle(plays, calibration, iris_px=iris_px, width_px=width_px)
            for iris_px in (left_px, right_px, (left_px + right_px) / 2)
        ],
    }


def rating_rows(
    definition: StudyDefinition, shared: Row, collected: CollectedTrial
) -> Iterator[Row]:
    clip = definition.clip(collected.trial.clip)
    lods = {"left": clip.left, "right": clip.right}
    for eye, other, index in (("left", "right", 0), ("right", "left", 1)):
        yield {
            **shared,
            "iris_px": shared["_iris_px"][index],
            **shared["_iris_deg"][index],
            "eye": eye,
            "lod": lods[eye],
            "lod_rank": lod_rank(lods[eye]),
            "other_lod": lods[other],
            **definition.levels(lods[eye]),
            "rating": collected.trial.answers.get(f"rating_{eye}"),
            **own_answers.eye_cells(definition.questions, collected.trial.answers, eye),
        }


def comparison_row(definition: StudyDefinition, shared: Row, collected: CollectedTrial) -> Row:
    clip = definition.clip(collected.trial.clip)
    return {
        **shared,
        "iris_px": round(sum(shared["_iris_px"]) / 2, 2),
        **shared["_iris_deg"][2],
        "left_lod": clip.left,
        "right_lod": clip.right,
        **own_answers.cells(definition.questions_of_all_trials, collected.trial.answers),
    }


def participant_row(study: Study, person: Collected) -> Row:
    row = person.row
    step = early_step(row, study.definition, person.done)
    done = sum(c.trial.is_complete and not c.trial.is_practice for c in person.trials)
    return {
        **_who(study, person),
        "started_at": _iso(row.consented_at),
        "completed_at": _iso(row.completed_at),
        "status": COMPLETED if row.completed_at else step or f"{done} trials",
        "outcome": row.outcome,
        "language": row.language,
        **own_answers.cells(study.definition.about, person.about),
        **_arrival(study, row.arrival or {}),
        **{name: person.device.get(name) for name in devices.COLUMNS},
        **{name: fact for check in person.checks.values() for name, fact in check["facts"].items()},
        **_places(row),
        **_validity(study.definition, person),
    }


def _iris(definition: StudyDefinition, clip: Clip) -> Row:
    eye = definition.eye_of(clip)
    colour = "photograph" if eye.iris_file else eye.iris_colour
    return {"iris": clip.iris, "iris_seed": eye.iris_seed, "iris_colour": colour}


def _places(row: ParticipantRow) -> Row:
    """Return a participant's places in the design, from which their trials follow."""
    arm = arm_of(row)
    code = OrderCode(row.block, row.order_row, row.seed)
    return {
        "arm": None if arm is None else str(arm),
        "block": row.block,
        "order_row": row.order_row,
        "order_code": None if arm is None else str(code),
    }


def _validity(definition: StudyDefinition, person: Collected) -> Row:
    """Return how gold trials and attention questions went; nothing where a study has none."""
    found = asdict(tally_of(definition, (c.trial for c in person.trials), person.attention))
    kinds = {"gold": definition.gold, "attention": definition.attention}
    return {name: n for name, n in found.items() if kinds[name.partition("_")[0]]}


def _arrival(study: Study, arrival: Mapping[str, str]) -> Row:
    """Return what brought a participant, as far as the study file lets it be exported."""
    parameters = study.definition.entrance.parameters
    return {one.name: arrival.get(one.name) for one in parameters if one.is_exported}


def _iris_px(
    definition: StudyDefinition, person: Collected, collected: CollectedTrial
) -> tuple[float, float]:
    clip = definition.clip(collected.trial.clip)
    spec = definition.clip_spec(
        clip,
        size=read_size(person.row.size or ""),
        orbit_direction=person.row.orbit_direction or "",
    )
    return median_iris_px(spec)


def _response(collected: CollectedTrial) -> Row:
    """Return when the answer came, and how finely the browser's clock told it."""
    finals = [e.payload for e in collected.events if e.kind == ANSWERED and e.payload["is_final"]]
    last = finals[-1] if finals else {}
    found = plausible(last.get("response_ms"))
    return {
        "response_ms": None if found is None else round(found),
        "clock_ms": None if found is None else plausible(last.get("clock_ms")),
    }


def _total(plays: Sequence[Mapping[str, Any]], name: str) -> int | None:
    values = [value for play in plays if (value := plausible(play.get(name))) is not None]
    return round(sum(values)) if values else None


def _iso(moment: datetime | None) -> str | None:
    return None if moment is None else moment.isoformat(timespec="milliseconds")
