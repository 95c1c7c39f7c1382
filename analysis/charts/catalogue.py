"""The catalogue of charts: what each is called, where it stands, the numbers behind it.

The report and the dashboard draw from this one list, in this order.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final, Literal, TypeVar

import pandas as pd
from matplotlib.figure import Figure

from analysis.charts import (
    by_model,
    by_model_table,
    cells,
    choices,
    clips,
    course,
    curves,
    decision,
    detection,
    ends,
    forest,
    heat,
    joint,
    pareto,
    people,
    residuals,
    scales,
    spread,
    stability,
    trends,
)
from analysis.charts.captions import CAPTIONS
from analysis.charts.material import Material
from analysis.correlation import rank_correlations
from analysis.curves.curve import NOTICED, PREFERRED, RATED
from analysis.descriptive import shares
from analysis.descriptive.means import mean_ratings, rating_counts
from analysis.tables.reading import Tables

Part = Literal["answer", "verdicts", "sizes", "ratings", "comparisons", "people"]
"""Where a chart stands in the report: beside the answer, or in one of the sections after it."""

Draw = Callable[[Material], Figure]
Tell = Callable[[Material], pd.DataFrame]
_Made = TypeVar("_Made")


@dataclass(frozen=True)
class Chart:
    """One chart: its file's name, where it stands, what it is called, its drawing, its table.

    ``draw`` and ``table`` take the same material, so that what is written is what is drawn. An
    early chart is drawn from the tables alone, so it need not wait for models.
    """

    name: str
    part: Part
    title: str
    draw: Draw
    table: Tell
    is_early: bool = False

    @property
    def caption(self) -> str:
        """What a reader needs to understand the chart."""
        return CAPTIONS[self.name]


def _tables(make: Callable[[Tables], _Made]) -> Callable[[Material], _Made]:
    """Let a function of the tables alone take the material."""
    return lambda material: make(material.tables)


def _curves(kind: str) -> Chart:
    """Return the chart of one kind of curve along the iris's size."""
    return Chart(
        f"{kind}-by-size",
        "sizes",
        curves.title(kind),
        lambda m: curves.curves_along_sizes(m, kind),
        lambda m: curves.curves_table(m, kind),
    )


CHARTS: Final = (
    Chart(
        "decision-chart",
        "answer",
        decision.TITLE,
        decision.decision_chart,
        decision.decision_cells,
    ),
    Chart("contrasts", "verdicts", forest.TITLE, forest.contrasts_against_margins,
          forest.contrasts),
    Chart("latent-realism", "verdicts", scales.LATENT, scales.latent_realism,
          scales.latent_table),
    Chart("joint-scale", "verdicts", joint.JOINT, joint.joint_scale, joint.joint_table),
    Chart("realism-against-cost", "verdicts", pareto.TITLE, pareto.realism_against_cost,
          pareto.points_table),
    _curves(NOTICED),
    _curves(PREFERRED),
    _curves(RATED),
    Chart("realism-per-clip", "ratings", clips.TITLE, _tables(clips.realism_per_clip),
          _tables(clips.eye_means), is_early=True),
    Chart("realism-matrix", "ratings", cells.MATRIX, _tables(cells.realism_matrix),
          _tables(lambda t: mean_ratings(t.ratings, ["lod", "distance"])), is_early=True),
    Chart("rating-distribution", "ratings", cells.DISTRIBUTION,
          _tables(cells.rating_distribution),
          _tables(lambda t: rating_counts(t.ratings, ["distance", "lod"], scale=t.scale)),
          is_early=True),
    Chart("perceived-against-actual", "ratings", trends.AGAINST_LOD,
          _tables(trends.perceived_against_actual),
          _tables(lambda t: rank_correlations(t.ratings)), is_early=True),
    Chart("perceived-by-model", "ratings", by_model.BY_MODEL, by_model.perceived_by_model,
          by_model_table.by_model_table),
    Chart("realism-by-distance", "ratings", trends.BY_DISTANCE,
          _tables(trends.realism_by_distance),
          _tables(lambda t: mean_ratings(t.ratings, ["distance", "lod"])), is_early=True),
    Chart("comparisons-per-pair", "comparisons", choices.PAIR_COMPARED,
          choices.comparisons_per_pair, choices.pair_comparisons),
    Chart("preference", "comparisons", scales.PREFERENCE, scales.preference_scale,
          scales.preference_table),
    Chart("noticed-per-pair", "comparisons", choices.PAIR_NOTICED,
          _tables(choices.noticed_per_pair),
          _tables(lambda t: shares.pair_notice_shares(t.comparisons)), is_early=True),
    Chart("detection", "comparisons", detection.DETECTION, detection.detection,
          detection.detection_table),
    Chart("comparisons-per-clip", "comparisons", choices.CLIP_COMPARED,
          choices.comparisons_per_clip, choices.clip_comparisons),
    Chart("noticed-per-clip", "comparisons", choices.CLIP_NOTICED,
          _tables(choices.noticed_per_clip),
          _tables(lambda t: shares.notice_shares(shares.clips_or_pairings(t.comparisons))),
          is_early=True),
    Chart("observers", "people", people.OBSERVERS, people.observers, people.observers_table),
    Chart("ratings-per-person", "people", heat.HEAT_MAP, heat.ratings_heat_map,
          heat.heat_table, is_early=True),
    Chart("verdict-stability", "people", stability.STABILITY, stability.verdict_stability,
          stability.stability_table),
    Chart("session-course", "people", course.COURSE, course.over_the_session,
          course.course_table, is_early=True),
    Chart("rating-spread", "people", spread.SPREAD, spread.spread_of_ratings,
          spread.spread_table, is_early=True),
    Chart("model-residuals", "people", residuals.RESIDUALS, residuals.residual_chart,
          residuals.residual_quantiles),
    Chart("predicted-shares", "people", ends.ENDS, ends.ends_chart, ends.ends_table),
)  # fmt: skip


def figures(source: Tables | Material, names: Iterable[str] | None = None) -> dict[str, Figure]:
    """Draw the charts by name, all of them unless some are named.

    Raises ValueError for a name that is no chart, with those that are.
    """
    material = Material(source) if isinstance(source, Tables) else source
    by_name = {chart.name: chart for chart in CHARTS}
    wanted = list(by_name if names is None else names)
    unknown = [name for name in wanted if name not in by_name]
    if unknown:
        raise ValueError(f'unknown chart "{unknown[0]}"; choose one of {", ".join(by_name)}')
    return {name: by_name[name].draw(material) for name in wanted}
