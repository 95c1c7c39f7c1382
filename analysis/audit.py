"""What a design can and cannot say: cells shown, LoDs linked by comparisons, catch trials, sides.

Pure: it takes the clips that were (or will be) shown, so a study can be audited before anyone has
answered.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import pandas as pd

from analysis.coverage import Coverage, coverage_of, linked_groups
from analysis.tables.columns import DISTANCES, STANDARD_LODS
from analysis.tables.ordering import natural
from analysis.wording import listed

MOST_LISTED: Final = 6  # more names than these are a number


@dataclass(frozen=True)
class ShownClip:
    """One clip of a design: where it is seen from and the LoD of each eye."""

    clip: str
    distance: str
    left_lod: str
    right_lod: str

    @property
    def is_catch(self) -> bool:
        """Whether both eyes have the same LoD."""
        return self.left_lod == self.right_lod


@dataclass(frozen=True)
class Audit:
    """A design's facts. ``cells`` counts the clips that show each LoD at each distance.

    ``linked`` holds, per distance shown, the groups of LoDs that comparisons link: one group is
    best. ``sides`` counts the clips that show each LoD on the left and on the right; ``coverage``
    says who saw what, where people took part.
    """

    distances: tuple[str, ...]
    lods: tuple[str, ...]
    cells: dict[tuple[str, str], int]
    linked: dict[str, tuple[tuple[str, ...], ...]]
    catch_clips: int
    clips: int
    mirrored: tuple[tuple[str, str], ...]
    sides: dict[str, tuple[int, int]]
    coverage: Coverage | None = None

    @property
    def empty_cells(self) -> tuple[tuple[str, str], ...]:
        """Pairs of distance and LoD that no clip shows."""
        return tuple(
            (d, lod) for d in self.distances for lod in self.lods if not self.cells.get((d, lod))
        )

    def statements(self) -> list[str]:
        """Say in sentences what this design shows and what it cannot answer."""
        return [*self.facts(), *self.limits()]

    def facts(self) -> list[str]:
        """Say in sentences what was shown."""
        if not self.clips:
            return []
        total = len(self.distances) * len(self.lods)
        seen = total - len(self.empty_cells)
        text = [f"{seen} of {total} combinations of LoD and distance were shown."]
        text += self.coverage.facts() if self.coverage else []
        if self.catch_clips:
            text.append(f"Clips with the same LoD in both eyes: {self.catch_clips}.")
        if len(self.mirrored) > MOST_LISTED:
            text.append(f"Shown with the eyes exchanged: {len(self.mirrored)} pairings.")
        elif self.mirrored:
            pairs = "; ".join(f"clips {a} and {b}" for a, b in self.mirrored)
            text.append(f"Shown with the eyes exchanged: {pairs}.")
        return text

    def limits(self) -> list[str]:
        """Say in sentences what this design cannot answer."""
        if not self.clips:
            return ["No pair of eyes was shown, so nothing is known about comparisons."]
        unlinked = self.coverage.limits() if self.coverage else []
        return [*self._missing(), *self._unlinked(), *unlinked, *self._unknown()]

    def _missing(self) -> list[str]:
        missing = [text for text in map(self._missing_at, self.distances) if text]
        if not missing:
            return []
        return [
            f"Not shown: {'; '.join(missing)}. Nothing can be said about these, and how the effect "
            "of LoD changes with distance is known only where the same LoDs were shown."
        ]

    def _missing_at(self, distance: str) -> str:
        missing = [lod for at, lod in self.empty_cells if at == distance]
        if len(missing) == len(self.lods):
            return f"any LoD at distance={distance}"
        return f"{listed(missing)} at distance={distance}" if missing else ""

    def _unlinked(self) -> list[str]:
        text = [
            f"At distance={distance}, comparisons do not link all LoDs "
            f"({'; '.join(listed(group) for group in groups)}): between these groups only the "
            "ratings tell."
            for distance, groups in self.linked.items()
            if len(groups) > 1
        ]
        if len(self.linked) > 1:
            text.append(
                "No comparison links two distances; only the ratings do. Comparisons are therefore "
                "read within a distance."
            )
        return text

    def _unknown(self) -> list[str]:
        text = []
        if not self.catch_clips:
            text.append(
                "No clip showed the same LoD in both eyes, so it is unknown how often people "
                "notice a difference where there is none; a share of people who noticed one is not "
                "a sensitivity."
            )
        if not self.mirrored:
            text.append(
                "No pairing was shown with the eyes exchanged, so a preference for one side cannot "
                "be told from a preference for a LoD."
            )
        one_sided = [lod for lod, (left, right) in self.sides.items() if not left or not right]
        if one_sided:
            text.append(f"Seen on one side only: {listed(one_sided)}.")
        return text


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
    return tuple(
        (a.clip, b.clip)
        for i, a in enumerate(clips)
        for b in clips[i + 1 :]
        if not a.is_catch
        and a.distance == b.distance
        and (a.left_lod, a.right_lod) == (b.right_lod, b.left_lod)
    )
