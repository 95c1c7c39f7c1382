"""Colour an iris's relief: radial gradient, heterochromia, fibres, furrows, freckles, rim, ruff.

Works on planes (3, n, n) of linear Rec. 709; every step takes and returns such planes.
"""

from __future__ import annotations

import numpy as np

from renderer.colour import srgb_to_linear
from renderer.iris.angles import closed_noise
from renderer.iris.layout import IRIS_RADIUS_MM, Array, IrisLayout, Spots
from renderer.iris.pigment import IPE_ALBEDO, RUFF, Family
from renderer.iris.plane import HALF_SIZE_MM, Plane, blur
from renderer.iris.relief import Relief
from renderer.textures.noise import Field
from renderer.textures.sizes import smoothstep

_LUMINANCE = (0.2126, 0.7152, 0.0722)


def build_albedo(
    plane: Plane, relief: Relief, layout: IrisLayout, look: Family, seed: int
) -> Array:
    """Return the linear diffuse albedo (n, n, 3) of a relief in one colour family."""
    planes = _gradient(srgb_to_linear(look.stops), colour_position(plane, relief))
    _towards(planes, srgb_to_linear(look.core), core_share(plane, relief, look, seed))
    lift = _lightness(relief, look) + _ridge_light(plane, relief)
    planes *= _balanced_gain(plane, lift)
    _pale_crests(planes, lift, look)
    _wander(planes, plane.size_px)
    _sectors(planes, plane, relief, seed)
    for number in range(layout.freckles.radius_mm.size):
        _freckle(planes, plane, relief, spots=layout.freckles, number=number, look=look)
    _limbal_ring(planes, plane, relief)
    _pupil(planes, plane, seed)
    return np.ascontiguousarray(np.moveaxis(np.clip(planes, 0.0015, 0.95), 0, -1))


def colour_position(plane: Plane, relief: Relief) -> Field:
    """Return 0 at the pupil's edge, 2 at the collarette, 5 at the rim: where stops apply."""
    inner = (plane.radius_mm - plane.pupil_mm) / (plane.collarette_mm - plane.pupil_mm)
    outer = (plane.radius_mm - plane.collarette_mm) / (IRIS_RADIUS_MM - plane.collarette_mm)
    position = np.where(inner < 1.0, 2.0 * np.clip(inner, 0.0, 1.0), 2.0 + 3.0 * outer)
    wander = np.float32(0.18) * relief.patches + np.float32(0.16) * relief.streaks
    position = position + wander * np.clip(4.6 - position, 0.0, 1.0)
    # Openings show the deep stroma, which has the colour of the middle ciliary zone.
    deep = np.float32(0.85) * relief.deep * smoothstep(1.6, 2.1, position.astype(np.float32))
    position += np.maximum(np.float32(3.7) - position, 0.0) * deep
    return np.asarray(np.clip(position, 0.0, 5.0), np.float32)


def core_share(plane: Plane, relief: Relief, look: Family, seed: int) -> Field:
    """Return the share of the central pigment: tongues along the fibres, then flecks."""
    wavy = np.float32(1.0) + np.float32(0.22) * closed_noise(9, seed, 21)
    rng = np.random.Generator(np.random.PCG64([seed, 0xC04E]))
    share, wide = rng.uniform(0.45, 1.15), rng.uniform(0.7, 1.25)
    wavy *= np.float32(wide)
    reach = plane.around(np.maximum(look.core_mm * wavy, 0.2).astype(np.float32))
    outward = (plane.radius_mm - plane.pupil_mm) / reach
    ragged = outward + np.float32(0.26) * relief.streaks + np.float32(0.14) * relief.patches
    central = np.float32(min(look.core_share * share, 0.9)) * smoothstep(1.75, 0.15, ragged)
    flecks = smoothstep(0.7, 1.9, relief.patches + np.float32(0.6) * relief.streaks)
    flecks *= smoothstep(5.5, 4.8, plane.radius_mm)
    return np.asarray(np.maximum(central, np.float32(0.40 * look.core_share) * flecks))


def _gradient(stops: Array, position: Field) -> Array:
    at = np.arange(len(stops))
    return np.stack(
        [np.interp(position, at, stops[:, c]).astype(np.float32) for c in range(stops.shape[1])]
    )


def _towards(planes: Array, colour: Array, share: Field) -> None:
    for part, value in zip(planes, colour, strict=True):
        np.add(part, (np.float32(value) - part) * share, out=part)


def _lightness(relief: Relief, look: Family) -> Field:
    """Return the exponent of two by which tone, height and cavities lift or lower the colour."""
    f = np.float32
    lift = f(1.10) * (relief.tone - f(0.45)) + f(0.45) * (relief.height - f(0.40))
    lift += f(1.2) * relief.detail + f(1.5) * (relief.cavity - f(0.86))
    lift -= f(0.55 + 0.6 * look.veil) * relief.furrow
    lift -= f(1.15 * (1.0 - 0.4 * look.veil)) * relief.crypt
    lift *= f(look.contrast)
    lift += f(0.05) * relief.streaks + f(0.15) * relief.patches
    # Light that scatters between fibres fills gaps and evens out crests: both ends bend.
    return np.asarray(f(1.9) * np.tanh(lift * f(1.0 / 1.9)))


def _ridge_light(plane: Plane, relief: Relief) -> Field:
    """Return the lift of the collarette: paler than both zones, and darker just inside it."""
    beyond = plane.radius_mm - plane.collarette_mm
    crest = np.exp(-(((beyond - np.float32(0.02)) / np.float32(0.12)) ** 2))
    moat = np.exp(-(((beyond + np.float32(0.30)) / np.float32(0.16)) ** 2))
    broken = np.clip(np.float32(0.7) + np.float32(0.5) * relief.patches, 0.0, 1.2)
    return np.asarray((np.float32(0.32) * crest - np.float32(0.22) * moat) * broken)


def _balanced_gain(plane: Plane, lift: Field) -> Field:
    """Return 2^lift over its mean: fibres neither lighten nor darken the family's colours."""
    gain = np.exp2(lift)
    tissue = (plane.radius_mm > plane.pupil_mm + 0.1) & (plane.radius_mm < IRIS_RADIUS_MM)
    return np.asarray(gain / np.float32(gain[tissue].mean(dtype=np.float64)))


def _pale_crests(planes: Array, lift: Field, look: Family) -> None:
    """Make crests a little paler than gaps: thick stroma scatters all wavelengths."""
    grey = sum(np.float32(w) * plane for w, plane in zip(_LUMINANCE, planes, strict=True))
    pale = np.clip(np.float32(look.pallor) * (lift + np.float32(0.45)), 0.0, 0.30)
    planes += (grey - planes) * pale


def _wander(planes: Array, size_px: int) -> None:
    """Blend in the neighbourhood's mean: light that wanders inside the stroma softens it."""
    for part in planes:
        np.add(part, np.float32(0.25) * (blur(part, 0.035, size_px) - part), out=part)


def _sectors(planes: Array, plane: Plane, relief: Relief, seed: int) -> None:
    """Warm and cool the hue from sector to sector, and a little its lightness."""
    angle = closed_noise(6, seed, 41) + np.float32(0.6) * closed_noise(19, seed, 42)
    warm = plane.around(angle.astype(np.float32)) + np.float32(0.8) * relief.patches
    gain = np.exp2(np.float32(0.07) * plane.around(closed_noise(8, seed, 43)))
    # The shifts leave luminance nearly as it is.
    for part, share in zip(planes, (0.05, -0.004, -0.05), strict=True):
        np.multiply(part, gain * np.clip(1.0 + np.float32(share) * warm, 0.7, 1.3), out=part)


def _freckle(
    planes: Array, plane: Plane, relief: Relief, *, spots: Spots, number: int, look: Family
) -> None:
    x, y, radius = spots.x_mm[number], spots.y_mm[number], spots.radius_mm[number]
    scale = plane.size_px / (2.0 * HALF_SIZE_MM)
    rows, columns = (
        slice(
            max(0, int((c - 2.5 * radius + HALF_SIZE_MM) * scale)),
            max(0, int((c + 2.5 * radius + HALF_SIZE_MM) * scale) + 1),
        )
        for c in (y, x)
    )
    window = (rows, columns)
    distance = np.hypot(plane.x_mm[window] - x, plane.y_mm[window] - y) / radius
    edge = distance + 0.22 * relief.streaks[window] + 0.25 * relief.patches[window]
    share = np.float32(0.65) * smoothstep(1.3, 0.3, edge)
    tone = np.exp2(np.float32(1.2) * (relief.tone[window] - np.float32(0.45)))
    for channel, value in enumerate(srgb_to_linear(look.pigment)):
        part = planes[channel][window]
        part += (np.float32(value) * tone - part) * share


def _limbal_ring(planes: Array, plane: Plane, relief: Relief) -> None:
    soft = np.float32(0.10) * relief.patches + np.float32(0.05) * relief.streaks
    planes *= 1.0 - np.float32(0.55) * smoothstep(5.28, 5.95, plane.radius_mm + soft)


def _pupil(planes: Array, plane: Plane, seed: int) -> None:
    """Add the ruff, a beaded edge of the pigment epithelium, and the pupil inside it."""
    inside = plane.radius_mm - plane.pupil_mm
    width = np.float32(0.082) + np.float32(0.024) * closed_noise(64, seed, 31)
    width = np.maximum(width + np.float32(0.022) * closed_noise(11, seed, 33), np.float32(0.035))
    ruff = np.float32(0.92) * smoothstep(1.25, 0.75, inside / plane.around(width))
    beads = np.clip(0.62 + 0.36 * closed_noise(84, seed, 32), 0.15, 1.5).astype(np.float32)
    bead = plane.around(beads)
    hole = smoothstep(0.012, -0.012, inside)
    shade = np.float32(0.55) + np.float32(0.45) * smoothstep(0.0, 0.20, inside)
    for channel, (brown, black) in enumerate(zip(srgb_to_linear(RUFF), IPE_ALBEDO, strict=True)):
        part = planes[channel]
        part += (brown * bead - part) * ruff
        part *= shade
        part += (np.float32(black) - part) * hole
