"""A file that says what to assume: per distance and LoD, the loss of realism and who notices.

base = "thesis"          # what is not named below: "thesis" or "equal"

[near]
medium = { loss = 0.3, noticed = 0.1 }
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from analysis.decision.margins import Margins
from analysis.power.assumed import (
    Assumed,
    Cell,
    Differences,
    best_lods,
    changed,
    lower_cells,
    named_truth,
)
from analysis.simulation.observers import Stimulus

BASES: Final = ("thesis", "equal")
_ACCEPTED: Final[Mapping[str, tuple[float, float, str]]] = {
    "loss": (-2.0, 4.0, "points below the best LoD"),
    "noticed": (0.0, 0.9, "share of people beyond false alarms"),
}


def read_truth(path: Path, clips: Iterable[Stimulus], margins: Margins) -> Assumed:
    """Read a truth; raises ValueError with every fault, OSError where there is no such file."""
    listed = list(clips)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path.name}: no TOML: {error}") from None
    base = data.pop("base", BASES[0])
    best = best_lods(listed, margins)
    faults = [] if base in BASES else [_fault("base", base, " or ".join(BASES))]
    wanted: dict[Cell, Differences] = {}
    cells = lower_cells(listed, best)
    for distance, table in data.items():
        if distance not in best or not isinstance(table, dict):
            faults.append(_fault(distance, table, f"a table named {', '.join(best)}"))
            continue
        lods = [lod for where, lod in cells if where == distance]
        for lod, own in table.items():
            place = f"{distance}.{lod}"
            if lod not in lods or not isinstance(own, dict):
                faults.append(_fault(place, own, f"one of {', '.join(lods)}, with what is assumed"))
                continue
            faults += _value_faults(place, own)
            wanted[distance, lod] = Differences(own.get("loss"), own.get("noticed"))
    if faults:
        raise ValueError("\n".join(f"{path.name}: {fault}" for fault in faults))
    return changed(named_truth(str(base), listed, margins), path.name, best=best, wanted=wanted)


def _value_faults(place: str, own: Mapping[str, Any]) -> Iterator[str]:
    for key, value in own.items():
        if key not in _ACCEPTED:
            yield _fault(f"{place}.{key}", value, f"the keys {' and '.join(_ACCEPTED)}")
            continue
        low, high, meaning = _ACCEPTED[key]
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not low <= value <= high:
            yield _fault(f"{place}.{key}", value, f"{low:g} to {high:g}, {meaning}")


def _fault(place: str, found: object, accepted: str) -> str:
    return f"{place}: found {found!r}; accepted: {accepted}"
