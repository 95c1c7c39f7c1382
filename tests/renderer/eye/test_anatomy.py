from __future__ import annotations

import pytest

from renderer import camera
from renderer.eye import anatomy


def test_camera_and_anatomy_agree_on_the_limbus() -> None:
    assert pytest.approx(2 * anatomy.LIMBUS_RADIUS_MM) == camera.IRIS_DIAMETER_MM
    assert pytest.approx(anatomy.LIMBUS_Z_MM, abs=0.005) == camera.LIMBUS_Z_MM


def test_the_chamber_has_the_depth_of_schematic_eyes() -> None:
    assert pytest.approx(12.683, abs=0.001) == anatomy.APEX_MM
    assert pytest.approx(24.43, abs=0.01) == anatomy.APEX_MM + anatomy.GLOBE_RADIUS_MM
    assert pytest.approx(3.3) == anatomy.APEX_MM - anatomy.IRIS_Z_MM


def test_shader_constants_are_the_modules_own_numbers() -> None:
    constants = anatomy.shader_constants()
    assert constants["CORNEA_IOR"] == anatomy.CORNEA_IOR == 1.336
    assert constants["IRIS_Z_MM"] == anatomy.IRIS_Z_MM
    assert all(isinstance(value, float) for value in constants.values())
