"""Houses on the panorama: facades that face the viewer. Pure numpy."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from renderer.park.panorama import EYE_HEIGHT_M, Panorama, texels_around, to_world


@dataclass(frozen=True)
class Building:
    """One facade that faces the viewer, with floors of windows and a pitched roof."""

    azimuth_deg: float
    distance_m: float
    width_m: float
    floors: int
    wall: tuple[float, float, float]
    roof: tuple[float, float, float]


def paint_building(panorama: Panorama, building: Building, rng: np.random.Generator) -> None:
    """Paint one facade: plinth, rows of framed windows, cornice and a pitched roof."""
    eaves = building.floors * 3.3 + 1.0
    ridge = eaves + 3.4
    half_width = math.degrees(math.atan2(building.width_m / 2, building.distance_m))
    low = math.degrees(math.atan2(-EYE_HEIGHT_M, building.distance_m))
    high = math.degrees(math.atan2(ridge - EYE_HEIGHT_M, building.distance_m))
    window, u, v = texels_around(
        building.azimuth_deg, (low + high) / 2, half_width=half_width, half_height=(high - low) / 2
    )
    along = np.tan(np.radians(u)) * building.distance_m  # metres on the facade
    reach = building.distance_m / np.cos(np.radians(u))
    up = np.tan(np.radians(v + (low + high) / 2)) * reach + EYE_HEIGHT_M
    bay, floor = along / 2.6, (up - 1.0) / 3.3
    across, rise = bay - np.floor(bay), floor - np.floor(floor)
    is_wall = up < eaves
    frame = is_wall & (np.abs(across - 0.5) < 0.27) & (np.abs(rise - 0.52) < 0.33) & (floor > 0)
    pane = frame & (np.abs(across - 0.5) < 0.22) & (np.abs(rise - 0.52) < 0.29)
    pane &= (np.abs(across - 0.5) > 0.018) & (np.abs(rise - 0.62) > 0.012)
    hash_of_window = np.sin(
        np.floor(bay) * 12.9898 + np.floor(floor) * 78.233 + building.azimuth_deg
    )
    curtain = pane & (hash_of_window > 0.45)
    albedo = np.where(is_wall[..., None], building.wall, building.roof).astype(np.float32)
    albedo *= (1 - 0.25 * (np.abs(up - eaves) < 0.18))[..., None]
    albedo[frame] = 0.66, 0.65, 0.62
    albedo[pane] = 0.025, 0.028, 0.03
    albedo[curtain] = 0.30, 0.29, 0.27
    albedo *= rng.uniform(0.95, 1.05, (1, 1, 1)).astype(np.float32)
    local = np.zeros((*u.shape, 3))
    local[..., 2] = 1.0
    local[~is_wall] = 0.0, 0.6, 0.8
    openness = np.clip(0.55 + 0.05 * up, 0.5, 0.9)[..., None]
    slope = np.clip((ridge - up) / 0.1, 0, 1)
    mask = np.clip((building.width_m / 2 - np.abs(along)) / 0.1, 0, 1) * slope
    normal = to_world(local, building.azimuth_deg) * openness
    panorama.paint(
        window, mask.astype(np.float32), albedo=albedo, normal=normal, glass=pane.astype(np.float32)
    )
