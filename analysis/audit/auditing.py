"""An audit from the clips of a design, or from the tables of those who took part.

Pure: it takes the clips that were (or will be) shown, so a study can be audited before anyone has
answered.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

import pandas as pd

from analysis.audit.coverage import coverage_of, linked_groups
from analysis.audit.design import Audit, ShownClip
from analysis.tables.columns import DISTANCES, STANDARD_LODS
from analysis.tables.ordering import natural


def audit_design(clips: Iterable[ShownClip]) -> Audit:
    """Audit a design from its clips, practice left out by the caller.

    Where only the four standard distances are used, those not shown count as missing.
    """
    shown = list(clips)
    at = {clip.distance for clip in shown}
    if at <= set(DISTANCES):
        at = set(DISTANCES) if shown else set()
    named = {lod for clip in shown for lod in (clip.left_lod, clip.right_lod)}
    distances = [d for d in DISTANCES if d in at] + sorted(at - set(DISTANCES))
    lods = [lod for lod in STANDARD_LODS if lod in named] + sorted(named - set(STANDARD_LODS))
    cells = Counter(
        (clip.distance, lod) for clip in shown for lod in {clip.left_lod, clip.right_lod}
    )
    return Audit(
        distances=tuple(distances),
        lods=tuple(lods),
        cells=dict(cells),
        linked={
            d: linked_groups([(c.left_lod, c.right_lod) for c in shown if c.distance == d], lods)
            for d in distances
            if any(c.distance == d for c in shown)
        },
        catch_clips=sum(clip.is_catch for clip in shown),
        clips=len(shown),
        mirrored=_mirrored(shown),
        sides={
            lod: (
                sum(clip.left_lod == lod for clip in shown),
                sum(clip.right_lod == lod for clip in shown),
            )
            for lod in lods
        },
    )


def audit_tables(ratings: pd.DataFrame, comparisons: pd.DataFrame) -> Audit:
    """Audit what was shown to those who took part, and who saw what."""
    design = audit_design(shown_clips(ratings, comparisons))
    return replace(design, coverage=coverage_of(ratings))


def shown_clips(ratings: pd.DataFrame, comparisons: pd.DataFrame) -> list[ShownClip]:
    """Return the clips that the tables mention, practice left out.

    Ratings without an eye or its partner tell of no pairing and are counted as a pair of equals
    only if they say so.
    """
    known = ratings[ratings["other_lod"].notna() & ratings["eye"].notna()]
    is_left = known["eye"] == "left"
    eyes = known.assign(
        left_lod=known["lod"].where(is_left, known["other_lod"]),
        right_lod=known["other_lod"].where(is_left, known["lod"]),
    )
    columns = ["distance", "clip", "left_lod", "right_lod"]
    seen: dict[tuple[str, str], ShownClip] = {}
    for rows in (comparisons, eyes):
        shown = rows.loc[~rows["is_practice"], columns].drop_duplicates()
        for distance, clip, left, right in shown.astype(str).itertuples(index=False, name=None):
            seen.setdefault((distance, clip), ShownClip(clip, distance, left, right))
    return sorted(seen.values(), key=lambda clip: natural(clip.clip))


def _mirrored(clips: Sequence[ShownClip]) -> tuple[tuple[str, str], ...]:
    """Return the pairings shown both ways round, each by the first clip that shows it so.

    The same pairing with another iris is not another pairing.
    """
    first: dict[tuple[str, str, str], str] = {}
    for clip in clips:
        first.setdefault((clip.distance, clip.left_lod, clip.right_lod), clip.clip)
    found: list[tuple[str, str]] = []
    for place, (distance, left, right) in enumerate(first):
        other = (distance, right, left)
        if left != right and other in list(first)[place + 1 :]:
            found.append((first[distance, left, right], first[other]))
    return tuple(found)
