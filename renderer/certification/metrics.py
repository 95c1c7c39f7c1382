"""How far two pictures lie apart, region by region: RMS per channel, FLIP, SSIM.

Pictures are linear radiance (n, n, 3).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from renderer.encoding.flip import PIXELS_PER_DEGREE
from renderer.frame.picture import EXPOSURE

Picture = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

LUMINANCE: Final = np.array([0.2126, 0.7152, 0.0722])  # Rec. 709
LEAST_FOR_FLIP: Final = 1e-4  # its exposures are computed from logarithms


@dataclass(frozen=True)
class RegionScore:
    """One region of one picture against the reference.

    RMS per channel in percent of the reference's maximum within the region, as Francois et al.
    report it against photographs: measured; the reference's own noise in the same unit; and what
    is left without it. ``bias_percent`` is that of the means. FLIP's means, mean SSIM.
    """

    pixels: int
    rms_percent: list[float]
    noise_percent: list[float]
    rms_without_noise_percent: list[float]
    bias_percent: list[float]
    flip_hdr: float
    flip_ldr: float
    ssim: float


@dataclass(frozen=True)
class PictureScore:
    """All regions, and FLIP's map (n, n) for the report."""

    regions: dict[str, RegionScore]
    flip_map: Picture


def compare(
    ours: Picture, reference: Picture, *, noise: Picture, masks: dict[str, Mask]
) -> PictureScore:
    """Compare a picture with its reference, whose noise is given per pixel (half of two halves)."""
    everything = masks["whole eye"]
    shown = [np.where(everything[..., None], p, 0.0) for p in (reference, ours)]
    flip_hdr = flip_map(*shown, is_hdr=True)
    flip_ldr = flip_map(*(displayed(p) for p in shown), is_hdr=False)
    similarity = ssim_map(*shown)
    scores = {
        name: RegionScore(
            pixels=int(mask.sum()),
            flip_hdr=float(flip_hdr[mask].mean()),
            flip_ldr=float(flip_ldr[mask].mean()),
            ssim=float(similarity[mask].mean()),
            **rms_scores(ours[mask], reference[mask], noise=noise[mask]),
        )
        for name, mask in masks.items()
        if mask.any()
    }
    return PictureScore(scores, flip_ldr)


def rms_scores(ours: Picture, reference: Picture, *, noise: Picture) -> dict[str, list[float]]:
    """Return the RMS figures of pixels (m, 3) per channel, in percent."""
    highest, mean = reference.max(axis=0), reference.mean(axis=0)
    rms = 100 * np.sqrt(np.mean((ours - reference) ** 2, axis=0)) / highest
    noise_rms = 100 * np.sqrt(np.mean(noise**2, axis=0)) / highest
    return {
        "rms_percent": rms.tolist(),
        "noise_percent": noise_rms.tolist(),
        "rms_without_noise_percent": np.sqrt(np.maximum(rms**2 - noise_rms**2, 0.0)).tolist(),
        "bias_percent": (100 * (ours.mean(axis=0) / mean - 1)).tolist(),
    }


def displayed(picture: Picture) -> Picture:
    """Return linear radiance as sRGB between 0 and 1 at the clips' exposure, without tone curve."""
    linear = np.clip(EXPOSURE * picture, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def flip_map(reference: Picture, test: Picture, *, is_hdr: bool) -> Picture:
    """Return FLIP (Andersson et al. 2020, 2021) per pixel, 0 to 1."""
    import flip_evaluator

    pair = [
        np.ascontiguousarray(np.maximum(p, LEAST_FOR_FLIP), np.float32) for p in (reference, test)
    ]
    kind = "HDR" if is_hdr else "LDR"
    settings: dict[str, Any] = {"parameters": {"ppd": PIXELS_PER_DEGREE}, "applyMagma": False}
    found, _, _ = flip_evaluator.evaluate(*pair, kind, **settings)
    return np.asarray(found, dtype=np.float64).reshape(reference.shape[:2])


def ssim_map(reference: Picture, test: Picture) -> Picture:
    """Return SSIM (Wang et al. 2004) of displayed luminance per pixel."""
    from skimage.metrics import structural_similarity

    pair = [displayed(p) @ LUMINANCE for p in (reference, test)]
    similarity: Callable[..., Any] = structural_similarity
    _, found = similarity(
        *pair,
        data_range=1.0,
        gaussian_weights=True,
        sigma=1.5,
        use_sample_covariance=False,
        full=True,
    )
    return np.asarray(found, dtype=np.float64)
