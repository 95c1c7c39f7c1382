"""What may be left out, in one sentence per effect, with its uncertainty and what it saves."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from analysis.costs.cost import Costs
from analysis.decision.effects import EffectVerdict, saving_of
from analysis.decision.sentences import price
from analysis.decision.verdicts import DIFFERENT, EQUIVALENT
from analysis.words.wording import listed, number, percent


def effect_answers(
    verdicts: Sequence[EffectVerdict], costs: Costs | None = None
) -> tuple[tuple[str, str], ...]:
    """Return for each LoD without a rank its name and a sentence over all its distances."""
    lods = dict.fromkeys(own.lod for own in verdicts)
    by_lod = {lod: [own for own in verdicts if own.lod == lod] for lod in lods}
    return tuple((own[0].name, _answer(own, costs)) for own in by_lod.values())


def _answer(verdicts: Sequence[EffectVerdict], costs: Costs | None) -> str:
    best = verdicts[0].best
    enough = [own for own in verdicts if own.outcome == EQUIVALENT]
    different = [own for own in verdicts if own.outcome == DIFFERENT]
    unknown = [own for own in verdicts if own not in enough and own not in different]
    parts = []
    if enough:
        parts.append(f"enough instead of {best} at {_places(enough, _bounds)}")
    if different:
        parts.append(f"not enough at {_places(different, _failure)}")
    if unknown:
        parts.append(f"not shown at {_places(unknown, _doubt)}")
    saved = dict.fromkeys(map(str, (_saved(own, costs) for own in enough or verdicts)))
    parts += [text for text in saved if text]
    return "; ".join(parts) + "."


def _places(verdicts: Sequence[EffectVerdict], why: Callable[[EffectVerdict], str]) -> str:
    return listed([f"{own.distance} ({why(own)})" for own in verdicts])


def _bounds(own: EffectVerdict) -> str:
    text = f"rated at most {number(max(own.realism.high, 0.0))} points lower"
    if own.noticed is None:
        return text
    return f"{text}, noticed by at most {percent(max(own.noticed.high, 0.0))} beyond false alarms"


def _failure(own: EffectVerdict) -> str:
    text = f"rated {number(own.realism.value)} points lower"
    if own.noticed is None:
        return text
    return f"{text}, noticed by {percent(own.noticed.value)} beyond false alarms"


def _doubt(own: EffectVerdict) -> str:
    text = f"up to {number(own.realism.high)} points lower"
    if own.noticed is None:
        return f"{text}, noticing not measured"
    return f"{text}, up to {percent(own.noticed.high)} may notice"


def _saved(own: EffectVerdict, costs: Costs | None) -> str:
    saving = saving_of(own, costs)
    return f"{price(saving)}, measured at {saving.condition}" if saving else ""
