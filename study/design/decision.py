"""The margins of the answer, said before there are data: ``[decision]`` of a study file.

They stand in the definition and its hash, so everybody can tell that they were not chosen after
looking. What is done with them is the analysis's.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from study.design.faults import Fault, dotted, unknown
from study.design.parts import Name, Part, Real
from study.design.raw import Data, rows_of, table_of

WIDEST = 4.0  # points of the scale from 1 to 5


class DecisionRule(Part):
    """What counts as no loss.

    ``realism_margin`` is in points of the rating scale, ``noticed_margin`` a share of people beyond
    false alarms, ``confidence`` that of each one-sided bound. ``sequence`` names the LoDs from the
    best down to the cheapest, in the order of testing; empty, their ranks order them.
    """

    realism_margin: Annotated[Real, Field(gt=0, lt=WIDEST)]
    noticed_margin: Annotated[Real, Field(gt=0, lt=1)]
    confidence: Annotated[Real, Field(gt=0.5, lt=1)] = 0.95
    sequence: tuple[Name, ...] = ()


def check_decision(data: Data) -> Iterator[Fault]:
    """Yield the faults of a testing sequence: LoDs that are unknown, repeated or never shown."""
    listed = table_of(data, "decision").get("sequence")
    if not isinstance(listed, list) or not listed:
        return
    lods, shown = list(table_of(data, "lods")), _shown(data)
    if len(listed) == 1:
        text = "one LoD is no sequence; name at least two, from the best down to the cheapest"
        yield Fault("decision.sequence", text)
    for index, lod in enumerate(listed):
        place = dotted(("decision", "sequence", index))
        if not isinstance(lod, str):
            continue
        if lod not in lods:
            yield Fault(place, unknown("LoD", lod, lods))
        elif lod not in shown:
            yield Fault(place, f'no trial shows "{lod}"; leave it out or show it')
        if lod in listed[:index]:
            yield Fault(place, f'"{lod}" is listed twice')


def _shown(data: Data) -> set[str]:
    """Return the LoDs that trials show: neither practice nor gold."""
    shown: set[str] = set()
    for table, keys in _KEYS:
        for _, row in rows_of(data, table):
            for key in keys:
                found = row.get(key)
                values = found if isinstance(found, list) else [found]
                shown.update(value for value in values if isinstance(value, str))
    return shown


_KEYS = (("clips", ("left", "right")), ("factors", ("lods", "against")), ("catch", ("lod",)))
