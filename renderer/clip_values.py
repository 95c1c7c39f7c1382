"""What each field of a clip may be: its choices, or its range. Pure data.

The words are the same in study files, tables and shaders.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Final

from renderer.lod.choice import SWITCHINGS

REFERENCE_LINES: Final = 1080  # of the picture on which distances are defined
DISTANCES: Final = ("macroscopic", "near", "medium", "far")
MOTIONS: Final = ("orbit", "approach")
DIRECTIONS: Final = ("rightward", "leftward")
PRESETS: Final = ("thesis", "calibrated")
IRIS_COLOURS: Final = ("blue", "grey", "green", "hazel", "amber", "brown", "dark-brown")
ENVIRONMENTS: Final = ("park", "image")
CROWDS: Final = (0, 5, 10, 30)
CAUSTIC_PATTERNS: Final = ("computed", "painted")
CUBE_SIZES: Final = ("table", "auto")

CHOICES: Final[Mapping[str, Collection[object]]] = {
    "distance": DISTANCES,
    "motion": MOTIONS,
    "orbit_direction": DIRECTIONS,
    "preset": PRESETS,
    "iris_colour": IRIS_COLOURS,
    "environment": ENVIRONMENTS,
    "crowd": CROWDS,
    "caustic_pattern": CAUSTIC_PATTERNS,
    "cube_size": CUBE_SIZES,
    "left_switching": SWITCHINGS,
    "right_switching": SWITCHINGS,
}
RANGES: Final = {
    "orbit_deg": (0.0, 180.0),
    "duration_s": (0.03, 60.0),
    "fps": (1, 120),
    "width": (64, 7680),
    "height": (64, 4320),
    "pupil_mm": (1.5, 8.0),
    "gaze_yaw_deg": (-35.0, 35.0),
    "gaze_pitch_deg": (-35.0, 25.0),
    "vergence_deg": (0.0, 20.0),
    "blink": (0.0, 1.0),
    "environment_turn_deg": (-180.0, 180.0),
    "environment_exposure_ev": (-10.0, 10.0),
    "sun_azimuth_deg": (-180.0, 180.0),
    "sun_elevation_deg": (0.0, 90.0),
    "approach_start_px": (4.0, 400.0),
    "approach_end_px": (4.0, 400.0),
    "approach_azimuth_deg": (-60.0, 60.0),
}
