"""What a certificate is made of, without a path tracer: views, light, metrics, aims."""

from __future__ import annotations

import importlib.util
import math
import subprocess

import numpy as np
import pytest

from renderer.certification import tracer
from renderer.certification.aims import Aim, aims_of
from renderer.certification.environments import ENVIRONMENTS
from renderer.certification.layers import NODES
from renderer.certification.metrics import RegionScore, displayed, flip_map, rms_scores, ssim_map
from renderer.certification.panels import profile, pupil_centre
from renderer.certification.plan import full_plan, quick_plan
from renderer.certification.view import HALF_MM, View, front_hit, regions
from renderer.detail import Detail
from renderer.eye.anatomy import GLOBE_RADIUS_MM
from renderer.eye.optics import surface_height


def test_rays_end_on_the_eyes_surface() -> None:
    view = View(24, 30.0)
    hit, meets = front_hit(view.camera_mm, view.rays())
    front = meets & (hit[..., 2] > 9.0)
    height, _ = surface_height(np.hypot(hit[front][:, 0], hit[front][:, 1]))
    np.testing.assert_allclose(hit[front][:, 2], height, atol=1e-6)
    globe = meets & (hit[..., 2] < 5.0)
    np.testing.assert_allclose(np.linalg.norm(hit[globe], axis=1), GLOBE_RADIUS_MM, atol=1e-6)


def test_the_regions_of_a_frontal_view_have_the_eyes_sizes() -> None:
    view = View(120)
    masks = regions(view, 4.0)
    pixel_mm2 = (2 * HALF_MM / 120) ** 2
    # Seen through the cornea: from 2.22 mm to where a ray meets the plane at 5.5, about 5.6 mm.
    seen_mm2 = math.pi * (5.6**2 - 2.22**2)
    assert masks["iris"].sum() * pixel_mm2 == pytest.approx(seen_mm2, rel=0.03)
    assert not (masks["iris"] & (masks["limbus"] | masks["sclera"])).any()
    assert (masks["whole eye"] >= masks["iris"]).all()
    assert pupil_centre(masks) == pytest.approx((59.5, 59.5), abs=0.3)


def test_a_slanting_view_sees_less_of_the_iris() -> None:
    frontal, slanting = (regions(View(48, turn), 4.0)["iris"].sum() for turn in (0.0, 50.0))
    assert 0.5 < slanting / frontal < 0.9


@pytest.mark.parametrize("environment", ENVIRONMENTS, ids=lambda e: e.name)
def test_the_skys_cube_holds_the_environment(environment) -> None:
    directions = np.array([[0.0, 1.0, 0.0], [0.6, 0.0, 0.8], [-0.45, 0.5, 0.74], [0.0, -0.8, -0.6]])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    sky = environment.sky()
    wanted = environment.radiance(directions)
    np.testing.assert_allclose(sky.radiance(directions), wanted, rtol=0.05, atol=0.02)
    assert not sky.sun_irradiance.any()


def test_rms_is_in_percent_of_the_maximum_and_noise_is_taken_out() -> None:
    rng = np.random.Generator(np.random.PCG64(1))
    truth = np.tile([[0.5, 1.0, 2.0]], (40_000, 1))
    noise = rng.normal(0.0, 0.03, truth.shape)
    score = rms_scores(truth * 1.04, truth + noise, noise=noise)
    np.testing.assert_allclose(score["bias_percent"], 4.0, atol=0.1)
    np.testing.assert_allclose(
        np.array(score["rms_without_noise_percent"]) * (truth + noise).max(axis=0),
        4.0 * truth[0],
        rtol=0.03,
    )
    assert score["rms_percent"][0] > score["rms_without_noise_percent"][0]


def test_equal_pictures_score_perfectly_and_others_do_not() -> None:
    rng = np.random.Generator(np.random.PCG64(2))
    picture = rng.uniform(0.05, 0.8, (24, 24, 3))
    other = picture[::-1].copy()
    for is_hdr in (True, False):
        assert flip_map(picture, picture, is_hdr=is_hdr).max() < 1e-3
        assert flip_map(picture, other, is_hdr=is_hdr).mean() > 0.1
    assert ssim_map(picture, picture).min() > 0.999
    assert ssim_map(picture, other).mean() < 0.5


def test_display_values_are_srgb() -> None:
    np.testing.assert_allclose(displayed(np.array([0.0, 0.214 / 0.8, 9.0])), [0, 0.5, 1], atol=1e-3)


def test_a_profile_runs_through_the_centre_to_the_right_and_up() -> None:
    picture = np.zeros((40, 40, 3))
    picture[:, 20:] = 1.0
    across = profile(picture, (19.5, 19.5), 0)
    assert across[0] == pytest.approx(0.0)
    assert across[-1] == pytest.approx(1.0)
    picture = np.zeros((40, 40, 3))
    picture[:20] = 1.0  # the upper half
    assert profile(picture, (19.5, 19.5), 90)[-1] == pytest.approx(1.0)


def test_an_aim_is_missed_above_its_limit_and_without_a_number() -> None:
    aim = Aim("RMS", 3.0, 3.2, "blue-1-constant-0")
    assert not aim.is_met
    assert aim.line() == "MISSED RMS: 3.20 % (blue-1-constant-0), wanted at most 3.00 %"
    assert Aim("RMS", 3.0, 3.0, "x").line().startswith("met    RMS: 3.00 %")
    assert not Aim("RMS", 3.0, math.nan, "x").is_met


def test_layers_are_judged_by_as_many_nodes_as_ultra_marches() -> None:
    marched = Detail.uniform("ultra").setting("subsurface", "nodes")
    assert marched in NODES
    none = [0.0, 0.0, 0.0]
    errors = {f"pieces {nodes}": 50.0 for nodes in NODES}
    errors |= {f"pieces {marched}": 0.1, "left sum 200": 6.0}
    *_, layers = aims_of(
        iris={"x": RegionScore(1, none, none, none, none, 0.0, 0.0, 1.0)},
        furnace_percent=none,
        suns={"x": 0.0},
        skies={"x": 0.0},
        layers=errors,
    )
    assert layers.line() == (
        f"met    layers: RMS of pieces {marched} beside the left sum 200: 0.10 % "
        f"(pieces {marched}), wanted at most 6.00 %"
    )


def test_the_full_plan_covers_two_irises_three_skies_and_three_views() -> None:
    cases = full_plan().cases
    assert len(cases) == len(set(cases)) == 18
    quick = quick_plan(((3, "green"),)).with_spp(16)
    assert {case.environment for case in quick.cases} == {e.name for e in ENVIRONMENTS}
    assert quick.spp == 16


def test_a_missing_path_tracer_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(RuntimeError) as told:
        tracer.check_installed()
    assert str(told.value) == (
        'needs mitsuba and flip-evaluator, not installed here; pip install "ocularist[certify]"'
    )


@pytest.mark.parametrize(("status", "variant"), [(0, "llvm_ad_rgb"), (-6, "scalar_rgb")])
def test_the_fast_variant_is_taken_where_its_probe_lives(
    monkeypatch: pytest.MonkeyPatch, status: int, variant: str
) -> None:
    tracer.best_variant.cache_clear()
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: subprocess.CompletedProcess([], status))
    assert tracer.best_variant() == variant
    tracer.best_variant.cache_clear()
