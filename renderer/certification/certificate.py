"""Measure everything that a plan asks for, and say whether the aims are met."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from renderer.certification.aims import Aim, aims_of
from renderer.certification.environments import ENVIRONMENTS
from renderer.certification.inside import Irradiance, environment_inside, sun_inside
from renderer.certification.layers import LayerError, layer_errors
from renderer.certification.metrics import PictureScore, RegionScore, compare, rms_scores
from renderer.certification.ours import our_eye, our_picture, spec_of
from renderer.certification.plan import Case, Iris, Plan
from renderer.certification.tracing import trace_picture
from renderer.certification.twin import eye_shapes, iris_reflectance, sclera_reflectance
from renderer.certification.view import View, regions

Picture = npt.NDArray[np.float64]
Progress = Callable[[str], None]

BY_NAME: Final = {environment.name: environment for environment in ENVIRONMENTS}


@dataclass(frozen=True)
class PictureResult:
    """One case with its pictures (n, n, 3), linear radiance."""

    case: Case
    score: PictureScore
    ours: Picture
    reference: Picture
    masks: dict[str, npt.NDArray[np.bool_]]


@dataclass(frozen=True)
class InsideResult:
    """One light seen from inside the chamber, relative errors in percent."""

    light: str
    mean_error_percent: float
    mean_noise_percent: float
    spatial_rms_percent: float
    spatial_noise_percent: float


@dataclass
class Certificate:
    """All that was measured."""

    plan: Plan
    variant: str
    pictures: list[PictureResult] = field(default_factory=list)
    furnace: dict[str, list[float]] = field(default_factory=dict)
    suns: list[InsideResult] = field(default_factory=list)
    skies: list[InsideResult] = field(default_factory=list)
    layers: list[LayerError] = field(default_factory=list)

    def aims(self) -> list[Aim]:
        """Return every aim with what was reached."""
        iris: dict[str, RegionScore] = {
            result.case.name: result.score.regions["iris"] for result in self.pictures
        }
        return aims_of(
            iris=iris,
            furnace_percent=self.furnace["bias_percent"],
            suns={result.light: result.mean_error_percent for result in self.suns},
            skies={result.light: result.mean_error_percent for result in self.skies},
            layers={error.integrator: error.rms_percent for error in self.layers},
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the figures as plain JSON types."""
        aims = self.aims()
        return {
            "is_met": all(aim.is_met for aim in aims),
            "aims": [asdict(aim) | {"is_met": aim.is_met} for aim in aims],
            "path_tracer": f"mitsuba {self.variant}",
            "plan": asdict(self.plan),
            "pictures": [
                {
                    "case": asdict(result.case) | {"name": result.case.name},
                    "regions": {name: asdict(s) for name, s in result.score.regions.items()},
                }
                for result in self.pictures
            ],
            "furnace": self.furnace,
            "sun_inside": [asdict(result) for result in self.suns],
            "environment_inside": [asdict(result) for result in self.skies],
            "layers": [asdict(error) for error in self.layers],
        }


def certify(
    gl: moderngl.Context, mi: Any, plan: Plan, *, variant: str, seed: int, progress: Progress
) -> Certificate:
    """Measure a plan; ``progress`` is told each step, ``seed`` is the path tracer's."""
    certificate = Certificate(plan, variant)
    for result in picture_results(gl, mi, plan, seed=seed, progress=progress):
        certificate.pictures.append(result)
    progress("furnace")
    certificate.furnace = furnace(gl, mi, plan, seed=seed)
    for angle_deg in plan.sun_angles_deg:
        progress(f"sun at {angle_deg} degrees, inside")
        found = sun_inside(mi, angle_deg, size_px=plan.inside_px, spp=plan.sun_spp, seed=seed)
        certificate.suns.append(_inside_result(f"sun at {angle_deg} degrees", found))
    for name in plan.inside_environments:
        progress(f"{name}, inside")
        found = environment_inside(
            mi, BY_NAME[name], size_px=plan.inside_px, spp=plan.sky_spp, seed=seed
        )
        certificate.skies.append(_inside_result(name, found))
    progress("layers")
    iris_seed, iris_colour = plan.cases[0].iris
    certificate.layers = layer_errors(
        gl,
        iris_seed=iris_seed,
        iris_colour=iris_colour,
        points=plan.layer_points,
        steps=plan.layer_steps,
    )
    return certificate


def picture_results(
    gl: moderngl.Context, mi: Any, plan: Plan, *, seed: int, progress: Progress
) -> Iterator[PictureResult]:
    """Render and trace the plan's pictures, one iris after the other."""
    for iris in dict.fromkeys(case.iris for case in plan.cases):
        shapes = twin_of(mi, iris)
        for case in plan.cases:
            if case.iris == iris:
                progress(case.name)
                yield picture_result(gl, mi, case, shapes=shapes, plan=plan, seed=seed)


def twin_of(mi: Any, iris: Iris, *, is_even: bool = False) -> dict[str, Any]:
    """Return an eye's shapes for the path tracer."""
    spec = spec_of(*iris, is_even=is_even)
    return eye_shapes(mi, iris_reflectance(spec), sclera_reflectance(spec))


def picture_result(
    gl: moderngl.Context,
    mi: Any,
    case: Case,
    *,
    shapes: dict[str, Any],
    plan: Plan,
    seed: int,
    is_even: bool = False,
) -> PictureResult:
    """Render one case, trace its twin, compare them."""
    environment, spec = BY_NAME[case.environment], spec_of(*case.iris, is_even=is_even)
    view = View(plan.size_px, case.azimuth_deg)
    drawn = our_picture(gl, our_eye(gl, spec, environment), view).astype(np.float64)
    traced = trace_picture(mi, shapes, environment, view=view, spp=plan.spp, seed=seed)
    masks = regions(view, spec.pupil_mm)
    score = compare(drawn, traced.picture, noise=traced.noise, masks=masks)
    return PictureResult(case, score, drawn, traced.picture, masks)


def furnace(gl: moderngl.Context, mi: Any, plan: Plan, *, seed: int) -> dict[str, list[float]]:
    """Compare an even Lambertian iris under the same light from everywhere, face-on."""
    case = Case(plan.cases[0].iris, "constant", 0.0)
    shapes = twin_of(mi, case.iris, is_even=True)
    result = picture_result(gl, mi, case, shapes=shapes, plan=plan, seed=seed + 1, is_even=True)
    mask = result.masks["iris"]
    return rms_scores(
        result.ours[mask], result.reference[mask], noise=np.zeros_like(result.ours[mask])
    )


def _inside_result(light: str, found: Irradiance) -> InsideResult:
    return InsideResult(
        light,
        100 * found.mean_error,
        100 * found.mean_noise,
        100 * found.spatial_rms,
        100 * found.spatial_noise,
    )
