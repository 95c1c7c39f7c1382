"""The thin skin of the lids as a map of its own: crepe, crow's feet, orifices, capillaries.

Pure numpy. The map's axes run around the fissure and across the skin (``lid_layout``), so that
wrinkles follow the lid by themselves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.body.makehuman import Floats
from renderer.head.lid_layout import (
    ACROSS_MM,
    MAP_PX,
    Layout,
    from_outer_canthus,
    lay_out,
    tangent_slopes,
)
from renderer.head.skin_part import SkinPart
from renderer.textures.easing import ease
from renderer.textures.micro_relief import Net, Tile, net_relief, periodic_noise

JUNCTION_MM: Final = 0.62  # of skin and mucous membrane, from the lid's inner edge
ORIFICES_MM: Final = 0.30  # of the meibomian glands, beyond the junction
SLOPE_RANGE: Final = 0.8  # stored slopes run from minus to plus this
LINES: Final = Tile(32.0, 1024)
NETS: Final = (
    Net(cells=(58, 66), depth_mm=0.017, width_mm=0.085, bend_mm=0.12, tilt=0.05),
    Net(cells=(104, 120), depth_mm=0.009, width_mm=0.055, bend_mm=0.07, tilt=0.04),
)


def lid_map(
    patches: tuple[SkinPart, SkinPart],
    *,
    edges_mm: tuple[Floats, Floats],
    upper: tuple[Floats, Floats],
) -> npt.NDArray[np.uint8]:
    """Return the map of both eyes, (2 across, around, 4) uint8.

    Red and green: slope along the skin's horizontal and upright tangent (0.5 flat, SLOPE_RANGE);
    blue: how open the relief lies; alpha: blood (0.5 average). ``edges_mm`` (around,) say where
    the lids' outer edges lie across, ``upper`` (around,) which lid it is, 0 lower to 1 upper.
    """
    rng = np.random.Generator(np.random.PCG64(23))
    sources = _sources(rng)
    maps = [
        _eye_map(lay_out(part, eye, edge=edges_mm[eye], upper=upper[eye]), sources, eye)
        for eye, part in enumerate(patches)
    ]
    return np.concatenate(maps)


@dataclass(frozen=True)
class _Sources:
    """Periodic pictures that all layers are cut from: lines along x, a net, two noises."""

    lines: Floats
    net: Floats
    noise: Floats
    coarse: Floats


def _sources(rng: np.random.Generator) -> _Sources:
    """Draw what both eyes share, on LINES."""
    net = np.asarray(sum(net_relief(rng, LINES, net) for net in NETS))
    return _Sources(
        _line_noise(rng, spacing_mm=0.8, length_mm=2.6),
        net - net.mean(),
        periodic_noise(rng, LINES, 0.22),
        periodic_noise(rng, LINES, 1.1),
    )


def _line_noise(rng: np.random.Generator, *, spacing_mm: float, length_mm: float) -> Floats:
    """Return noise of unit variance made of lines along x that come and go."""
    fy = np.fft.fftfreq(LINES.edge_px, LINES.texel_mm)[:, None]
    fx = np.fft.rfftfreq(LINES.edge_px, LINES.texel_mm)[None, :]
    gain = np.exp(-(((np.abs(fy) * spacing_mm - 1) / 0.45) ** 2) - (fx * length_mm) ** 2)
    spectrum = np.fft.rfft2(rng.standard_normal((LINES.edge_px, LINES.edge_px))) * gain
    field = np.fft.irfft2(spectrum, s=(LINES.edge_px, LINES.edge_px))
    return np.asarray(field / field.std())


def _sample(picture: Floats, x_mm: Floats, y_mm: Floats) -> Floats:
    """Read a periodic picture on LINES bilinearly at places in mm."""
    at = np.stack([y_mm, x_mm]) / LINES.texel_mm
    return np.asarray(ndimage.map_coordinates(picture, at, order=1, mode="grid-wrap"))


def _eye_map(place: Layout, sources: _Sources, eye: int) -> npt.NDArray[np.uint8]:
    height = _height(place, sources, eye)
    slope_x, slope_y = tangent_slopes(height, place)
    texel = ACROSS_MM / MAP_PX[0]
    near = ndimage.gaussian_filter(height, 0.28 / texel, mode=("nearest", "wrap"))
    openness = np.clip(1.0 - np.maximum(near - height, 0.0) / 0.07, 0.0, 1.0)
    layers = [
        0.5 + slope_x * (0.5 / SLOPE_RANGE),
        0.5 + slope_y * (0.5 / SLOPE_RANGE),
        openness,
        0.5 + 0.12 * _blood(place, sources, eye),
    ]
    return np.stack(
        [np.clip(np.rint(layer * 255), 0, 255).astype(np.uint8) for layer in layers], -1
    )


def _groove(noise: Floats, *, share: float, steep: float = 3.2) -> Floats:
    """Turn noise of unit variance into grooves 0 to 1 where it exceeds ``share``."""
    return np.asarray(1.0 / (1.0 + np.exp(-steep * (noise - share))))


def _height(place: Layout, sources: _Sources, eye: int) -> Floats:
    """Return the relief in mm."""
    shift = 13.7 * eye
    lines, s, w = sources.lines, 1.25 * place.around, place.across
    wander = 0.5 * _sample(sources.coarse, 0.9 * place.flat[0] + shift, 0.9 * place.flat[1])
    radius, angle = from_outer_canthus(place)
    fan = np.exp(-((angle / 1.25) ** 4)) * ease((radius - 0.8) / 2.5) * (place.x > 10.0)
    lid = 1.0 - fan
    skin = ease((place.beyond + 0.25) / 0.5)
    plate = upper_plate(place)

    def crepe(scale: float, turn: float, *, share: float, seed: float) -> Floats:
        c, t = np.cos(turn), np.sin(turn)
        u, v = s * c - w * t, w * c + s * t + wander * min(scale, 0.5)
        return _groove(_sample(lines, u / scale + seed + shift, v / scale), share=share)

    upper, lower = place.upper, 1.0 - place.upper
    fine, middle = crepe(0.42, 0.0, share=0.5, seed=3.0), crepe(0.9, 0.0, share=0.7, seed=9.0)
    rising, falling = crepe(0.6, 0.5, share=0.6, seed=17.0), crepe(0.62, -0.55, share=0.6, seed=1.0)
    furrow = crepe(2.1, -0.16, share=0.9, seed=21.0)
    height = -upper * lid * (0.017 * fine + 0.020 * middle + 0.012 * (rising + falling))
    height -= lower * lid * (0.011 * fine + 0.016 * middle + 0.017 * falling + 0.008 * rising)
    height -= lower * lid * 0.045 * furrow * ease((place.beyond - 2.0) / 3.0)
    feet = _sample(lines, radius / 2.2 + 5.0 + shift, angle * 5.0 + 0.12 * wander)
    rings = _groove(_sample(lines, angle * 12.0 + shift, radius / 0.5), share=0.6)
    height -= fan * (0.060 * _groove(feet, share=0.9, steep=1.9) + 0.008 * rings)
    net = _sample(sources.net, place.flat[0] + shift, place.flat[1])
    height += (0.85 * upper + 0.95 * lower) * net
    # Between lashes and crease the skin lies loose on the tarsus: the finest crepe of all.
    tiny = crepe(0.26, 0.06, share=0.4, seed=29.0)
    height -= plate * (0.011 * tiny + 0.014 * fine + 0.012 * (rising + falling))
    grain = _sample(sources.noise, s * 4.0 + shift, w * 4.0)
    height += 0.0022 * grain
    return np.asarray(height * skin + (1 - skin) * _margin_relief(place, sources, shift))


def _margin_relief(place: Layout, sources: _Sources, shift: float) -> Floats:
    """Return the lid margin's relief in mm: soft folds across it and a row of glands' openings."""
    soft = 0.015 * _sample(sources.noise, 0.9 * place.around + shift, 0.55 * place.across)
    fine = 0.004 * _sample(sources.noise, 2.6 * place.around - shift, 2.2 * place.across)
    groove = 0.012 * np.exp(-((_from_junction(place, sources, shift) / 0.10) ** 2))
    return np.asarray(soft + fine - groove - 0.026 * _orifices(place))


def upper_plate(place: Layout) -> Floats:
    """Return how much a place belongs to the upper lid's skin between lashes and crease, 0 to 1."""
    return place.upper * ease(place.beyond / 0.4) * ease((3.6 - place.beyond) / 1.8)


def _from_junction(place: Layout, sources: _Sources, shift: float) -> Floats:
    """Return the way in mm from the mucocutaneous line, where skin ends and mucous membrane begins.

    It runs a little unevenly behind the glands' openings.
    """
    wander = 0.05 * _sample(sources.noise, 0.35 * place.around + shift, 0.0 * place.across)
    return np.asarray(place.across - JUNCTION_MM - wander)


def _orifices(place: Layout) -> Floats:
    """Return the meibomian glands' openings 0 to 1: one a mm, in front of the wet edge."""
    number = np.round(place.around / 1.05)
    jitter = np.sin(number * 12.9898) * 0.22
    along = place.around - number * 1.05 - jitter
    across = place.across - JUNCTION_MM - ORIFICES_MM - 0.08 * np.sin(number * 78.233)
    clear = ease((place.x + 12.5) / 2.0) * ease((11.0 - place.x) / 2.0)  # of the canthi
    return np.asarray(clear * np.exp(-(along**2 + across**2) / 0.10**2))


def _blood(place: Layout, sources: _Sources, eye: int) -> Floats:
    """Return the blood in the skin about its mean: blotches and fine vessels in patches."""
    shift = 7.3 + 11.9 * eye
    x, y = place.flat
    blotches = _sample(sources.coarse, 0.8 * x + shift, 0.8 * y)
    fine = _sample(sources.coarse, 2.6 * x + 3 * shift, 2.6 * y)
    contour = _sample(sources.coarse, 1.15 * x - shift, 1.15 * y)
    vessels = np.exp(-((contour / 0.07) ** 2)) * ease(blotches * 0.6 + 0.25)
    veined = 1.2 + 1.3 * place.upper
    blood = 0.5 * blotches + 0.4 * fine + veined * vessels
    blood += upper_plate(place) * (0.5 * blotches + 0.5 * fine)
    return np.asarray(blood + _margin_blood(place, sources, shift))


def _margin_blood(place: Layout, sources: _Sources, shift: float) -> Floats:
    """Return the blood in the lid margin: the red mucocutaneous line, specks, fine vessels."""
    on_margin = ease(0.5 - place.beyond / 0.5)
    line = np.exp(-((_from_junction(place, sources, shift) / 0.13) ** 2))
    patchy = 0.75 + 0.35 * _sample(sources.noise, 0.3 * place.around - shift, 0.3 * place.across)
    specks = _sample(sources.noise, 0.8 * place.around + shift, 0.6 * place.across)
    # Fine vessels run across the margin.
    at = _sample(sources.noise, 0.45 * place.around + 2 * shift, 0.10 * place.across)
    vessels = np.exp(-((at / 0.10) ** 2)) * ease(0.5 + 0.8 * specks)
    pores = _orifices(place)
    return np.asarray(on_margin * (3.3 * line * patchy + 1.2 * specks + 1.2 * vessels + pores))
