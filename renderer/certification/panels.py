"""Pictures of a certification: ours, the reference, where they differ, and luminance profiles."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.certification.certificate import PictureResult
from renderer.certification.metrics import LUMINANCE, displayed
from renderer.certification.view import HALF_MM

Array = npt.NDArray[np.float64]

DIAMETERS_DEG: Final = (0, 45, 90, 135)
REACH_MM: Final = 7.5  # of a diameter to both sides of the pupil's centre
SAMPLES: Final = 301
OURS, REFERENCE = "#c2410c", "#1d4ed8"


def write_panel(result: PictureResult, path: Path) -> None:
    """Write one case as a PNG: ours | reference | FLIP | profiles along four diameters."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.5, 3.4), layout="constrained")
    grid = figure.add_gridspec(2, 5, width_ratios=[1, 1, 1.12, 1, 1])
    _show(figure.add_subplot(grid[:, 0]), displayed(result.ours), "ours")
    _show(figure.add_subplot(grid[:, 1]), displayed(result.reference), "path tracer")
    flip = figure.add_subplot(grid[:, 2])
    shown = flip.imshow(result.score.flip_map, cmap="magma", vmin=0.0, vmax=0.3)
    flip.set_title("FLIP, 0 to 0.3", fontsize=9)
    flip.set_axis_off()
    figure.colorbar(shown, ax=flip, shrink=0.7)
    for number, angle_deg in enumerate(DIAMETERS_DEG):
        axes = figure.add_subplot(grid[number // 2, 3 + number % 2])
        _profile(axes, result, angle_deg)
    figure.savefig(path, dpi=110)


def profile(picture: Array, centre_px: tuple[float, float], angle_deg: float) -> Array:
    """Return luminance along a diameter through a point (row, column) of a picture (n, n, 3)."""
    along = np.linspace(-REACH_MM, REACH_MM, SAMPLES) * len(picture) / (2 * HALF_MM)
    turn = np.radians(angle_deg)
    at = np.stack([centre_px[0] - along * np.sin(turn), centre_px[1] + along * np.cos(turn)])
    return np.asarray(ndimage.map_coordinates(picture @ LUMINANCE, at, order=1, mode="nearest"))


def pupil_centre(masks: dict[str, npt.NDArray[np.bool_]]) -> tuple[float, float]:
    """Return the row and column of the middle of what lies within limbus and sclera."""
    within = masks["whole eye"] & ~masks["limbus"] & ~masks["sclera"]
    rows, columns = np.nonzero(within)
    return float(rows.mean()), float(columns.mean())


def _profile(axes: Any, result: PictureResult, angle_deg: float) -> None:
    centre = pupil_centre(result.masks)
    mm = np.linspace(-REACH_MM, REACH_MM, SAMPLES)
    axes.plot(mm, profile(result.reference, centre, angle_deg), color=REFERENCE, lw=1.4)
    axes.plot(mm, profile(result.ours, centre, angle_deg), color=OURS, lw=0.9)
    axes.set_title(f"luminance at {angle_deg} degrees, mm", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.set_ylim(bottom=0.0)


def _show(axes: Any, picture: Array, title: str) -> None:
    axes.imshow(picture)
    axes.set_title(title, fontsize=9)
    axes.set_axis_off()
