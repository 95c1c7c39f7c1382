"""What one eye's shader reads of light: sunlight and sky inside the eye, shade of lids and head."""

from __future__ import annotations

from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt
from scipy import ndimage

from renderer.cache import cached_array
from renderer.detail import Detail
from renderer.eye.anatomy import GLOBE_RADIUS_MM, shader_constants
from renderer.eye.caustics import MAP_EDGE_MM, caustic_map
from renderer.eye.chamber import chamber_irradiance
from renderer.eye.kept import Kept, fingerprint
from renderer.eye.lids import LidRims
from renderer.eye.painted_caustic import painted_caustic
from renderer.eye.textures import clamped, float_texture, grey_texture, with_alpha
from renderer.gl.assembly import Constants
from renderer.gl.program import build_program
from renderer.light import Sky

Array = npt.NDArray[np.float64]
Values = dict[str, Any]

DIRECTION_MAP_PX: Final = 256  # refracted light's direction where no caustic is drawn
RELIEF_SHADE_PX: Final = {"high": 512, "ultra": 1024}  # per level of texture
SHADE_MAP_PX: Final = 512  # 0.05 mm: finer than the softest edge of a shadow
SCATTER_MM: Final = 0.3  # standard deviation of light's way in the sclera, our estimate
SHADE_SEEP: Final = (0.72, 0.98, 1.05)  # powers of the sun's share, per channel
RIM_SAMPLES: Final = 128
RIM_EDGE_MM: Final = 18.0


def sunlight_values(
    gl: moderngl.Context,
    detail: Detail,
    sky: Sky,
    *,
    eye_to_world: Array,
    rims: LidRims,
    albedo: Array,
    caustic_pattern: str = "computed",
    kept: Kept | None = None,
) -> Values:
    """Return the maps of sun and sky inside the eye; ``eye_to_world`` is (3, 3).

    ``albedo`` (n, n, 3) is the iris's on its plane: some of its light comes back from the cornea.
    ``caustic_pattern`` "painted" adds the thesis's painted map; direction alone is then computed.
    ``kept`` has the maps of eyes built before and takes these.
    """
    kept = kept or Kept()
    sun_eye = np.asarray(sky.sun_direction, dtype=np.float64) @ eye_to_world
    map_px = int(detail.setting("caustics", "caustic_map_px"))
    is_painted = caustic_pattern == "painted"
    size = DIRECTION_MAP_PX if is_painted else map_px or DIRECTION_MAP_PX
    caustic = f"caustic {size} {np.round(sun_eye, 9).tolist()}"
    curves = (rims.upper_mm, rims.lower_mm)
    faces = sky.ambient_sh if sky.faces is None else sky.faces
    return {
        "u_caustic_map": kept.get(
            caustic,
            lambda: float_texture(
                gl, with_alpha(cached_array(caustic, lambda: caustic_map(sun_eye, size)))
            ),
        ),
        "u_chamber_map": kept.get(
            ("chamber", fingerprint(faces, eye_to_world, *curves, albedo)),
            lambda: float_texture(gl, with_alpha(_chamber(sky, eye_to_world, rims, albedo))),
        ),
        "u_painted_caustic": grey_texture(gl, _painting(map_px if is_painted else 0)),
    }


def _chamber(
    sky: Sky, eye_to_world: Array, rims: LidRims, albedo: Array
) -> npt.NDArray[np.float32]:
    return chamber_irradiance(
        sky.radiance, eye_to_world, rims=rims, albedo=albedo, size_px=len(albedo)
    )


def _painting(size_px: int) -> npt.NDArray[np.float32]:
    return painted_caustic(size_px) if size_px else np.zeros((1, 1), np.float32)


def shade_map(gl: moderngl.Context, placed: Values) -> moderngl.Texture:
    """Draw what sun and sky reach each point of the globe's front; ``placed`` light and rims."""
    program = build_program(
        gl, "screen.vert", fragment="eye_shade_map.frag", constants=shader_constants()
    )
    texture = gl.texture((SHADE_MAP_PX, SHADE_MAP_PX), 4, dtype="f2")
    program.set(**placed, u_map_px=SHADE_MAP_PX)
    with gl.scope(gl.framebuffer([texture]), moderngl.NOTHING):
        gl.vertex_array(program.gl_program, []).render(moderngl.TRIANGLES, vertices=3)
    return clamped(texture)


def scattered_sun(gl: moderngl.Context, shade: moderngl.Texture) -> moderngl.Texture:
    """Return the sun's share of a shade map as the white shows it, per channel.

    Light that enters the sclera leaves it a few tenths of a millimetre away: shadows of single
    lashes fade where the film's glints still show them sharp, and red seeps furthest into shade.
    """
    size = shade.size[0]
    sun = np.frombuffer(shade.read(), np.float16).reshape(size, size, 4)[..., 3]
    texel_mm = 2 * GLOBE_RADIUS_MM / size
    spread = ndimage.gaussian_filter(sun.astype(np.float32), SCATTER_MM / texel_mm, mode="nearest")
    seeping = with_alpha(np.clip(spread, 0.0, 1.0)[..., None] ** SHADE_SEEP)
    pixels = np.rint(seeping * 255).astype(np.uint8)
    return clamped(gl.texture((size, size), 4, pixels.tobytes()))


def relief_shade_map(
    gl: moderngl.Context, values: Values, *, constants: Constants, size_px: int
) -> moderngl.Texture:
    """Draw what the iris's relief makes of the sun's light; ``values`` are the eye's uniforms.

    ``constants`` are the header of the eye's program. Without relief one white texel is enough.
    """
    if size_px == 0:
        return grey_texture(gl, np.ones((1, 1)))
    program = build_program(gl, "screen.vert", fragment="iris_shade_map.frag", constants=constants)
    texture = gl.texture((size_px, size_px), 1)
    known = {name: value for name, value in values.items() if name in program.declared}
    program.set(**known, u_map_px=size_px, u_mm_per_px=2 * MAP_EDGE_MM / size_px)
    with gl.scope(gl.framebuffer([texture]), moderngl.NOTHING):
        gl.vertex_array(program.gl_program, []).render(moderngl.TRIANGLES, vertices=3)
    return clamped(texture, mips=True)


def rims_texture(gl: moderngl.Context, rims: LidRims) -> moderngl.Texture:
    """Upload the rims of one eye as their table."""
    return clamped(gl.texture((RIM_SAMPLES, 1), 4, rims_table(rims).tobytes(), dtype="f4"))


def rims_table(rims: LidRims) -> npt.NDArray[np.float32]:
    """Return the rims over x (1, RIM_SAMPLES, 4): y of upper and lower rim, z of both."""
    x = (np.arange(RIM_SAMPLES) + 0.5) / RIM_SAMPLES * 2 * RIM_EDGE_MM - RIM_EDGE_MM
    columns = [
        np.interp(x, curve[:, 0], curve[:, axis])
        for axis in (1, 2)
        for curve in (rims.upper_mm, rims.lower_mm)
    ]
    return np.stack(columns, axis=-1).astype(np.float32)[None]
