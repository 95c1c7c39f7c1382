"""ClipSpec: everything that a clip's frames depend on, and the name that follows from it.

Pure: no GL, no files. Two equal specs have equal frames on the same GL renderer and code version.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass, fields, replace
from typing import Any, Final

from renderer.clip_checks import clip_faults
from renderer.detail import Detail
from renderer.lod.choice import LodPolicy

# Where files lie: the contents' hash beside each path decides what the frames are.
PATHS: Final = ("environment_file", "iris_file")
# Fields that names do not tell while they have their defaults: clips without them keep theirs.
_LATER: Final = (
    "left_switching",
    "right_switching",
    "lod_policy",
    "approach_start_px",
    "approach_end_px",
    "approach_azimuth_deg",
    "cube_size",
)


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

    ``motion`` "approach" drives one camera, which looks midway between the eyes throughout, from
    where an iris is ``approach_start_px`` wide on 1080 lines to ``approach_end_px``; it grows by
    the same factor from frame to frame. The azimuth stays ``approach_azimuth_deg``, to the other
    side where the ``orbit_direction`` is "leftward". ``distance`` then names a group of clips.

    ``left_switching`` and ``right_switching`` say whether an eye keeps its LoD ("fixed") or takes
    it from ``lod_policy`` by its size in pixels, "blended" or in an "instant". Its own LoD is then
    the policy's finest.

    ``cube_size`` "table" mirrors cubes of each LoD's size; "auto" of no more texels than the
    cornea shows at the clip's nearest, which is quicker.
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
    left_switching: str = "fixed"
    right_switching: str = "fixed"
    lod_policy: LodPolicy | None = None
    approach_start_px: float = 12.0
    approach_end_px: float = 160.0
    approach_azimuth_deg: float = 0.0
    cube_size: str = "table"

    def __post_init__(self) -> None:
        faults = clip_faults(self)
        if faults:
            raise ValueError("; ".join(faults))

    @property
    def frame_count(self) -> int:
        """Number of frames of the clip."""
        return max(1, round(self.duration_s * self.fps))

    def azimuth_deg(self, frame: int) -> float:
        """Return the camera's azimuth in ``frame`` (0-based), linear over the orbit."""
        if self.motion == "approach":
            turn = self.approach_azimuth_deg
        elif self.frame_count == 1:
            return 0.0
        else:
            turn = self.orbit_deg * (frame / (self.frame_count - 1) - 0.5)
        return turn if self.orbit_direction == "rightward" else -turn

    def distance_px(self, frame: int) -> float | None:
        """Return how far off the camera of an approach is: as an iris's diameter on 1080 lines.

        None for an orbit, whose ``distance`` says it.
        """
        if self.motion != "approach":
            return None
        way = frame / max(1, self.frame_count - 1)
        growth: float = self.approach_end_px / self.approach_start_px
        return float(self.approach_start_px * growth**way)

    def gaze_deg(self, eye: int) -> tuple[float, float]:
        """Return yaw to the viewer's right and pitch upwards of one eye's gaze.

        ``eye`` is the viewer's left (0) or right (1); eyes converge inwards.
        """
        inwards = 0.5 - eye  # the left eye turns to the viewer's right, the right one to the left
        return self.gaze_yaw_deg + inwards * self.vergence_deg, self.gaze_pitch_deg

    def time_s(self, frame: int) -> float:
        """Return the scene's time in ``frame``: the crowd moves with it."""
        return frame / self.fps

    def swapped(self) -> ClipSpec:
        """Exchange the two eyes' LoDs in the same scene (never a flipped picture)."""
        return replace(
            self,
            left=self.right,
            right=self.left,
            left_switching=self.right_switching,
            right_switching=self.left_switching,
        )

    def resized(self, width: int, height: int) -> ClipSpec:
        """Return the same clip at another picture size in pixels."""
        return replace(self, width=width, height=height)

    def to_dict(self) -> dict[str, Any]:
        """Return the spec as plain JSON types."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> ClipSpec:
        """Read what ``to_dict`` wrote; raises TypeError for an unknown key."""
        eyes = {side: Detail(**values[side]) for side in ("left", "right")}
        policy = values.get("lod_policy")
        return cls(
            **{**values, **eyes, "lod_policy": LodPolicy.from_dict(policy) if policy else None}
        )

    @property
    def clip_id(self) -> str:
        """The clip's name: 20 hexadecimal digits of SHA-256 over everything but paths.

        Fields that came later count where they differ from their defaults.
        """
        untold = {
            field.name
            for field in fields(self)
            if field.name in _LATER and getattr(self, field.name) == field.default
        }
        values = {
            name: value for name, value in self.to_dict().items() if name not in {*PATHS, *untold}
        }
        text = json.dumps(values, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:20]
