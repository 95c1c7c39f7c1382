"""What renderer tests share: one GL context (opening one costs 0.3 s), a scene, average lids."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import moderngl
import numpy as np
import pytest

from renderer.clip import ClipSpec
from renderer.detail import Detail
from renderer.eye.lids import Curve, LidRims
from renderer.gl.context import create_context
from renderer.scene import Scene, build_scene

LID_SHELL_MM: Final = 12.3  # radius on which the inner edge of the rim slides over the globe
LATERAL_CANTHUS_MM: Final = 13.0  # towards the temple
MEDIAL_CANTHUS_MM: Final = 17.0  # towards the nose; the inner 4-5 mm hold the caruncle


SHARED: Final[list[moderngl.Context]] = []


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup() -> None:
    """Make the shared context current: a test that opens its own leaves none."""
    for context in SHARED:
        context.__enter__()


@pytest.fixture(scope="session")
def gl() -> Iterator[moderngl.Context]:
    context = create_context()
    SHARED.append(context)
    yield context
    SHARED.clear()
    context.release()


@pytest.fixture(scope="session")
def standard_scene(gl: moderngl.Context) -> Scene:
    """The scene of a clip with no wishes about it: building one costs seconds."""
    return build_scene(gl, ClipSpec(left=Detail(), right=Detail()))


@pytest.fixture
def average_rims() -> tuple[LidRims, LidRims]:
    """The rims of an average open pair of eyes, the viewer's left and right."""
    return anatomical_rims(0), anatomical_rims(1)


def anatomical_rims(eye: int, *, samples: int = 65) -> LidRims:
    """Return the rims of an average open eye (0 the viewer's left, 1 right).

    Upper lid 1.6-2 mm over the superior limbus with its peak in the medial third, lower lid at the
    limbus with its trough in the lateral third, both falling to the canthi like an almond's
    outline: opening about 9.5 mm (reference values of eye anatomy: fissure 30 x 9.7 +- 1.2 mm).
    """
    temple = -1.0 if eye == 0 else 1.0  # the character's right eye is on the viewer's left
    towards_temple = np.linspace(-MEDIAL_CANTHUS_MM, LATERAL_CANTHUS_MM, samples)
    tilt = 2.0 * (towards_temple + MEDIAL_CANTHUS_MM) / (LATERAL_CANTHUS_MM + MEDIAL_CANTHUS_MM)
    upper = 3.9 * (1 - _warp(towards_temple, peak_mm=-2.5) ** 2) ** 0.85
    lower = -5.6 * (1 - _warp(towards_temple, peak_mm=2.5) ** 2) ** 0.95
    curves = [
        np.column_stack([temple * towards_temple, y, _depth(towards_temple, y)])
        for y in (upper + tilt - 1.0, lower + tilt - 1.0)
    ]
    ordered = [curve if temple > 0 else curve[::-1] for curve in curves]
    return LidRims(upper_mm=ordered[0], lower_mm=ordered[1])


def _warp(x: Curve, *, peak_mm: float) -> Curve:
    """Map the fissure to -1..1 with 0 at the curve's extremum."""
    left, right = -MEDIAL_CANTHUS_MM, LATERAL_CANTHUS_MM
    return np.where(
        x < peak_mm, (x - peak_mm) / (peak_mm - left), (x - peak_mm) / (right - peak_mm)
    )


def _depth(x: Curve, y: Curve) -> Curve:
    """Slide on the lid shell over the globe and leave it smoothly towards the canthi."""
    on_shell = np.sqrt(np.clip(LID_SHELL_MM**2 - x**2 - y**2, 4.0, None))
    at_canthus = np.where(x > 0, 3.0, 5.5)
    leave = np.clip((np.abs(x) - 8.5) / 5.0, 0.0, 1.0)
    leave = leave * leave * (3 - 2 * leave)
    return np.asarray((1 - leave) * on_shell + leave * at_canthus)
