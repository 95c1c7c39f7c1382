"""The eyes of a clip as far as frames asked for them: models by LoD, and what lies between two.

Everything that does not change within a clip (maps, light inside the eye) is made once per LoD.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import moderngl

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.cube_size import cube_px
from renderer.eye.kept import Kept
from renderer.eye.lids import LidRims
from renderer.eye.model import EyeModel, build_model
from renderer.eye.morph import Morph
from renderer.light import Light

Shares = tuple[tuple[Detail, float], ...]


class EyeModels:
    """Models of both eyes, built when they are first asked for."""

    def __init__(
        self,
        gl: moderngl.Context,
        spec: ClipSpec,
        *,
        rims: tuple[LidRims, LidRims],
        light: Light,
        static_cube: Callable[[int], moderngl.TextureCube],
        crowd_cube: moderngl.TextureCube | None,
        has_face: bool = True,
        kept: Kept | None = None,
    ) -> None:
        """Build both eyes in their light; ``static_cube`` gives the surroundings at a size.

        Of ``rims`` the first are the viewer's left. Without a face (``has_face``) eyes mirror all
        of the surroundings. ``kept`` has what eyes before them were built of, and takes what these
        are.
        """
        self._gl = gl
        self.spec = spec
        self._rims = rims
        self._light = light
        self._static_cube = static_cube
        self._crowd_cube = crowd_cube
        self._has_face = has_face
        self._kept = kept or Kept()
        self._built: dict[tuple[int, Detail], EyeModel] = {}
        self._morphs: dict[tuple[Detail, Detail], Morph] = {}

    def of(self, eye: int, shares: Shares) -> list[EyeModel]:
        """Return the models that an eye is drawn with.

        Where one of two refracts, both do, by its share: the pupil moves instead of showing twice.
        """
        bending = refracting(shares)
        if bending is None:
            return [self.model(eye, detail) for detail, _ in shares]
        models = []
        for detail, _ in shares:
            own = self.model(eye, detail)
            bent = self.model(eye, detail.with_levels(refraction=bending[0]))
            models.append(
                replace(bent, values=bent.values | {"u_iris_gain": own.values["u_iris_gain"]})
            )
        return models

    def model(self, eye: int, detail: Detail) -> EyeModel:
        """Return the viewer's left (0) or right (1) eye at a LoD."""
        if (eye, detail) not in self._built:
            self._built[eye, detail] = build_model(
                self._gl,
                eye,
                detail=detail,
                spec=self.spec,
                rims=self._rims[eye],
                light=self._light,
                cubes=_cubes(detail, self.spec, self._static_cube, self._crowd_cube),
                has_face=self._has_face,
                kept=self._kept,
            )
        return self._built[eye, detail]

    def morph(self, shares: Shares) -> Morph:
        """Return the mesh between two LoDs, the coarser first."""
        (coarse, _), (fine, _) = shares
        if (coarse, fine) not in self._morphs:
            self._morphs[coarse, fine] = Morph(self._gl, coarse, fine)
        return self._morphs[coarse, fine]


def refracting(shares: Shares) -> tuple[str, float] | None:
    """Return level and share of the LoD that refracts where the other one does not, else None."""
    bent = [(d.refraction, share) for d, share in shares if d.setting("refraction", "refracts")]
    return bent[0] if len(shares) > 1 and len(bent) == 1 else None


def _cubes(
    detail: Detail,
    spec: ClipSpec,
    static_cube: Callable[[int], moderngl.TextureCube],
    crowd_cube: moderngl.TextureCube | None,
) -> dict[str, moderngl.TextureCube]:
    """Return the cubes that a LoD mirrors; raises ValueError where ultra finds no crowd."""
    size = cube_px(detail, spec)
    if size == 0:
        return {}
    cubes = {"u_static_cube": static_cube(size)}
    if detail.setting("reflection", "mode") == "dynamic":
        if crowd_cube is None:
            raise ValueError("reflection=ultra mirrors moving people: it needs a crowd cube")
        cubes["u_crowd_cube"] = crowd_cube
    return cubes
