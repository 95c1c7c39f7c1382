"""The gallery's page: what to look at in each strip, with those that are in the folder.

The words stand in page.md, where a line ``@NAME`` is the place of a strip and of all that is said
about it up to the next strip or heading. ``@@strands`` is the place of the iris's measurements.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from renderer.gallery.strips import Strip
from renderer.iris.maps import iris_maps
from renderer.iris.statistics import Strands, measure_strands

WORDS: Final = Path(__file__).with_name("page.md")
PAGE: Final = "README.md"
MEASURED: Final = (("blue", 1), ("brown", 1))
# Four super-macro photographs, through reference/eye-rendering.md, 1.4.
PHOTOGRAPHED: Final = (
    ("strand width", "50 to 65 µm, bundles 110 to 130"),
    ("spacing", "91 to 117 µm, bundles 205 to 235"),
    ("share of ridges", "0.30 to 0.40"),
    ("ridge against gap, L*", "8 to 18"),
    ("the same in a* and b*", "under 2.5"),
)


def page_of(strips: Sequence[Strip], files: Mapping[str, str], measured: str) -> str:
    """Return the page; ``files`` has the file of each strip that is there.

    Strips without a file are left out, with what is said about them.
    """
    titles = {strip.name: strip.title for strip in strips}
    parts = re.split(r"^(?=@\w|#)", WORDS.read_text(encoding="utf-8"), flags=re.MULTILINE)
    kept = []
    for part in parts:
        place = re.match(r"@([\w-]+)\n", part)
        if not place:
            kept.append(part)
        elif place[1] in files:
            picture = f"![{titles[place[1]]}]({files[place[1]]})"
            kept.append(picture + part[place.end() - 1 :])
    page = "".join(kept).replace("@@strands", measured)
    # A heading whose strips are all missing says nothing.
    return re.sub(r"^## [^\n]*\n+(?=## |\Z)", "", page, flags=re.MULTILINE)


def measured_strands() -> str:
    """Return a table of strands on photographs and on MEASURED irises."""
    columns = [
        _cells(measure_strands(iris_maps(seed, colour, size_px=2048).albedo))
        for colour, seed in MEASURED
    ]
    heads = [f"{colour}, seed {seed}" for colour, seed in MEASURED]
    rows = [["", "photographs", *heads], ["---"] * (2 + len(heads))]
    rows += [
        [name, photographs, *(column[i] for column in columns)]
        for i, (name, photographs) in enumerate(PHOTOGRAPHED)
    ]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _cells(strands: Strands) -> list[str]:
    lightness, red, yellow = strands.split
    return [
        f"{1000 * strands.width_mm:.0f} µm",
        f"{1000 * strands.spacing_mm:.0f} µm",
        f"{strands.coverage:.2f}",
        f"{lightness:.1f}",
        f"{red:.1f}, {yellow:.1f}",
    ]
