"""Contact sheets: every LoD at every distance from five azimuths, to be searched for faults.

Whole pictures, as a participant sees them: nothing is cropped away.
"""

from __future__ import annotations

from typing import Final

from renderer.clip_values import DISTANCES
from renderer.detail import STANDARD_LODS
from renderer.gallery.shots import WHOLE, Shot, spec_of
from renderer.gallery.strips import Strip, of_shots

AZIMUTHS_DEG: Final = (-60, -30, 0, 30, 60)
MARGINS: Final = {"macroscopic": 0.0, "near": 0.0, "medium": 0.2, "far": 0.4}


def _views(distance: str, lod: str) -> list[Shot]:
    margin = MARGINS[distance]
    crop = (margin, margin, 1.0 - margin, 1.0 - margin) if margin else WHOLE
    spec = spec_of(lod, distance=distance)
    return [
        Shot(
            f"azimuth {azimuth:+d}",
            spec,
            crop,
            azimuth_deg=azimuth,
            lines=1500 if margin else 1000,
            enlarge=3 if distance == "far" else 1,
        )
        for azimuth in AZIMUTHS_DEG
    ]


SHEETS: Final = tuple(
    Strip(
        f"sheet-{distance}-{lod}",
        f"{lod} at distance {distance}",
        of_shots(_views(distance, lod)),
        columns=2,
        tile_px=1280,
    )
    for distance in DISTANCES
    for lod in STANDARD_LODS
)
