"""What the parts of a study file share: strict models, names, and values that a clip accepts.

The renderer decides which values a clip accepts (``renderer.clip``); this module only asks it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any, Final, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PlainSerializer,
    model_validator,
)

from renderer.clip import ClipSpec
from renderer.clip_values import ENVIRONMENTS
from renderer.detail import Detail
from study.design.faults import refuse

NAME_PATTERN: Final = r"[a-z0-9]([a-z0-9_-]*[a-z0-9])?"


class Part(BaseModel):
    """A table of the study file: frozen, and a key that it does not know is a fault."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _check_name(name: str) -> str:
    if len(name) > 60 or not re.fullmatch(NAME_PATTERN, name):
        raise refuse(
            f'"{name}" is no name; use 1 to 60 lower-case letters, digits, "-" and "_", '
            "with a letter or digit at either end"
        )
    return name


def _check_text(text: str) -> str:
    if not text.strip():
        raise refuse("empty; write some text or leave the key out")
    return text


@dataclass(frozen=True)
class Translated:
    """Marks words that participants read: a translation of the study has to hold them."""

    is_needed: bool = True


Name = Annotated[str, AfterValidator(_check_name)]
# Words that participants read; ``MaybeText`` may be empty, ``NameText`` may stay as it is.
Text = Annotated[str, AfterValidator(_check_text), Translated()]
MaybeText = Annotated[str, Translated()]
NameText = Annotated[str, AfterValidator(_check_text), Translated(is_needed=False)]
StoredText = Annotated[str, AfterValidator(_check_text)]  # not read by participants
Whole = Annotated[int, Field(strict=True)]
Real = Annotated[float, Field(strict=True)]
Flag = Annotated[bool, Field(strict=True)]


class _AcceptedByClip:
    """Check one value by building a clip that differs from the default in this value alone."""

    def __init__(self, field: str) -> None:
        self.field = field

    def __call__(self, value: Any) -> Any:
        try:
            ClipSpec(left=Detail(), right=Detail(), **{self.field: value})
        except ValueError as error:
            raise refuse(str(error).removeprefix(f"{self.field}: ")) from None
        return value


def clip_value(field: str) -> AfterValidator:
    """Return the validator for a value that becomes ``ClipSpec.field``."""
    return AfterValidator(_AcceptedByClip(field))


Distance = Annotated[str, clip_value("distance")]
Direction = Annotated[str, clip_value("orbit_direction")]
Motion = Annotated[str, clip_value("motion")]
People = Annotated[Whole, clip_value("crowd")]


class Size(Part):
    """A picture's size in pixels, written ``"1280x720"``."""

    width: int
    height: int

    def __str__(self) -> str:
        return f"{self.width}x{self.height}"

    def __hash__(self) -> int:
        return hash((self.width, self.height))


def read_size(text: str) -> Size:
    """Read ``"1280x720"``; raises ValueError saying what is accepted."""
    match = re.fullmatch(r"(\d{2,5})x(\d{2,5})", text.strip())
    if not match:
        raise ValueError(f'"{text}" is no size; write width x height in pixels, like "1280x720"')
    width, height = int(match[1]), int(match[2])
    ClipSpec(left=Detail(), right=Detail(), width=width, height=height)
    if width % 4:
        # At macroscopic distance each eye has half the width, and half frames have to be even too.
        raise ValueError(
            f"width: {width} cannot be halved into two even views; use a multiple of 4"
        )
    return Size(width=width, height=height)


def _size_from_file(value: Any) -> Size:
    if isinstance(value, Size):
        return value
    if not isinstance(value, str):
        raise refuse(f'{value!r} is no size; write width x height in pixels, like "1280x720"')
    try:
        return read_size(value)
    except ValueError as error:
        raise refuse(str(error)) from None


SizeText = Annotated[Size, BeforeValidator(_size_from_file), PlainSerializer(str, return_type=str)]


class Orbit(Part):
    """The camera's path: one linear turn around the eyes; every direction is a factor's level."""

    orbit_deg: Annotated[Real, clip_value("orbit_deg")] = 120.0
    duration_s: Annotated[Real, clip_value("duration_s")] = 5.0
    fps: Annotated[Whole, clip_value("fps")] = 30
    directions: Annotated[tuple[Direction, ...], Field(min_length=1)] = ("rightward", "leftward")


class _PartOfClip(Part):
    """Values that together must make a clip."""

    @model_validator(mode="after")
    def _accepted_by_clip(self) -> Self:
        try:
            ClipSpec(left=Detail(), right=Detail(), **self.model_dump())
        except ValueError as error:
            raise refuse(str(error)) from None
        return self


class Eye(_PartOfClip):
    """What both eyes share, so that a pairing differs in its LoDs alone."""

    iris_seed: Annotated[Whole, Field(ge=0)] = 1
    iris_colour: Annotated[str, clip_value("iris_colour")] = "blue"
    iris_file: str = ""
    iris_sha256: str = ""
    pupil_mm: Annotated[Real, clip_value("pupil_mm")] = 4.0
    gaze_yaw_deg: Annotated[Real, clip_value("gaze_yaw_deg")] = 0.0
    gaze_pitch_deg: Annotated[Real, clip_value("gaze_pitch_deg")] = 0.0
    vergence_deg: Annotated[Real, clip_value("vergence_deg")] = 0.0
    blink: Annotated[Real, clip_value("blink")] = 0.0
    subsurface_samples: Annotated[Whole, clip_value("subsurface_samples")] = 0
    caustic_pattern: Annotated[str, clip_value("caustic_pattern")] = "computed"
    cube_size: Annotated[str, clip_value("cube_size")] = "table"


def _check_environment(name: str) -> str:
    if name not in ENVIRONMENTS:
        raise refuse(
            f'unknown environment "{name}"; write "park", or the path of a latitude-longitude HDR '
            "picture (.exr or .hdr) beside the study file"
        )
    return name


class Scene(_PartOfClip):
    """Surroundings, sun and the other characters that the cornea reflects."""

    environment: Annotated[str, AfterValidator(_check_environment)] = "park"
    environment_file: str = ""
    environment_sha256: str = ""
    environment_turn_deg: Annotated[Real, clip_value("environment_turn_deg")] = 0.0
    environment_exposure_ev: Annotated[Real, clip_value("environment_exposure_ev")] = 0.0
    sun_azimuth_deg: Annotated[Real, clip_value("sun_azimuth_deg")] = -15.0
    sun_elevation_deg: Annotated[Real, clip_value("sun_elevation_deg")] = 42.0
    crowd: People = 5
