"""Sections of the report beside the answer: observers, reliability, texts, the thesis's claims.

Each brings its sentences and tables, and the numbers behind them by file name.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
import pandas as pd

from analysis.inference.deciding import SEED, decisions_of
from analysis.inference.inferring import Inference
from analysis.reliability.reliability import person_taus, reliability
from analysis.report.observer_tables import (
    flag_sentences,
    observers_table,
    reliability_table,
    sensitivity_table,
)
from analysis.report.tables import ReportTable
from analysis.report.text_tables import claims_report, mentions_table, text_sentences
from analysis.screening.flags import flags_of
from analysis.screening.sensitivity import verdict_sensitivity
from analysis.screening.signals import observer_signals
from analysis.screening.weights import observer_weights
from analysis.tables.reading import Tables
from analysis.thesis.claims import claims_table
from analysis.writing.coding import ManualCodes, code_remarks, mention_rates, unused_codes

_MOST_ALONE: Final = 12
_MANY_RATINGS: Final = 20_000  # beyond, people are left out together and not one by one
_MOST_RATINGS: Final = 200_000  # beyond, even one more fit takes too long for a report


@dataclass(frozen=True)
class Section:
    """One section: its title, sentences, tables, and the data behind them by file name."""

    title: str
    sentences: tuple[str, ...] = ()
    tables: tuple[ReportTable, ...] = ()
    data: dict[str, pd.DataFrame] = field(default_factory=dict)


def weights_of(tables: Tables) -> dict[str, float]:
    """Return the weights below 1 that people have in the models, by participant."""
    return observer_weights(observer_signals(tables))


def claims_section(tables: Tables, manual: ManualCodes | None = None) -> Section:
    """Return the thesis's findings beside ours."""
    claims = claims_table(tables, manual)
    return Section(
        "The thesis's claims, on these data", (), (claims_report(claims),), {"claims": claims}
    )


def text_section(tables: Tables, manual: ManualCodes | None = None) -> Section:
    """Return what people wrote, by the code book."""
    remarks = code_remarks(tables.comparisons, manual)
    lost = unused_codes(tables.comparisons, manual) if manual else []
    sentences = (*text_sentences(remarks), *lost)
    if remarks.empty:
        return Section("What people wrote", sentences)
    rates = mention_rates(tables.comparisons, manual)
    data = {"mention-rates": rates, "remark-codes": remarks}
    return Section("What people wrote", sentences, (mentions_table(rates),), data)


def observers_section(tables: Tables, inference: Inference) -> Section:
    """Return what each person's answers show, and which verdicts hang on whom."""
    signals = observer_signals(tables)
    if signals.empty:
        return Section("Observers", ("Nobody answered anything that counts.",))
    flags, weights = flags_of(signals), observer_weights(signals)
    listed = signals.assign(
        flags=["; ".join(flags.get(str(who), ())) for who in signals["participant"]],
        weight=[weights.get(str(who), 1.0) for who in signals["participant"]],
    )
    sentences = flag_sentences(flags, len(signals))
    made, data = [observers_table(signals, flags, weights)], {"observer-signals": listed}
    if flags and inference.decisions:
        found = _sensitivity(tables, inference, flags, weights)
        if found is None:
            sentences.append(
                f"Verdicts without flagged people were not computed: there are more than "
                f"{_MOST_RATINGS} ratings."
            )
        else:
            made.append(sensitivity_table(found))
            data["verdict-sensitivity"] = found
    return Section("Observers", tuple(sentences), tuple(made), data)


def _sensitivity(
    tables: Tables,
    inference: Inference,
    flags: dict[str, tuple[str, ...]],
    weights: dict[str, float],
) -> pd.DataFrame | None:
    realism = inference.realism
    if realism is None or realism.stimuli.counts.total > _MOST_RATINGS:
        return None
    is_quick = realism.stimuli.counts.total <= _MANY_RATINGS
    near = (realism, inference.noticing)
    return verdict_sensitivity(
        tables,
        flags,
        usual=inference.decisions,
        weights=weights,
        decide=lambda own, w: decisions_of(
            own, margins=inference.margins, weights=w or None, near=near
        ),
        most=_MOST_ALONE if is_quick else 0,
    )


def reliability_section(tables: Tables) -> Section:
    """Return how well people agree."""
    found = reliability(tables.ratings, np.random.default_rng(SEED))
    table = reliability_table(found)
    if not table.rows:
        return Section(
            "Reliability",
            ("Agreement cannot be told: it takes two people who rated the same eyes differently.",),
        )
    data = {"reliability": found, "tau-with-others": person_taus(tables.ratings)}
    return Section("Reliability", (), (table,), data)
