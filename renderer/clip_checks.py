"""What a clip accepts: every fault of a ClipSpec in one sentence each. Pure."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from renderer.clip_values import CHOICES, RANGES, REFERENCE_LINES

if TYPE_CHECKING:
    from renderer.clip import ClipSpec

# Both open eyes span 62 mm between their centres and an aperture of 2.6 irises: 7.9 irises.
APPROACH_WIDTH_IRISES: Final = 7.9
_SHA256: Final = re.compile("[0-9a-f]{64}")


def clip_faults(spec: ClipSpec) -> list[str]:
    """Return what is wrong with a spec, field by field; nothing where all is right."""
    return [
        *_unknown(spec),
        *_outside(spec),
        *_environment_faults(spec),
        *_iris_faults(spec),
        *_number_faults(spec),
        *_approach_faults(spec),
        *_switching_faults(spec),
    ]


def _unknown(spec: ClipSpec) -> Iterator[str]:
    for name, accepted in CHOICES.items():
        if getattr(spec, name) not in accepted:
            listed = ", ".join(map(str, accepted))
            yield f'{name}: unknown value "{getattr(spec, name)}"; choose one of {listed}'


def _outside(spec: ClipSpec) -> Iterator[str]:
    for name, (low, high) in RANGES.items():
        if not low <= getattr(spec, name) <= high:
            yield f"{name}: {getattr(spec, name)} lies outside {low} to {high}"


def _environment_faults(spec: ClipSpec) -> Iterator[str]:
    if spec.environment != "image":
        for name in ("environment_file", "environment_sha256"):
            if getattr(spec, name):
                yield f'{name}: only an environment "image" has one; leave it empty'
        return
    if not spec.environment_file:
        yield 'environment_file: empty; an environment "image" needs a picture'
    if not _SHA256.fullmatch(spec.environment_sha256):
        yield "environment_sha256: needs the picture's SHA-256, 64 hexadecimal digits"


def _iris_faults(spec: ClipSpec) -> Iterator[str]:
    if bool(spec.iris_file) != bool(_SHA256.fullmatch(spec.iris_sha256)):
        yield (
            "iris_sha256: an iris_file needs its SHA-256, 64 hexadecimal digits; "
            "leave both empty for the iris of iris_seed and iris_colour"
        )


def _number_faults(spec: ClipSpec) -> Iterator[str]:
    if spec.subsurface_samples != 0 and not 2 <= spec.subsurface_samples <= 200:
        yield f"subsurface_samples: {spec.subsurface_samples} is neither 0 nor within 2 to 200"
    for name in ("width", "height"):
        if getattr(spec, name) % 2:
            yield (
                f"{name}: {getattr(spec, name)} is odd; H.264 in 4:2:0 needs an even number of "
                "pixels"
            )


def _approach_faults(spec: ClipSpec) -> Iterator[str]:
    if spec.motion != "approach":
        return
    largest = REFERENCE_LINES * spec.width / spec.height / APPROACH_WIDTH_IRISES
    for name in ("approach_start_px", "approach_end_px"):
        if getattr(spec, name) > largest:
            yield (
                f"{name}: {getattr(spec, name):g} is too large; one camera shows both eyes up to "
                f"an iris of {largest:.0f} pixels on {REFERENCE_LINES} lines"
            )


def _switching_faults(spec: ClipSpec) -> Iterator[str]:
    sides = [side for side in ("left", "right") if getattr(spec, f"{side}_switching") != "fixed"]
    if spec.lod_policy is None:
        for side in sides:
            yield (
                f"{side}_switching: {getattr(spec, f'{side}_switching')}; an eye that switches "
                "needs a lod_policy, such as renderer.lod.policy.default_policy()"
            )
        return
    if not sides:
        yield 'lod_policy: no eye switches; leave it out, or set left_switching to "blended"'
    for side in sides:
        if getattr(spec, side) != spec.lod_policy.finest:
            yield (
                f"{side}: an eye that switches ends at its policy's finest LoD, "
                f"{spec.lod_policy.steps[-1].lod}; give its levels"
            )
