"""What tests of recovered irises share: an eye that looks straight into a camera far away."""

from __future__ import annotations

import pytest

from renderer.unrefraction.pose import TELECENTRIC_MM, Pose


@pytest.fixture(scope="session")
def level_pose() -> Pose:
    """Where such an eye lies in a picture of about 600 pixels a side."""
    return Pose(
        x=300.0,
        y=280.0,
        px_per_mm=40.0,
        yaw=0.0,
        pitch=0.0,
        roll=0.0,
        distance_mm=TELECENTRIC_MM,
        pupil_mm=2.0,
        pupil_x_mm=0.0,
        pupil_y_mm=0.0,
        height_ratio=0.95,
    )
