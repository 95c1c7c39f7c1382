"""Which iris a clip has: grown from its seed, or taken from a photograph."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from renderer.clip import ClipSpec
from renderer.eye.subsurface import Tissue
from renderer.iris import maps
from renderer.iris.file import read_iris, tissue_of
from renderer.iris.maps import IrisMaps
from renderer.textures.noise import Field


@dataclass(frozen=True)
class Iris:
    """One iris at any size: what the eye's shader and the exporters read.

    ``base_px`` is the size of its finest maps: a smaller one is made sooner.
    """

    seed: int
    colour: str
    file: str
    sha256: str
    base_px: int = maps.BASE_PX

    def maps(self, size_px: int) -> IrisMaps:
        """Return the maps with ``size_px`` texels a side, a power of two; at most ``base_px``."""
        if not self.file:
            size = min(size_px, self.base_px)
            return maps.iris_maps(self.seed, self.colour, size_px=size, base_px=self.base_px)
        return maps.sized_maps(read_iris(self.file, self.sha256), size_px)

    @property
    def mean_albedo(self) -> Field:
        """The mean linear albedo (3,) of the tissue between pupil and root."""
        return np.asarray(self.maps(1).albedo[0, 0])

    @property
    def mean_thickness_mm(self) -> Field:
        """The mean thickness (4,) in mm of the layers."""
        return np.asarray(self.maps(1).thickness_mm[0, 0])

    @property
    def tissue(self) -> Tissue:
        """The layers' coefficients."""
        if not self.file:
            return maps.scattering(self.colour)
        return tissue_of(read_iris(self.file, self.sha256))


def iris_of(spec: ClipSpec) -> Iris:
    """Return the iris of a clip's eyes."""
    return Iris(spec.iris_seed, spec.iris_colour, spec.iris_file, spec.iris_sha256)
