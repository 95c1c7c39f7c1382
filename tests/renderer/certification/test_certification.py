"""The certificate, small: a striped iris in soft light, ours beside the path tracer's."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest

from renderer.certification import twin
from renderer.certification.certificate import Certificate, certify, picture_result, twin_of
from renderer.certification.plan import LAYERS_NODES, Case, Plan
from renderer.certification.report import write_report
from renderer.certification.tracer import SAFE_VARIANT, path_tracer
from renderer.eye import maps, model
from renderer.eye.sclera import ScleraMaps
from renderer.gallery.certificate import certificate_strips
from renderer.iris import maps as iris
from renderer.iris.maps import IrisMaps

CASES = (Case((1, "blue"), "soft-box", 30.0), Case((1, "blue"), "gradient", 0.0))
PLAN = Plan(
    cases=CASES,
    size_px=48,
    spp=144,
    sun_angles_deg=(0, 60),
    inside_environments=("gradient",),
    inside_px=16,
    sun_spp=1200,
    sky_spp=256,
    layer_points=5,
    layer_steps=2000,
)


def striped_iris(_seed: int, _colour: str, *, size_px: int, **_base: int) -> IrisMaps:
    """An iris whose colour tells left from right and up from down."""
    axis = (np.arange(size_px, dtype=np.float32) + 0.5) / size_px * 2 - 1
    x, y = np.meshgrid(axis, axis)
    tone = 1 + 0.5 * x + 0.3 * y + 0.2 * np.sin(14 * x)
    albedo = tone[..., None] * np.array([0.10, 0.14, 0.20], np.float32)
    bumps = 0.15 + 0.05 * np.sin(30 * x) * np.cos(20 * y)
    return IrisMaps(
        albedo=albedo.astype(np.float32),
        normal=np.broadcast_to(np.array([0, 0, 1], np.float32), (size_px, size_px, 3)),
        height_mm=np.zeros((size_px, size_px), np.float32),
        thickness_mm=np.stack([0.3 * bumps, bumps, bumps, 0.3 * bumps], -1).astype(np.float32),
        cavity=np.ones((size_px, size_px), np.float32),
    )


def even_sclera(_seed: int, *, size_px: int) -> ScleraMaps:
    shape = (size_px, size_px, 3)
    return ScleraMaps(
        albedo=np.full(shape, 0.6, np.float32),
        normal=np.broadcast_to(np.array([0, 0, 1], np.float32), shape),
    )


@pytest.fixture(scope="module", autouse=True)
def quick_maps(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("OCULARIST_CACHE", str(tmp_path_factory.mktemp("cache")))
        patch.setattr(iris, "iris_maps", striped_iris)
        patch.setattr("renderer.certification.layers.iris_maps", striped_iris)
        patch.setattr(maps, "sclera_maps", even_sclera)
        patch.setattr(twin, "sclera_maps", even_sclera)
        patch.setattr(maps.sclera, "mean_albedo", lambda *_: np.full(3, 0.6))
        yield


@pytest.fixture(scope="module")
def certificate(gl: moderngl.Context) -> Certificate:
    return certify(
        gl,
        path_tracer(SAFE_VARIANT),
        PLAN,
        variant=SAFE_VARIANT,
        seed=0,
        progress=lambda _step: None,
    )


@pytest.mark.parametrize("number", range(len(CASES)))
def test_the_iris_agrees_with_the_path_tracers(certificate: Certificate, number: int) -> None:
    score = certificate.pictures[number].score.regions["iris"]
    assert score.pixels > 300
    assert max(score.rms_without_noise_percent) < 3.5
    assert np.abs(score.bias_percent).max() < 3.0
    assert score.ssim > 0.9
    assert score.flip_ldr < 0.08


def test_limbus_and_sclera_agree_roughly(certificate: Certificate) -> None:
    for result in certificate.pictures:
        for region in ("limbus", "sclera"):
            assert np.abs(result.score.regions[region].bias_percent).max() < 2.5


def test_furnace_an_even_iris_is_as_bright_in_both(certificate: Certificate) -> None:
    assert np.abs(certificate.furnace["bias_percent"]).max() < 1.0


def test_sunlight_inside_the_chamber_agrees(certificate: Certificate) -> None:
    for result in certificate.suns:
        # Particles are few here: three standard errors are 2 to 3 %.
        assert abs(result.mean_error_percent) < max(1.0, 3 * result.mean_noise_percent)
        assert result.mean_noise_percent < 1.5
        assert result.spatial_rms_percent < 1.5 * result.spatial_noise_percent + 3.0


def test_skylight_inside_the_chamber_agrees(certificate: Certificate) -> None:
    (result,) = certificate.skies
    assert result.light == "gradient"
    assert abs(result.mean_error_percent) < 1.5


def test_few_nodes_beat_the_thesiss_200_samples(certificate: Certificate) -> None:
    error = {found.integrator: found for found in certificate.layers}
    assert error[f"pieces {LAYERS_NODES}"].rms_percent < 0.3 * error["left sum 200"].rms_percent
    assert error["left sum 10"].bias_percent > 10.0
    assert error["pieces 6"].fetches < 10


def test_a_tenth_more_light_in_the_iris_is_found(
    gl: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The comparison can fail: one side alone is brightened."""
    mi = path_tracer(SAFE_VARIANT)
    shapes = twin_of(mi, CASES[1].iris)
    monkeypatch.setattr(model, "APPARENT_GAIN", 1.1 * model.APPARENT_GAIN)
    score = picture_result(gl, mi, CASES[1], shapes=shapes, plan=PLAN, seed=0).score
    assert min(score.regions["iris"].bias_percent) > 6.0
    assert max(score.regions["iris"].rms_without_noise_percent) > 3.0


def test_the_report_shows_every_figure(certificate: Certificate, tmp_path: Path) -> None:
    report = write_report(certificate, tmp_path).read_text(encoding="utf-8")
    for case in CASES:
        assert (tmp_path / f"{case.name}.png").read_bytes().startswith(b"\x89PNG")
        assert f'src="{case.name}.png"' in report
    for words in ("whole eye", "sun at 60 degrees", "left sum 200", "Aims"):
        assert words in report
    figures = json.loads((tmp_path / "certification.json").read_text(encoding="utf-8"))
    (strip,) = certificate_strips(tmp_path)  # the gallery reads what is written here
    shown = strip.tiles(lambda _shot: pytest.fail("a certificate's figures are there already"))
    assert len(shown) == len(figures["pictures"])
    assert figures["path_tracer"] == f"mitsuba {SAFE_VARIANT}"
    assert figures["is_met"] == all(aim["is_met"] for aim in figures["aims"])
    assert len(figures["pictures"]) == len(CASES)
