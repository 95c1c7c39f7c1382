"""ClipSpec: everything that a clip's frames depend on, and the name that follows from it.

Pure: no GL, no files. Two equal specs have equal frames on the same GL renderer and code version.
"""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import asdict, dataclass, replace
from typing import Any, Final

from renderer.detail import Detail

DISTANCES: Final = ("macroscopic", "near", "medium", "far")
MOTIONS: Final = ("orbit",)
DIRECTIONS: Final = ("rightward", "leftward")
PRESETS: Final = ("thesis", "calibrated")
IRIS_COLOURS: Final = ("blue", "grey", "green", "hazel", "amber", "brown", "dark-brown")
ENVIRONMENTS: Final = ("park", "image")
CROWDS: Final = (0, 5)
CAUSTIC_PATTERNS: Final = ("computed", "painted")
# Where files lie: the contents' hash beside each path decides what the frames are.
PATHS: Final = ("environment_file", "iris_file")


@dataclass(frozen=True, kw_only=True)
class ClipSpec:
    """One clip: two eyes, a camera path, light, surroundings, size and rate.

    Left and right are the viewer's, as seen on the screen. Angles are in degrees: azimuth 0 faces
    the character, positive azimuths lie to the viewer's right, elevation is above the horizon.
    ``orbit_direction`` "rightward" runs from ``-orbit_deg / 2`` to ``+orbit_deg / 2``.
    ``vergence_deg`` is the angle between the two gazes, 0 for parallel eyes; ``blink`` how far the
    lids are closed, 0 open to 1 shut. ``subsurface_samples`` and ``caustic_pattern`` take the
    thesis's own forms of two effects, for comparison: 0 integrates the layers our way, 2 to 200 is
    its left-endpoint sum with so many samples; "painted" is its artist's caustic map.

    ``environment`` "image" is a lat-long HDR picture: ``environment_file`` its path,
    ``environment_sha256`` its contents, ``environment_turn_deg`` turns it to the viewer's right,
    ``environment_exposure_ev`` brightens it in stops. It brings its own sun: the sun's angles
    then decide nothing. The clip's name follows from the contents, never from the path.

    ``iris_file`` is an iris taken from a photograph (``renderer.iris.file``), ``iris_sha256`` its
    contents. ``iris_colour`` then decides nothing and ``iris_seed`` the sclera alone.
    """

    left: Detail
    right: Detail
    distance: str = "macroscopic"
    motion: str = "orbit"
    orbit_deg: float = 120.0
    orbit_direction: str = "rightward"
    duration_s: float = 5.0
    fps: int = 30
    width: int = 1920
    height: int = 1080
    preset: str = "thesis"
    iris_seed: int = 1
    iris_colour: str = "blue"
    iris_file: str = ""
    iris_sha256: str = ""
    pupil_mm: float = 4.0
    gaze_yaw_deg: float = 0.0
    gaze_pitch_deg: float = 0.0
    vergence_deg: float = 0.0
    blink: float = 0.0
    environment: str = "park"
    environment_file: str = ""
    environment_sha256: str = ""
    environment_turn_deg: float = 0.0
    environment_exposure_ev: float = 0.0
    sun_azimuth_deg: float = -15.0
    sun_elevation_deg: float = 42.0
    crowd: int = 5
    subsurface_samples: int = 0
    caustic_pattern: str = "computed"

    def __post_init__(self) -> None:
        faults = self._faults()
        if faults:
            raise ValueError("; ".join(faults))

    def _faults(self) -> list[str]:
        choices = {
            "distance": DISTANCES,
            "motion": MOTIONS,
            "orbit_direction": DIRECTIONS,
            "preset": PRESETS,
            "iris_colour": IRIS_COLOURS,
            "environment": ENVIRONMENTS,
            "crowd": CROWDS,
            "caustic_pattern": CAUSTIC_PATTERNS,
        }
        ranges = {
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
        }
        faults = [
            f'{name}: unknown value "{getattr(self, name)}"; choose one of '
            + ", ".join(map(str, accepted))
            for name, accepted in choices.items()
            if getattr(self, name) not in accepted
        ]
        faults += [
            f"{name}: {getattr(self, name)} lies outside {low} to {high}"
            for name, (low, high) in ranges.items()
            if not low <= getattr(self, name) <= high
        ]
        faults += self._environment_faults()
        if bool(self.iris_file) != bool(re.fullmatch("[0-9a-f]{64}", self.iris_sha256)):
            faults.append(
                "iris_sha256: an iris_file needs its SHA-256, 64 hexadecimal digits; "
                "leave both empty for the iris of iris_seed and iris_colour"
            )
        if self.subsurface_samples != 0 and not 2 <= self.subsurface_samples <= 200:
            faults.append(
                f"subsurface_samples: {self.subsurface_samples} is neither 0 nor within 2 to 200"
            )
        faults += [
            f"{name}: {getattr(self, name)} is odd; H.264 in 4:2:0 needs an even number of pixels"
            for name in ("width", "height")
            if getattr(self, name) % 2
        ]
        return faults

    def _environment_faults(self) -> list[str]:
        given = {
            "environment_file": self.environment_file,
            "environment_sha256": self.environment_sha256,
        }
        if self.environment != "image":
            return [
                f'{name}: only an environment "image" has one; leave it empty'
                for name, value in given.items()
                if value
            ]
        faults = []
        if not self.environment_file:
            faults.append('environment_file: empty; an environment "image" needs a picture')
        if not re.fullmatch("[0-9a-f]{64}", self.environment_sha256):
            faults.append("environment_sha256: needs the picture's SHA-256, 64 hexadecimal digits")
        return faults

    @property
    def frame_count(self) -> int:
        """Number of frames of the clip."""
        return max(1, round(self.duration_s * self.fps))

    def azimuth_deg(self, frame: int) -> float:
        """Return the camera's azimuth in ``frame`` (0-based), linear over the orbit."""
        if self.frame_count == 1:
            return 0.0
        turn = self.orbit_deg * (frame / (self.frame_count - 1) - 0.5)
        return turn if self.orbit_direction == "rightward" else -turn

    def time_s(self, frame: int) -> float:
        """Return the scene's time in ``frame``: the crowd moves with it."""
        return frame / self.fps

    def swapped(self) -> ClipSpec:
        """Exchange the two eyes' LoDs in the same scene (never a flipped picture)."""
        return replace(self, left=self.right, right=self.left)

    def resized(self, width: int, height: int) -> ClipSpec:
        """Return the same clip at another picture size in pixels."""
        return replace(self, width=width, height=height)

    def to_dict(self) -> dict[str, Any]:
        """Return the spec as plain JSON types."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> ClipSpec:
        """Read what ``to_dict`` wrote; raises TypeError for an unknown key."""
        return cls(
            **{**values, "left": Detail(**values["left"]), "right": Detail(**values["right"])}
        )

    @property
    def clip_id(self) -> str:
        """The clip's name: 20 hexadecimal digits of SHA-256 over everything but paths."""
        values = {name: value for name, value in self.to_dict().items() if name not in PATHS}
        text = json.dumps(values, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:20]
