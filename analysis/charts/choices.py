"""Charts of comparisons: which eye was called more realistic, and who noticed a difference.

Beside the shares of a comparison stands what the preference scale expects, and what standing on the
right adds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.charts.material import Material
from analysis.charts.share_bars import Look, share_chart
from analysis.charts.style import CHOICE_COLOURS, NOTICE_COLOURS
from analysis.descriptive.shares import (
    OUTCOMES,
    PAIR_OUTCOMES,
    clips_or_pairings,
    comparison_shares,
    notice_shares,
    pair_comparison_shares,
    pair_notice_shares,
)
from analysis.estimates.predicted_choices import Shares, choice_shares, pair_shares
from analysis.estimates.preference import Cell, Preference
from analysis.tables.columns import NOTICED
from analysis.tables.reading import Tables
from analysis.words.wording import counted, number

CLIP_COMPARED: Final = "Which eye is more realistic, per clip"
PAIR_COMPARED: Final = "Which LoD is more realistic, per pair"
CLIP_NOTICED: Final = "Difference noticed, per clip"
PAIR_NOTICED: Final = "Difference noticed, per pair"
NO_COMPARISONS: Final = "No comparison of the two eyes has been answered yet."
NO_NOTICES: Final = "Whether a difference was noticed has not been answered yet."
_SEEN: Final = ("left_lod", "right_lod")
_RANKED: Final = ("lesser", "greater")
_NOTICE_NAMES: Final = ("yes", "not sure", "no")
Predict = Callable[[Preference, Cell, Cell], Shares | None]


def clip_comparisons(material: Material) -> pd.DataFrame:
    """Return the shares per clip, with what the preference scale expects (``predicted``)."""
    shares = comparison_shares(clips_or_pairings(material.tables.comparisons))
    return _with_expected(shares, material, choice_shares, sides=_SEEN, answers=OUTCOMES)


def pair_comparisons(material: Material) -> pd.DataFrame:
    """Return the shares per pair of LoDs, with what the preference scale expects."""
    shares = pair_comparison_shares(material.tables.comparisons)
    return _with_expected(shares, material, pair_shares, sides=_RANKED, answers=PAIR_OUTCOMES)


def comparisons_per_clip(material: Material) -> Figure:
    """Draw, per clip, how many called the left eye, neither, or the right eye more realistic."""
    names = ("left eye", "no difference noticed", "right eye")
    look = Look(CLIP_COMPARED, OUTCOMES, names, CHOICE_COLOURS, _SEEN, NO_COMPARISONS, True,
                side_sentence(material))  # fmt: skip
    return share_chart(clip_comparisons(material), material.tables, look)


def comparisons_per_pair(material: Material) -> Figure:
    """Draw, per pair of LoDs, how many called the lesser, neither or the greater more real."""
    names = ("lesser LoD", "no difference noticed", "greater LoD")
    look = Look(PAIR_COMPARED, PAIR_OUTCOMES, names, CHOICE_COLOURS, _RANKED, NO_COMPARISONS, True,
                side_sentence(material))  # fmt: skip
    return share_chart(pair_comparisons(material), material.tables, look)


def noticed_per_clip(tables: Tables) -> Figure:
    """Draw, per clip, how many noticed anything missing or different between the eyes."""
    look = Look(CLIP_NOTICED, NOTICED, _NOTICE_NAMES, NOTICE_COLOURS, _SEEN, NO_NOTICES, False)
    return share_chart(notice_shares(clips_or_pairings(tables.comparisons)), tables, look)


def noticed_per_pair(tables: Tables) -> Figure:
    """Draw, per pair of LoDs, how many noticed a difference; equal LoDs show false alarms."""
    look = Look(PAIR_NOTICED, NOTICED, _NOTICE_NAMES, NOTICE_COLOURS, _RANKED, NO_NOTICES, False)
    return share_chart(pair_notice_shares(tables.comparisons), tables, look)


def side_sentence(material: Material) -> str:
    """Say what standing on the right adds, and how many pairs were seen both ways round."""
    preference = material.inference.preference
    if preference is None:
        return ""
    side, draws = preference.side()
    low, high = np.quantile(draws, (0.025, 0.975))
    rows = material.tables.comparisons
    rows = rows[rows["comparison"].notna() & ~rows["is_practice"]]
    seen = set(zip(rows["distance"], rows["left_lod"], rows["right_lod"], strict=True))
    both = sum((where, right, left) in seen for where, left, right in seen if left < right)
    return (
        f"side bias: an eye on the right gains {number(side)} JOD [{number(low)}, {number(high)}]; "
        f"{counted(both, 'pair', 'pairs')} shown both ways round"
    )


def _with_expected(
    shares: pd.DataFrame,
    material: Material,
    predict: Predict,
    *,
    sides: tuple[str, str],
    answers: tuple[str, str, str],
) -> pd.DataFrame:
    preference = material.inference.preference
    if preference is None or shares.empty:
        return shares.assign(predicted=np.nan)
    known: dict[tuple[str, str, str], Shares | None] = {}
    expected = []
    columns = [shares[name] for name in ("distance", *sides, "answer")]
    for where, one, other, answer in zip(*columns, strict=True):
        key = (str(where), str(one), str(other))
        if key not in known:
            known[key] = predict(preference, (key[0], key[1]), (key[0], key[2]))
        own = known[key]
        expected.append(np.nan if own is None else own[answers.index(answer)])
    return shares.assign(predicted=expected)
