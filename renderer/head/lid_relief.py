"""The thin skin of the lids as a map of its own: crepe, crow's feet, orifices, capillaries.

Pure numpy. Both eyes' maps lie on top of each other in one picture. Along u runs the way around the
fissure (from the temple over the upper lid), along v the way across the skin from the lid's inner
edge, so that wrinkles follow the lid by themselves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.body.makehuman import Floats
from renderer.head.face_mesh import SkinPart, to_patch
from renderer.head.lid_rims import LATERAL_MM
from renderer.textures.micro_relief import Net, Tile, net_relief, periodic_noise

AROUND_MM: Final = 68.0  # what the patches' first coordinate runs over
ACROSS_MM: Final = 17.0
MAP_PX: Final = (512, 2048)  # of one eye: across, around; 30 texels a mm at the rim
SLOPE_RANGE: Final = 0.8  # stored slopes run from minus to plus this
LINES: Final = Tile(32.0, 1024)
NETS: Final = (
    Net(cells=(58, 66), depth_mm=0.017, width_mm=0.085, bend_mm=0.12, tilt=0.05),
    Net(cells=(104, 120), depth_mm=0.009, width_mm=0.055, bend_mm=0.07, tilt=0.04),
)


@dataclass(frozen=True)
class _Layout:
    """Where each texel lies; every field is (across, around).

    ``x, y`` patch space in mm; ``flat`` (2, ...) the skin laid out flat; ``stretch`` the way around
    per mm of u; ``along, outward`` (..., 3) unit tangents; ``normal``; ``beyond`` mm from the
    lid's outer edge; ``upper`` 0 to 1.
    """

    x: Floats
    y: Floats
    flat: Floats
    stretch: Floats
    along: Floats
    outward: Floats
    normal: Floats
    around: Floats
    across: Floats
    beyond: Floats
    upper: Floats


def lid_coordinates(part: SkinPart, eye: int) -> Floats:
    """Return (n, 2) coordinates in the map; u grows past 1 nowhere, so seams need care."""
    around, across = part.along_mm.T
    return np.column_stack(
        [around / AROUND_MM, (np.clip(across / ACROSS_MM, 0.004, 0.996) + eye) / 2]
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
        _eye_map(_layout(part, eye, edge=edges_mm[eye], upper=upper[eye]), sources, eye)
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


def _layout(part: SkinPart, eye: int, *, edge: Floats, upper: Floats) -> _Layout:
    rows = len(edge)
    across_mm = part.along_mm[:, 1].reshape(rows, -1)
    local = to_patch(part.points_mm, eye).reshape(rows, -1, 3)
    normal = part.normals.reshape(rows, -1, 3)
    places = np.linspace(0.0, ACROSS_MM, MAP_PX[0] // 8)

    def spread(values: Floats) -> Floats:
        """Resample a patch's values (rows, along, k) to places across: (places, rows, k)."""
        columns = [
            np.interp(places, across_mm[i], values[i, :, k])
            for k in range(values.shape[2])
            for i in range(rows)
        ]
        return np.array(columns).reshape(values.shape[2], rows, -1).transpose(2, 1, 0)

    points, normals = spread(local), spread(normal)
    along = (np.roll(points, -1, 1) - np.roll(points, 1, 1)) * (rows / (2 * AROUND_MM))
    along = ndimage.gaussian_filter(along, (1.0, 1.5, 0.0), mode=("nearest", "wrap", "nearest"))
    outward = np.gradient(points, places, axis=0)
    stretch = np.linalg.norm(along, axis=-1, keepdims=True)
    # Laid out flat: straight on from the rim, as far as the skin's own way.
    rim, end = points[8, :, :2], points[-1, :, :2]
    away = (end - rim) / np.linalg.norm(end - rim, axis=1, keepdims=True)
    flat = rim[None] + away[None] * places[:, None, None]
    mirror = [1.0 if eye else -1.0, 1.0, 1.0]
    fields = np.concatenate(
        [
            points[..., :2],
            flat,
            stretch,
            along / np.maximum(stretch, 1e-6) * mirror,
            outward / np.maximum(np.linalg.norm(outward, axis=-1, keepdims=True), 1e-6) * mirror,
            normals,
            np.broadcast_to(edge[None, :, None], (*points.shape[:2], 1)),
            np.broadcast_to(upper[None, :, None], (*points.shape[:2], 1)),
        ],
        axis=-1,
    )
    row = (np.arange(MAP_PX[0]) + 0.5) / MAP_PX[0] * (len(places) - 1)
    column = (np.arange(MAP_PX[1]) + 0.5) / MAP_PX[1] * rows
    at = np.stack(np.meshgrid(row, column, indexing="ij"))
    full = [
        ndimage.map_coordinates(
            np.concatenate([fields[..., k], fields[:, :1, k]], axis=1), at, order=1, mode="nearest"
        )
        for k in range(fields.shape[2])
    ]
    across = np.broadcast_to(row[:, None] * (ACROSS_MM / (len(places) - 1)), MAP_PX)
    around = np.broadcast_to(column[None, :] * (AROUND_MM / rows), MAP_PX)
    return _Layout(
        x=full[0],
        y=full[1],
        flat=np.stack(full[2:4]),
        stretch=np.maximum(full[4], 0.3),
        along=np.stack(full[5:8], axis=-1),
        outward=np.stack(full[8:11], axis=-1),
        normal=np.stack(full[11:14], axis=-1),
        around=around,
        across=across,
        beyond=across - full[14],
        upper=full[15],
    )


def _eye_map(place: _Layout, sources: _Sources, eye: int) -> npt.NDArray[np.uint8]:
    height = _height(place, sources, eye)
    slope_x, slope_y = _tangent_slopes(height, place)
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


def _ease(x: Floats) -> Floats:
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))


def _height(place: _Layout, sources: _Sources, eye: int) -> Floats:
    """Return the relief in mm."""
    shift = 13.7 * eye
    lines, s, w = sources.lines, 1.25 * place.around, place.across
    wander = 0.5 * _sample(sources.coarse, 0.9 * place.flat[0] + shift, 0.9 * place.flat[1])
    radius, angle = _from_outer_canthus(place)
    fan = np.exp(-((angle / 1.25) ** 4)) * _ease((radius - 0.8) / 2.5) * (place.x > 10.0)
    lid = 1.0 - fan
    skin = _ease((place.beyond + 0.25) / 0.5)

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
    height -= lower * lid * 0.045 * furrow * _ease((place.beyond - 2.0) / 3.0)
    feet = _sample(lines, radius / 2.2 + 5.0 + shift, angle * 5.0 + 0.12 * wander)
    rings = _groove(_sample(lines, angle * 12.0 + shift, radius / 0.5), share=0.6)
    height -= fan * (0.060 * _groove(feet, share=0.9, steep=1.9) + 0.008 * rings)
    net = _sample(sources.net, place.flat[0] + shift, place.flat[1])
    height += (0.85 * upper + 0.95 * lower) * net
    grain = _sample(sources.noise, s * 4.0 + shift, w * 4.0)
    height += 0.0022 * grain
    return np.asarray(height * skin + (1 - skin) * _margin_relief(place, sources, shift))


def _margin_relief(place: _Layout, sources: _Sources, shift: float) -> Floats:
    """Return the lid margin's relief in mm: nearly smooth, with a row of glands' openings."""
    soft = 0.006 * _sample(sources.noise, place.around + shift, place.across)
    return np.asarray(soft - 0.022 * _orifices(place))


def _orifices(place: _Layout) -> Floats:
    """Return the meibomian glands' openings 0 to 1: one a mm, in front of the wet edge."""
    number = np.round(place.around / 1.05)
    jitter = np.sin(number * 12.9898) * 0.22
    along = place.around - number * 1.05 - jitter
    across = place.beyond + 0.62 + 0.08 * np.sin(number * 78.233)
    clear = _ease((place.x + 12.5) / 2.0) * _ease((11.0 - place.x) / 2.0)  # of the canthi
    return np.asarray(clear * np.exp(-(along**2 + across**2) / 0.10**2))


def _from_outer_canthus(place: _Layout) -> tuple[Floats, Floats]:
    """Return distance in mm from the outer canthus and angle from the temple's direction."""
    dx, dy = place.x - LATERAL_MM[0] + 1.5, place.y - LATERAL_MM[1]
    return np.hypot(dx, dy), np.arctan2(dy, dx)


def _tangent_slopes(height: Floats, place: _Layout) -> tuple[Floats, Floats]:
    """Return slopes along the horizontal and the upright tangent that the skin's shader uses."""
    step = AROUND_MM / MAP_PX[1]
    d_around = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / (2 * step) / place.stretch
    d_across = np.gradient(height, ACROSS_MM / MAP_PX[0], axis=0)
    gradient = d_around[..., None] * place.along + d_across[..., None] * place.outward
    n = place.normal
    t = np.stack([n[..., 2], np.zeros(n.shape[:2]), -n[..., 0]], axis=-1)
    t /= np.maximum(np.linalg.norm(t, axis=-1, keepdims=True), 1e-3)
    return (gradient * t).sum(-1), (gradient * np.cross(n, t)).sum(-1)


def _blood(place: _Layout, sources: _Sources, eye: int) -> Floats:
    """Return the blood in the skin about its mean: blotches and fine vessels in patches."""
    shift = 7.3 + 11.9 * eye
    x, y = place.flat
    blotches = _sample(sources.coarse, 0.8 * x + shift, 0.8 * y)
    fine = _sample(sources.coarse, 2.6 * x + 3 * shift, 2.6 * y)
    contour = _sample(sources.coarse, 1.15 * x - shift, 1.15 * y)
    vessels = np.exp(-((contour / 0.07) ** 2)) * _ease(blotches * 0.6 + 0.25)
    veined = 1.2 + 1.3 * place.upper
    return np.asarray(0.5 * blotches + 0.4 * fine + veined * vessels + 0.8 * _orifices(place))
