"""What one eye's shader reads from textures: iris, sclera, sunlight inside the eye, lids' rims.

The edge between numpy and GL: bakes come from the cache or are made, and become textures.
"""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.cache import cached_array
from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye import sclera
from renderer.eye.anatomy import shader_constants
from renderer.eye.caustics import caustic_map
from renderer.eye.chamber import chamber_irradiance
from renderer.eye.lids import LidRims
from renderer.eye.sclera import sclera_maps
from renderer.eye.subsurface import subsurface_gain
from renderer.iris import maps as iris
from renderer.iris.maps import iris_maps, scattering
from renderer.iris.pigment import linear_to_srgb
from renderer.light import Sky
from renderer.program import build_program

Array = npt.NDArray[np.float64]
Values = dict[str, Any]

SRGB8_ALPHA8: Final = 0x8C43
THICKNESS_PX: Final = {"high": 512, "ultra": 1024}  # finer than the nodes of each level's march
DIRECTION_MAP_PX: Final = 256  # refracted light's direction where no caustic is drawn
MULTIPLE_SHARE: Final = 0.45  # of the reflectance: light scattered more than once, a smooth floor
CHAMBER_PX: Final = 32  # ambient light varies slowly over the iris
SHADE_MAP_PX: Final = 512  # 0.05 mm: finer than the softest edge of a shadow
RIM_SAMPLES: Final = 128
RIM_EDGE_MM: Final = 18.0


def iris_values(gl: moderngl.Context, spec: ClipSpec, detail: Detail) -> Values:
    """Return the iris's textures and colours for a LoD."""
    size = int(detail.setting("texture", "iris_map_px"))
    maps = iris_maps(spec.iris_seed, spec.iris_colour, size_px=size)
    colour = np.concatenate([maps.albedo, maps.cavity[..., None]], axis=-1)
    return {
        "u_iris_albedo": _srgb_texture(gl, colour),
        "u_iris_normal": _packed_texture(gl, maps.normal),
        "u_iris_mean": iris.mean_albedo(spec.iris_seed, spec.iris_colour),
        "u_pupil_mm": spec.pupil_mm,
    } | _subsurface_values(gl, spec, detail)


def sclera_values(gl: moderngl.Context, spec: ClipSpec, detail: Detail) -> Values:
    """Return the sclera's textures and mean colour for a LoD."""
    diffuse_px = int(detail.setting("sclera", "diffuse_map_px"))
    normal_px = int(detail.setting("sclera", "normal_map_px"))
    diffuse = sclera_maps(spec.iris_seed, size_px=diffuse_px).albedo
    normal = sclera_maps(spec.iris_seed, size_px=max(normal_px, 1)).normal
    return {
        "u_sclera_albedo": _srgb_texture(gl, _with_alpha(diffuse)),
        "u_sclera_normal": _packed_texture(gl, normal),
        "u_sclera_mean": sclera.mean_albedo(spec.iris_seed),
    }


def sunlight_values(
    gl: moderngl.Context, detail: Detail, sky: Sky, *, eye_to_world: Array, rims: LidRims
) -> Values:
    """Return the maps of sun and sky inside the eye; ``eye_to_world`` is (3, 3)."""
    sun_eye = np.asarray(sky.sun_direction, dtype=np.float64) @ eye_to_world
    size = int(detail.setting("caustics", "caustic_map_px")) or DIRECTION_MAP_PX
    caustic = cached_array(
        f"caustic {size} {np.round(sun_eye, 9).tolist()}", lambda: caustic_map(sun_eye, size)
    )
    chamber = chamber_irradiance(sky.radiance, eye_to_world, rims=rims, size_px=CHAMBER_PX)
    return {
        "u_caustic_map": _float_texture(gl, _with_alpha(caustic)),
        "u_chamber_map": _float_texture(gl, _with_alpha(chamber)),
    }


def shade_map(gl: moderngl.Context, placed: Values) -> moderngl.Texture:
    """Draw what sun and sky reach each point of the globe's front; ``placed`` light and rims."""
    program = build_program(
        gl, "screen.vert", fragment="eye_shade_map.frag", constants=shader_constants()
    )
    texture = gl.texture((SHADE_MAP_PX, SHADE_MAP_PX), 4, dtype="f2")
    program.set(**placed, u_map_px=SHADE_MAP_PX)
    with gl.scope(gl.framebuffer([texture]), moderngl.NOTHING):
        gl.vertex_array(program.gl_program, []).render(moderngl.TRIANGLES, vertices=3)
    return _clamped(texture)


def rims_texture(gl: moderngl.Context, rims: LidRims) -> moderngl.Texture:
    """Return the rims as a table over x: y of upper and lower rim, z of upper and lower rim."""
    x = (np.arange(RIM_SAMPLES) + 0.5) / RIM_SAMPLES * 2 * RIM_EDGE_MM - RIM_EDGE_MM
    columns = [
        np.interp(x, curve[:, 0], curve[:, axis])
        for axis in (1, 2)
        for curve in (rims.upper_mm, rims.lower_mm)
    ]
    table = np.stack(columns, axis=-1).astype(np.float32)[None]
    texture = gl.texture((RIM_SAMPLES, 1), 4, table.tobytes(), dtype="f4")
    return _clamped(texture)


def _subsurface_values(gl: moderngl.Context, spec: ClipSpec, detail: Detail) -> Values:
    """Return the layers, their coefficients and the gain that ties them to the map's colour."""
    size = THICKNESS_PX.get(detail.subsurface, 1)
    layers = iris_maps(spec.iris_seed, spec.iris_colour, size_px=size).thickness_mm
    mean = iris.mean_thickness_mm(spec.iris_seed, spec.iris_colour).astype(np.float64)
    tissue = scattering(spec.iris_colour)
    return {
        "u_thickness": _float_texture(gl, layers),
        "u_sigma_s": tissue.sigma_s.T,
        "u_sigma_t": tissue.sigma_t.T,
        "u_anisotropy": tissue.anisotropy,
        "u_subsurface_gain": subsurface_gain(mean, tissue),
        "u_multiple_share": MULTIPLE_SHARE,
    }


def _with_alpha(colour: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return np.concatenate([colour, np.ones_like(colour[..., :1])], axis=-1)


def _srgb_texture(gl: moderngl.Context, colour: npt.NDArray[Any]) -> moderngl.Texture:
    """Upload linear colour (n, n, 4) as sRGB with a linear alpha."""
    encoded = np.concatenate([linear_to_srgb(colour[..., :3]), colour[..., 3:]], axis=-1)
    pixels = np.rint(np.clip(encoded, 0, 1) * 255).astype(np.uint8)
    size = pixels.shape[1::-1]
    return _clamped(gl.texture(size, 4, pixels.tobytes(), internal_format=SRGB8_ALPHA8), mips=True)


def _packed_texture(gl: moderngl.Context, normal: npt.NDArray[Any]) -> moderngl.Texture:
    """Upload unit normals (n, n, 3) packed to 0..1."""
    pixels = np.rint(_with_alpha(0.5 + 0.5 * normal) * 255).astype(np.uint8)
    return _clamped(gl.texture(pixels.shape[1::-1], 4, pixels.tobytes()), mips=True)


def _float_texture(gl: moderngl.Context, values: npt.NDArray[Any]) -> moderngl.Texture:
    """Upload (n, n, 4) as half floats."""
    data = np.ascontiguousarray(values, dtype=np.float16).tobytes()
    return _clamped(gl.texture(values.shape[1::-1], 4, data, dtype="f2"), mips=True)


def _clamped(texture: moderngl.Texture, *, mips: bool = False) -> moderngl.Texture:
    texture.repeat_x = texture.repeat_y = False
    if mips:
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    else:
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
