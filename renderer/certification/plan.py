"""What a certification measures and what it must reach."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Final

from renderer.certification.environments import ENVIRONMENTS
from renderer.detail import Detail

AZIMUTHS_DEG: Final = (0.0, 30.0, 50.0)
Iris = tuple[int, str]  # seed and colour
IRISES: Final[tuple[Iris, ...]] = ((1, "blue"), (7, "brown"))

# The aims. Francois et al. (2009) report at most about 5 % RMS against photographs.
PICTURE_RMS_PERCENT: Final = 3.0  # per channel in the iris, without the reference's own noise
PICTURE_NOISE_PERCENT: Final = 3.0  # with more noise nobody can tell
FURNACE_PERCENT: Final = 1.0
INSIDE_PERCENT: Final = 1.0
LAYERS_NODES: Final = int(Detail.uniform("ultra").setting("subsurface", "nodes"))
LAYERS_RIVAL: Final = 200  # samples of the thesis's sum


@dataclass(frozen=True)
class Case:
    """One picture: an iris in an environment from an azimuth."""

    iris: Iris
    environment: str
    azimuth_deg: float

    @property
    def name(self) -> str:
        """Say the case in one word, for file names."""
        seed, colour = self.iris
        return f"{colour}-{seed}-{self.environment}-{self.azimuth_deg:g}"


@dataclass(frozen=True)
class Plan:
    """How much is measured, and how finely.

    ``size_px`` and ``spp`` of the pictures; ``inside_px`` of the plane seen from the chamber with
    ``sun_spp`` particles and ``sky_spp`` paths per pixel; ``layer_points`` along each side of the
    patch whose layers are integrated in ``layer_steps``.
    """

    cases: tuple[Case, ...]
    size_px: int
    spp: int
    sun_angles_deg: tuple[int, ...]
    inside_environments: tuple[str, ...]
    inside_px: int
    sun_spp: int
    sky_spp: int
    layer_points: int
    layer_steps: int = 4000

    def with_spp(self, spp: int | None) -> Plan:
        """Return the plan with other paths per pixel, if any are given."""
        return self if spp is None else replace(self, spp=spp)


def full_plan(irises: tuple[Iris, ...] = IRISES) -> Plan:
    """Return everything: each iris in each environment from each azimuth; about 10 minutes."""
    names = tuple(environment.name for environment in ENVIRONMENTS)
    return Plan(
        cases=tuple(Case(*case) for case in product(irises, names, AZIMUTHS_DEG)),
        size_px=96,
        spp=768,
        sun_angles_deg=(0, 30, 45, 60, 70),
        inside_environments=names,
        inside_px=48,
        sun_spp=1200,
        sky_spp=512,
        layer_points=24,
    )


def quick_plan(irises: tuple[Iris, ...] = IRISES) -> Plan:
    """Return a look at everything in less than a minute.

    Each environment from one azimuth, the irises in turn.
    """
    names = tuple(environment.name for environment in ENVIRONMENTS)
    return Plan(
        cases=tuple(
            Case(irises[number % len(irises)], name, azimuth)
            for number, (name, azimuth) in enumerate(zip(names, AZIMUTHS_DEG, strict=True))
        ),
        size_px=64,
        spp=384,
        sun_angles_deg=(0, 45, 70),
        inside_environments=names[-1:],
        inside_px=32,
        sun_spp=1000,
        sky_spp=384,
        layer_points=10,
    )
