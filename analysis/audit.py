"""What a design can and cannot say: cells shown, LoDs linked by comparisons, catch trials, sides.

Pure: it takes the clips that were (or will be) shown, so a study can be audited before anyone has
answered.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import pandas as pd

from analysis.table import DISTANCES, STANDARD_LODS

_WORDS: Final = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")


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

    ``linked`` holds, per distance, the groups of LoDs that comparisons link; one group is best.
    """

    distances: tuple[str, ...]
    lods: tuple[str, ...]
    cells: dict[tuple[str, str], int]
    linked: dict[str, tuple[tuple[str, ...], ...]]
    catch_clips: int
    clips: int
    mirrored: tuple[tuple[str, str], ...]
    sides: dict[str, tuple[int, int]]

    @property
    def empty_cells(self) -> tuple[tuple[str, str], ...]:
        """Pairs of distance and LoD that no clip shows."""
        return tuple(
            (d, lod) for d in self.distances for lod in self.lods if not self.cells.get((d, lod))
        )

    def statements(self) -> list[str]:
        """Say in sentences what this design shows and what it cannot answer."""
        if not self.clips:
            return ["No clip has been shown, so nothing can be concluded."]
        return [*self._about_cells(), *self._about_links(), *self._about_catch_and_sides()]

    def _about_cells(self) -> list[str]:
        total = len(self.distances) * len(self.lods)
        seen = total - len(self.empty_cells)
        text = [f"{seen} of {total} combinations of LoD and distance were shown."]
        if self.empty_cells:
            missing = "; ".join(
                f"{d}: {_listed([lod for at, lod in self.empty_cells if at == d])}"
                for d in self.distances
                if any(at == d for at, _ in self.empty_cells)
            )
            text.append(
                f"Not shown: {missing}. Nothing can be said about them, and how the effect of LoD "
                "changes with distance is known only where the same LoDs were shown."
            )
        return text

    def _about_links(self) -> list[str]:
        text = []
        for distance, groups in self.linked.items():
            if len(groups) > 1:
                names = "; ".join(_listed(group) for group in groups)
                text.append(
                    f"At {distance}, comparisons do not link all LoDs ({names}): between these "
                    "groups only the ratings tell."
                )
        if len(self.distances) > 1:
            text.append(
                "No comparison links two distances; only the ratings do. Comparisons are therefore "
                "read within a distance."
            )
        return text

    def _about_catch_and_sides(self) -> list[str]:
        text = []
        if self.catch_clips:
            text.append(f"{_count(self.catch_clips, 'clip')} showed the same LoD in both eyes.")
        else:
            text.append(
                "No clip showed the same LoD in both eyes, so it is unknown how often people "
                "notice a difference where there is none; a share of people who noticed one is not "
                "a sensitivity."
            )
        if self.mirrored:
            pairs = "; ".join(f"{a} and {b}" for a, b in self.mirrored)
            text.append(f"Shown with the eyes exchanged: {pairs}.")
        else:
            text.append(
                "No pairing was shown with the eyes exchanged, so a preference for one side cannot "
                "be told from a preference for a LoD."
            )
        one_sided = [lod for lod, (left, right) in self.sides.items() if not left or not right]
        if one_sided:
            text.append(f"Seen on one side only: {_listed(one_sided)}.")
        return text


def audit_design(clips: Iterable[ShownClip]) -> Audit:
    """Audit a design from its clips, practice left out by the caller."""
    shown = list(clips)
    at = {clip.distance for clip in shown}
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
        linked={d: _linked([c for c in shown if c.distance == d], lods) for d in distances},
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


def shown_clips(ratings: pd.DataFrame, comparisons: pd.DataFrame) -> list[ShownClip]:
    """Return the clips that the tables mention, practice left out.

    Ratings without an eye or its partner tell of no pairing and are counted as a pair of equals
    only if they say so.
    """
    seen: dict[tuple[str, str], ShownClip] = {}
    for row in comparisons[~comparisons["is_practice"]].itertuples():
        clip = ShownClip(str(row.clip), str(row.distance), str(row.left_lod), str(row.right_lod))
        seen.setdefault((clip.distance, clip.clip), clip)
    known = ratings[~ratings["is_practice"] & ratings["other_lod"].notna() & ratings["eye"].notna()]
    for row in known.itertuples():
        lods = (str(row.lod), str(row.other_lod))
        left, right = lods if row.eye == "left" else lods[::-1]
        clip = ShownClip(str(row.clip), str(row.distance), left, right)
        seen.setdefault((clip.distance, clip.clip), clip)
    return list(seen.values())


def _linked(clips: Sequence[ShownClip], order: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    groups: list[set[str]] = []
    for clip in clips:
        pair = {clip.left_lod, clip.right_lod}
        touching = [group for group in groups if group & pair]
        groups = [group for group in groups if not group & pair]
        groups.append(pair.union(*touching))
    return tuple(tuple(sorted(group, key=order.index)) for group in groups)


def _mirrored(clips: Sequence[ShownClip]) -> tuple[tuple[str, str], ...]:
    return tuple(
        (a.clip, b.clip)
        for i, a in enumerate(clips)
        for b in clips[i + 1 :]
        if not a.is_catch
        and a.distance == b.distance
        and (a.left_lod, a.right_lod) == (b.right_lod, b.left_lod)
    )


def _count(number: int, noun: str) -> str:
    word = _WORDS[number] if number < len(_WORDS) else str(number)
    return f"{word.capitalize()} {noun}{'' if number == 1 else 's'}"


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names)
