"""One picture of what happened: the photograph with its edges, the map, the eye drawn from it."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw

from renderer.colour import linear_to_srgb
from renderer.unrefraction.recovery import Recovery

Pixels = npt.NDArray[np.uint8]

PANEL_PX: Final = 720
GAP_PX: Final = 12
PUPIL_COLOUR: Final = (255, 196, 0)
LIMBUS_COLOUR: Final = (0, 224, 255)
HALF_VIEW_MM: Final = 7.0  # of the eye around the limbus's centre, in the first and last panel


def draw_preview(recovery: Recovery, drawn: Pixels | None) -> Image.Image:
    """Return photograph, map and drawn eye side by side; ``drawn`` (n, n, 3) may be missing."""
    panels = [_photograph(recovery), _map(recovery)]
    if drawn is not None:
        panels.append(Image.fromarray(drawn).resize((PANEL_PX, PANEL_PX), Image.Resampling.LANCZOS))
    width = len(panels) * (PANEL_PX + GAP_PX) - GAP_PX
    sheet = Image.new("RGB", (width, PANEL_PX), (128, 128, 128))
    for number, panel in enumerate(panels):
        sheet.paste(panel, (number * (PANEL_PX + GAP_PX), 0))
    return sheet


def _photograph(recovery: Recovery) -> Image.Image:
    """Return the eye's part of the photograph with the edges of the fitted eye."""
    pose, crop = recovery.pose, recovery.crop
    half = HALF_VIEW_MM * pose.px_per_mm
    box = (pose.x - half + 0.5, pose.y - half + 0.5, pose.x + half + 0.5, pose.y + half + 0.5)
    pixels = np.rint(linear_to_srgb(np.clip(crop.pixels, 0, 1)) * 255).astype(np.uint8)
    panel = Image.fromarray(pixels).transform(
        (PANEL_PX, PANEL_PX), Image.Transform.EXTENT, box, Image.Resampling.BICUBIC
    )
    pen = ImageDraw.Draw(panel)
    for contour, colour in ((pose.pupil(), PUPIL_COLOUR), (pose.limbus(), LIMBUS_COLOUR)):
        scaled = (contour + 0.5 - [box[0], box[1]]) / (2 * half) * PANEL_PX
        line = [tuple(point) for point in scaled.tolist()]
        pen.line([*line, line[0]], fill=colour, width=2)
    return panel


def _map(recovery: Recovery) -> Image.Image:
    """Return the un-refracted colours; what was invented is outlined."""
    pixels = np.rint(linear_to_srgb(recovery.albedo) * 255).astype(np.uint8)
    panel = Image.fromarray(pixels[::-1]).resize((PANEL_PX, PANEL_PX), Image.Resampling.LANCZOS)
    shown = Image.fromarray(recovery.seen[::-1] * np.uint8(255))
    seen = np.asarray(shown.resize((PANEL_PX, PANEL_PX))) > 127
    edge = seen ^ (np.roll(seen, 1, axis=0) & np.roll(seen, 1, axis=1) & seen)
    drawn = np.asarray(panel).copy()
    drawn[edge] = (255, 64, 96)
    return Image.fromarray(drawn)
