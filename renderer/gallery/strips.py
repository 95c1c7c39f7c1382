"""The gallery's table of strips: the LoDs, the effects, the iris and the thesis's own forms.

What moves the head's geometry or the sun is in ``renderer.gallery.scenes``. Adding a strip is
adding a row; page.md says what to look at in each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from renderer.clip_values import DISTANCES, IRIS_COLOURS
from renderer.detail import EFFECTS, STANDARD_LODS, Detail
from renderer.gallery.shots import (
    BOTH_EYES,
    FACE,
    FAR_FACE,
    LEFT_IRIS,
    WHOLE,
    Captioned,
    Shot,
    Take,
    left_only,
    spec_of,
)

ULTRA: Final = Detail.uniform("ultra")
OFF: Final = Detail.uniform("off")


@dataclass(frozen=True)
class Strip:
    """One picture of the gallery: captioned tiles in rows.

    ``tiles`` makes them with the given camera; ``tile_px`` is the width that each is shrunk to.
    """

    name: str
    title: str
    tiles: Callable[[Take], list[Captioned]]
    columns: int = 4
    tile_px: int = 480


def of_shots(shots: Sequence[Shot]) -> Callable[[Take], list[Captioned]]:
    """Return the maker of a strip whose tiles are all shots."""
    return lambda take: [take(shot) for shot in shots]


def _lods(distance: str) -> list[Shot]:
    """Return one shot per standard LoD: what a viewer sees of it at a distance."""
    if distance == "macroscopic":
        return [Shot(lod, left_only(lod)) for lod in STANDARD_LODS]
    crop, lines = {"near": (BOTH_EYES, 1000), "medium": (FACE, 1500), "far": (FAR_FACE, 1500)}[
        distance
    ]
    enlarge = 3 if distance == "far" else 1
    return [
        Shot(lod, spec_of(lod, distance=distance), crop, lines=lines, enlarge=enlarge)
        for lod in STANDARD_LODS
    ]


def _distances() -> list[Shot]:
    """Return ultra beside low at every distance, as a clip shows them."""
    return [
        Shot(
            f"{distance}: ultra (left), low (right)",
            spec_of("ultra", right=Detail.uniform("low"), distance=distance),
            WHOLE,
        )
        for distance in DISTANCES
    ]


def _leave_one_out() -> list[Shot]:
    return [Shot("ultra: everything", left_only(ULTRA))] + [
        Shot(f"without {effect}", left_only(ULTRA.with_levels(**{effect: "off"})))
        for effect in EFFECTS
    ]


def _alone() -> list[Shot]:
    return [Shot("everything off", left_only(OFF))] + [
        Shot(f"{effect} alone", left_only(ULTRA.only(effect))) for effect in EFFECTS
    ]


def _levels(effect: str) -> list[Shot]:
    """Return one shot per level of an effect, all else at ultra."""
    return [
        Shot(level, left_only(ULTRA.with_levels(**{effect: level})), LEFT_IRIS)
        for level in ("off", *STANDARD_LODS)
    ]


def _orbit() -> list[Shot]:
    return [
        Shot(f"{azimuth:+d} degrees", left_only(), azimuth_deg=azimuth)
        for azimuth in (-60, -40, -20, 0, 20, 40)
    ]


def _iris(colours: Sequence[str], seeds: Sequence[int]) -> list[Shot]:
    return [
        Shot(
            f"{colour}, seed {seed}",
            left_only(iris_colour=colour, iris_seed=seed),
            LEFT_IRIS,
            azimuth_deg=0.0,
            lines=1500,
        )
        for colour in colours
        for seed in seeds
    ]


def _pupils() -> list[Shot]:
    return [
        Shot(
            f"{colour}, pupil {pupil} mm",
            left_only(iris_colour=colour, pupil_mm=pupil),
            LEFT_IRIS,
            azimuth_deg=0.0,
            lines=1500,
        )
        for colour in ("blue", "brown")
        for pupil in (2, 4, 7)
    ]


def _sums() -> list[Shot]:
    """Return ours against the thesis's left-endpoint sums, as pictures and as differences."""
    sums = {count: left_only(subsurface_samples=count) for count in (2, 10, 200)}
    pictures = [Shot("ours", left_only(), LEFT_IRIS)] + [
        Shot(f"left sum, {count} samples", spec, LEFT_IRIS) for count, spec in sums.items()
    ]
    return pictures + [
        Shot(f"2 x ({count} samples - ours)", spec, LEFT_IRIS, minus=left_only(), gain=2.0)
        for count, spec in sums.items()
    ]


def _painted() -> list[Shot]:
    painted = left_only(caustic_pattern="painted")
    return [
        Shot("computed", left_only()),
        Shot("painted by the thesis's recipe", painted),
        Shot("2 x (painted - computed)", painted, minus=left_only(), gain=2.0),
    ]


def _presets() -> list[Shot]:
    return [
        Shot(f"{preset}: {lod}", left_only(lod, preset=preset))
        for preset in ("thesis", "calibrated")
        for lod in STANDARD_LODS
    ]


def _meshes() -> list[Shot]:
    return [
        Shot(
            lod,
            left_only(lod),
            wireframe=True,
        )
        for lod in STANDARD_LODS
    ]


STRIPS: Final = (
    Strip("lods-macroscopic", "The four LoDs, macroscopic", of_shots(_lods("macroscopic")), 2, 640),
    Strip("lods-near", "The four LoDs, near", of_shots(_lods("near")), 2, 800),
    Strip("lods-medium", "The four LoDs, distance medium", of_shots(_lods("medium")), 2, 692),
    Strip("lods-far", "The four LoDs, far, pixels three times", of_shots(_lods("far")), 2, 808),
    Strip("distances", "One pair of eyes at the four distances", of_shots(_distances()), 2, 800),
    Strip("without", "Ultra without one effect", of_shots(_leave_one_out())),
    Strip("alone", "One effect alone, at ultra", of_shots(_alone())),
    Strip("orbit", "Ultra along the orbit", of_shots(_orbit()), 3),
    Strip("iris-colours", "Iris colours", of_shots(_iris(IRIS_COLOURS, (1,))), 4, 400),
    Strip("iris-seeds", "Seeds", of_shots(_iris(("blue", "brown"), (2, 3, 4, 5))), 4, 400),
    Strip("pupils", "The pupil stretches the iris", of_shots(_pupils()), 3, 400),
    Strip("subsurface", "The thesis's subsurface sum and ours", of_shots(_sums()), 4, 400),
    Strip("caustics", "Caustics, computed and painted", of_shots(_painted()), 3, 600),
    Strip("levels-texture", "Texture's levels, the rest at ultra", of_shots(_levels("texture")), 5),
    Strip(
        "levels-reflection",
        "Reflection's levels, the rest at ultra",
        of_shots(_levels("reflection")),
        5,
    ),
    Strip("presets", "The two presets", of_shots(_presets())),
    Strip("meshes", "The meshes", of_shots(_meshes())),
)
