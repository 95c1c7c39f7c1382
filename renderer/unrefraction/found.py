"""What was found in a photograph, as plain JSON: ellipses, pupil, gaze, scale, warnings."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from renderer.unrefraction.photograph import Photograph
from renderer.unrefraction.pose import TELECENTRIC_MM
from renderer.unrefraction.sighting import Sighting


def describe(photograph: Photograph, sighting: Sighting, *, share: float) -> dict[str, Any]:
    """Return what a sighting says; ``share`` of the iris was seen."""
    pose, crop, edges = sighting.pose, sighting.crop, sighting.edges
    warnings = list(photograph.notes)
    if pose.distance_mm > 0.5 * TELECENTRIC_MM:
        warnings.append("no focal length in the file: taken from far away (--focal, --distance)")
    if share < 0.75:
        warnings.append(f"{1 - share:.0%} of the iris was hidden and is invented")
    px = pose.px_per_mm * crop.factor
    if px * 11.7 < 700:
        warnings.append(f"the iris is {px * 11.7:.0f} pixels wide: too coarse for single fibres")
    ellipses = {}
    for name, edge in (("limbus", edges.limbus), ("pupil", edges.pupil)):
        centre = crop.to_photograph(np.array([edge.ellipse.x, edge.ellipse.y]))
        ellipses[name] = {
            "x_px": round(float(centre[0]), 2),
            "y_px": round(float(centre[1]), 2),
            "major_px": round(edge.ellipse.major * crop.factor, 2),
            "minor_px": round(edge.ellipse.minor * crop.factor, 2),
            "angle_deg": round(math.degrees(edge.ellipse.angle), 1),
            "rays": round(edge.share, 3),
        }
    return {
        "photograph": photograph.name,
        "size_px": [photograph.pixels.shape[1], photograph.pixels.shape[0]],
        "ellipses": ellipses,
        "px_per_mm": round(px, 3),
        "pupil_apparent_mm": round(2 * edges.pupil.ellipse.radius / pose.px_per_mm, 3),
        "pupil_true_mm": round(2 * pose.pupil_mm, 3),
        "pupil_decentre_mm": [round(pose.pupil_x_mm, 3), round(pose.pupil_y_mm, 3)],
        "gaze_yaw_deg": round(math.degrees(pose.yaw), 2),
        "gaze_pitch_deg": round(math.degrees(pose.pitch), 2),
        "tilt_deg": round(pose.tilt_deg, 2),
        "roll_deg": round(math.degrees(pose.roll), 2),
        "distance_mm": round(pose.distance_mm, 1),
        "iris_seen": round(share, 3),
        "warnings": warnings,
    }
