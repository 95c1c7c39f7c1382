"""What the options of one picture come to: a clip's spec, and the camera's place in it."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from study.commands.errors import CommandError
from study.commands.values import reading

if TYPE_CHECKING:
    from renderer.clip import ClipSpec
    from renderer.detail import Detail
    from renderer.lod.choice import LodPolicy

SIDES: Final = ("left", "right")


def spec_of(options: argparse.Namespace) -> ClipSpec:
    """Return the spec that the options describe; raises ValueError for what no clip accepts."""
    from renderer.clip import ClipSpec

    width, height = options.size
    optional: dict[str, Any] = {
        "pupil_mm": options.pupil,
        "crowd": options.crowd,
        "preset": options.preset,
    }
    optional |= _surroundings(options)
    if options.sun:
        optional["sun_azimuth_deg"], optional["sun_elevation_deg"] = options.sun
    spec = ClipSpec(
        left=detail_of(options.left, "left", options.effect, options.only_effect),
        right=detail_of(options.right, "right", options.effect, options.only_effect),
        distance=options.distance,
        width=width,
        height=height,
        gaze_yaw_deg=options.gaze[0],
        gaze_pitch_deg=options.gaze[1],
        vergence_deg=options.vergence,
        blink=options.blink,
        subsurface_samples=options.subsurface_samples,
        caustic_pattern=options.caustic_pattern,
        cube_size=options.cube_size,
    )
    given = {name: value for name, value in optional.items() if value is not None}
    return replace(spec, **options.iris, **given)


def viewpoint_of(options: argparse.Namespace, spec: ClipSpec) -> dict[str, float]:
    """Return the camera's azimuth and elevation in degrees and the scene's time in s."""
    if options.frame is None:
        return {
            "azimuth_deg": options.azimuth,
            "elevation_deg": options.elevation,
            "time_s": 0.0,
        }
    if options.frame > spec.frame_count:
        raise CommandError(f"--frame {options.frame}: the clip has frames 1 to {spec.frame_count}")
    frame = options.frame - 1
    return {
        "azimuth_deg": spec.azimuth_deg(frame),
        "elevation_deg": options.elevation,
        "time_s": spec.time_s(frame),
    }


def policy_of(path: Path | None) -> LodPolicy:
    """Return the policy of a file, Ocularist's own without one."""
    from renderer.lod.policy import default_policy, read_policy

    if path is None:
        return default_policy()
    try:
        return read_policy(path).policy
    except OSError as error:
        raise CommandError(f"--lod-policy: {path}: {error.strerror}") from None
    except ValueError as error:
        raise CommandError(f"--lod-policy: {error}") from None


def _surroundings(options: argparse.Namespace) -> dict[str, Any]:
    """Return the spec's fields of a picture that surrounds the face."""
    if options.environment is None:
        for name in ("environment_turn", "environment_exposure"):
            if getattr(options, name) is not None:
                option = name.replace("_", "-")
                raise CommandError(f"--{option}: only a picture has one; give --environment FILE")
        return {}
    if options.sun:
        raise CommandError(
            f"--sun: {options.environment} brings its own sun; turn it with --environment-turn"
        )
    from study.design.files import contents_sha256

    path = options.environment.absolute()
    return {
        "environment": "image",
        "environment_file": str(path),
        "environment_sha256": contents_sha256(path),
        "environment_turn_deg": options.environment_turn,
        "environment_exposure_ev": options.environment_exposure,
    }


def detail_of(
    lod: str,
    side: str,
    effects: Sequence[tuple[tuple[str, ...], str, str]],
    only: Sequence[str],
) -> Detail:
    """Return one eye's levels: a LoD, some effects at other levels, then those to keep."""
    from renderer.detail import Detail

    levels = {name: level for sides, name, level in effects if side in sides}
    detail = Detail.uniform(lod).with_levels(**levels)
    if not only:
        return detail
    kept = [detail.only(name).levels()[name] for name in only]
    return Detail(**dict(zip(only, kept, strict=True)))


@reading
def effect_level(text: str) -> tuple[tuple[str, ...], str, str]:
    """Read ``reflection=low`` or ``left.reflection=low``: sides, effect, level."""
    from renderer.detail import check_effect, check_level

    match = re.fullmatch(r"(?:(left|right)\.)?([a-z]+)=([a-z]+)", text)
    if not match:
        raise ValueError(
            f'"{text}" is no effect with a level; write NAME=LEVEL, as in reflection=low, or '
            "left.NAME=LEVEL"
        )
    side, effect, level = match.groups()
    check_effect(effect)
    check_level(effect, level)
    return (side,) if side else SIDES, effect, level


@reading
def iris(text: str) -> dict[str, Any]:
    """Read ``7``, ``brown``, ``7:brown`` or an iris file as the fields of a clip's spec."""
    from renderer.clip_values import IRIS_COLOURS

    if text.endswith(".npz"):
        return _iris_file(Path(text))
    seed, _, colour = text.partition(":") if ":" in text or text.isdecimal() else ("", "", text)
    if (seed and not seed.isdecimal()) or (colour and colour not in IRIS_COLOURS):
        raise ValueError(
            f'"{text}" is no iris; write a seed, a colour, SEED:COLOUR or the path of an iris file '
            "(.npz), with a colour of " + ", ".join(IRIS_COLOURS)
        )
    fields: dict[str, Any] = {"iris_colour": colour} if colour else {}
    return fields | ({"iris_seed": int(seed)} if seed else {})


def _iris_file(path: Path) -> dict[str, Any]:
    """Return the fields of an iris that ``ocularist iris`` has taken from a photograph."""
    from study.design.files import contents_sha256

    try:
        sha256 = contents_sha256(path)
    except OSError as error:
        raise ValueError(
            f"{path}: {error.strerror}; ocularist iris PHOTO writes an iris file"
        ) from None
    return {"iris_file": str(path.absolute()), "iris_sha256": sha256}
