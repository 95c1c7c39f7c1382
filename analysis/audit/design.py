"""A design's facts, and what they let it say and not say, in sentences. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from analysis.audit.coverage import Coverage
from analysis.words.wording import listed

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
