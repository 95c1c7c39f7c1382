"""The catalogue of charts: what each is called, what its caption says, the numbers behind it.

The report and the dashboard draw from this one list.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

import pandas as pd
from matplotlib.figure import Figure

from analysis import shares
from analysis.charts import cells, share_bars, trends
from analysis.charts.clips import realism_per_clip
from analysis.correlation import rank_correlations
from analysis.descriptive import mean_ratings, rating_counts
from analysis.reading import Tables


@dataclass(frozen=True)
class Chart:
    """One chart: its file's name, its caption, its drawing and the table behind it."""

    name: str
    caption: str
    draw: Callable[[Tables], Figure]
    table: Callable[[Tables], pd.DataFrame]


_INTERVAL: Final = (
    "The scale runs from completely unrealistic to almost or completely photorealistic. Symbols "
    "are means over people, vertical lines 95 % t intervals."
)

CHARTS: Final = (
    Chart(
        "realism-per-clip",
        "Perceived realism of each eye in each clip, grouped by viewing distance and coloured by "
        f"level of detail (LoD). {_INTERVAL} Dots are single people (in larger studies "
        "the area of a dot is their share), n is their number. Left and right are the viewer's. "
        "(The thesis's Figure 5.2, with its uncertainty.)",
        realism_per_clip,
        lambda t: mean_ratings(t.ratings, ["distance", "clip", "eye", "lod"]),
    ),
    Chart(
        "perceived-against-actual",
        f"Perceived realism against the actual LoD at each distance. {_INTERVAL} Grey lines are "
        "single people (where they are at most 100). τ is Kendall's tau-b within people, averaged "
        "on Fisher's z scale, with its 95 % interval; people whose ratings are all alike have "
        "none.",
        trends.perceived_against_actual,
        lambda t: rank_correlations(t.ratings),
    ),
    Chart(
        "realism-by-distance",
        f"Perceived realism by viewing distance for each LoD. {_INTERVAL} Lines join neighbouring "
        "distances at which a LoD was shown.",
        trends.realism_by_distance,
        lambda t: mean_ratings(t.ratings, ["distance", "lod"]),
    ),
    Chart(
        "comparisons-per-pair",
        "Which LoD of a pair was called more realistic, whichever side it stood on. The share next "
        "to a name preferred it. Lines are 95 % Wilson intervals: above the bar for the LoD on the "
        "left, below it for the LoD on the right.",
        share_bars.comparisons_per_pair,
        lambda t: shares.pair_comparison_shares(t.comparisons),
    ),
    Chart(
        "noticed-per-pair",
        "Whether anything missing or different was noticed between the eyes, by pair of LoDs. "
        "Lines are 95 % Wilson intervals of yes. For equal LoDs, yes is a false alarm.",
        share_bars.noticed_per_pair,
        lambda t: shares.pair_notice_shares(t.comparisons),
    ),
    Chart(
        "rating-distribution",
        "How often each rating was given, by distance and LoD; bars are centred on the middle of "
        "the scale, n counts ratings.",
        cells.rating_distribution,
        lambda t: rating_counts(t.ratings, ["distance", "lod"], scale=t.scale),
    ),
    Chart(
        "realism-matrix",
        "What was shown: mean realism of each combination of LoD and distance, with the number of "
        "people (n) and of ratings. Nothing is known about hatched combinations.",
        cells.realism_matrix,
        lambda t: mean_ratings(t.ratings, ["lod", "distance"]),
    ),
    Chart(
        "comparisons-per-clip",
        "Which eye was called more realistic in each clip, as the viewer saw it. Lines are 95 % "
        "Wilson intervals: above the bar for the left eye, below it for the right eye.",
        share_bars.comparisons_per_clip,
        lambda t: shares.comparison_shares(t.comparisons),
    ),
    Chart(
        "noticed-per-clip",
        "Whether anything missing or different was noticed between the eyes, clip by clip. Lines "
        "are 95 % Wilson intervals of yes.",
        share_bars.noticed_per_clip,
        lambda t: shares.notice_shares(t.comparisons),
    ),
)


def figures(tables: Tables, names: Iterable[str] | None = None) -> dict[str, Figure]:
    """Draw the charts by name, all of them unless some are named.

    Raises ValueError for a name that is no chart, with those that are.
    """
    by_name = {chart.name: chart for chart in CHARTS}
    wanted = list(by_name if names is None else names)
    unknown = [name for name in wanted if name not in by_name]
    if unknown:
        raise ValueError(f'unknown chart "{unknown[0]}"; choose one of {", ".join(by_name)}')
    return {name: by_name[name].draw(tables) for name in wanted}
