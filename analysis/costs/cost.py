"""What each LoD costs on the renderer: reads ``bench.json`` and picks the rows that fit a study.

A cost holds for one renderer, one picture size and one number of eyes; these are always named.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import pandas as pd

from analysis.tables.parsing import TableError

_TEXT: Final = ("renderer", "distance")
_NUMBERS: Final = ("iris_px", "eyes", "ms_median", "ms_mad", "n")
COLUMNS: Final = (
    *("renderer", "size", "eyes", "distance", "iris_px", "lod"),
    *("ms_median", "ms_mad", "n"),
)
EFFECT_COLUMNS: Final = (
    *("renderer", "size", "eyes", "distance", "effect", "level", "base"),
    *("ms_median", "ms_mad", "n"),
)
_NO_EFFECTS: Final = pd.DataFrame(columns=list(EFFECT_COLUMNS))


@dataclass(frozen=True)
class Costs:
    """Milliseconds per frame of each LoD at each distance, under one stated condition.

    ``eyes`` is how many eyes of the LoD a frame held. ``effects`` are what single effects cost: a
    frame with the effect at a level minus the same frame without it.
    """

    table: pd.DataFrame
    condition: str
    eyes: float = 1.0
    effects: pd.DataFrame = field(default_factory=_NO_EFFECTS.copy)

    def ms(self, distance: str, lod: str) -> float | None:
        """Return the median milliseconds per frame, None where it was not measured."""
        is_wanted = (self.table["distance"] == distance) & (self.table["lod"] == lod)
        rows = self.table[is_wanted]
        return float(rows["ms_median"].iloc[0]) if len(rows) else None


def read_bench(path: str | Path) -> Costs:
    """Read the cost of each LoD from ``bench.json``: a list of rows, or an object with ``rows``.

    LoDs are taken from the part "lods" and from rows without a part: a LoD among a crowd, say, is
    another condition; effects from the part "effects". Of several renderers, sizes and numbers of
    eyes it takes the largest picture with the most eyes of the renderer named last. Raises
    TableError with every fault of the file.
    """
    place = Path(path)
    try:
        content = json.loads(place.read_text(encoding="utf-8"))
    except OSError as error:
        raise TableError([f"{place}: {error.strerror}; accepted: bench.json"]) from None
    except ValueError as error:
        raise TableError([f"{place.name}: not JSON ({error}); accepted: bench.json"]) from None
    rows = content.get("rows") if isinstance(content, Mapping) else content
    if not isinstance(rows, list):
        raise TableError([f"{place.name}: found no list of rows; accepted: bench.json"])
    faults = [fault for i, row in enumerate(rows) for fault in _faults(row, f"{place.name}: {i}")]
    if faults:
        raise TableError(faults)
    return _chosen(rows)


def _faults(row: object, place: str) -> list[str]:
    if not isinstance(row, Mapping):
        return [f'{place}: found "{row}"; accepted: an object']
    if not _is_lods(row):
        return []
    faults = [
        f'{place}.{name}: found "{row.get(name)}"; accepted: some text'
        for name in _TEXT
        if not isinstance(row.get(name), str)
    ]
    faults += [
        f'{place}.{name}: found "{row.get(name)}"; accepted: a number of at least 0'
        for name in _NUMBERS
        if not _is_measure(row.get(name))
    ]
    if row.get("size") is None:
        faults.append(f'{place}.size: found "None"; accepted: a size like 1920x1080')
    return faults


def _is_lods(row: Mapping[str, Any]) -> bool:
    """Say whether a row is a LoD's cost: neither an effect's nor that of a special scene."""
    return bool(row.get("lod")) and row.get("part", "lods") == "lods"


def _is_measure(value: object) -> bool:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_number and math.isfinite(float(str(value))) and float(str(value)) >= 0


def _size(value: Any) -> str:
    return "x".join(map(str, value)) if isinstance(value, list) else str(value)


def _pixels(size: str) -> int:
    sides = [int(part) for part in size.split("x") if part.isdigit()]
    return math.prod(sides) if sides else 0


def _chosen(rows: list[dict[str, Any]]) -> Costs:
    lods = [{**row, "size": _size(row["size"])} for row in rows if _is_lods(row)]
    effects = _effects(rows)
    if not lods:
        nothing = pd.DataFrame(columns=list(COLUMNS))
        return Costs(nothing, "no LoD was measured", effects=effects)
    renderer = lods[-1]["renderer"]
    own = [row for row in lods if row["renderer"] == renderer]
    size = max((row["size"] for row in own), key=_pixels)
    eyes = max(row["eyes"] for row in own if row["size"] == size)
    chosen = [row for row in own if row["size"] == size and row["eyes"] == eyes]
    table = pd.DataFrame(chosen)[list(COLUMNS)]
    return Costs(table, f"{eyes_in_words(eyes)}, {size} pixels, {renderer}", eyes, effects)


def eyes_in_words(count: float) -> str:
    """Write how many eyes a frame holds."""
    return "one eye" if count == 1 else f"{count:g} eyes"


def _effects(rows: list[dict[str, Any]]) -> pd.DataFrame:
    """Return the rows of single effects that are complete, the last of equal ones."""
    own = [
        {**{name: row.get(name) for name in EFFECT_COLUMNS}, "size": _size(row.get("size"))}
        for row in rows
        if row.get("part") == "effects" and all(_is_measure(row.get(n)) for n in ("eyes", "n"))
    ]
    table = pd.DataFrame(own, columns=list(EFFECT_COLUMNS))
    keys = ["effect", "level", "base", "distance"]
    return table.dropna(subset=["ms_median", "ms_mad", *keys]).drop_duplicates(keys, keep="last")
