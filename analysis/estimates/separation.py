"""Eyes that everybody rated at one end of the scale: how far beyond it they lie is not known."""

from __future__ import annotations

from typing import Final

from analysis.estimates.realism import Realism
from analysis.words.wording import listed

_MOST_NAMED: Final = 4


def separation_warnings(realism: Realism) -> tuple[str, ...]:
    """Name the cells (distance, LoD) whose ratings are all the lowest, or all the highest.

    Their places have one bound only (the maximum of the likelihood lies at infinity); the priors
    keep them finite.
    """
    stimuli = realism.stimuli
    given = stimuli.counts.table.sum(axis=0)
    told = []
    for category, word in ((0, "lowest"), (stimuli.counts.categories - 1, "highest")):
        names = []
        for distance, lod in realism.cells:
            own = (stimuli.table["distance"] == distance) & (stimuli.table["lod"] == lod)
            counts = given[own.to_numpy()].sum(axis=0)
            if counts.sum() and counts[category] == counts.sum():
                names.append(f"{lod} at {distance}")
        if names:
            told.append(
                f"all ratings of {_few(names)} are the {word}: how far beyond the scale's end "
                "that lies is not known, and priors keep it finite"
            )
    return tuple(told)


def _few(names: list[str]) -> str:
    if len(names) <= _MOST_NAMED:
        return listed(names)
    return f"{', '.join(names[: _MOST_NAMED - 1])} and {len(names) - _MOST_NAMED + 1} others"
