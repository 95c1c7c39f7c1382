"""The eye's numbers, each with its unit and source. Pure data, shared by Python and GLSL.

Means of adults. Eye space: millimetres, origin at the globe's centre, +z along the gaze.
"""

from __future__ import annotations

import math
from typing import Final

# Cornea: Baker's conic p z^2 - 2 R z + x^2 + y^2 = 0 (thesis section 4.1, where R prints as -0.78:
# 7.8 mm in centimetres, with z pointing out of the eye).
CORNEA_RADIUS_MM: Final = 7.8  # anterior apex radius; adults 7.0 to 8.6
CORNEA_ASPHERICITY: Final = 0.75  # p = 1 + Q; adults 0.5 to 1.0

GLOBE_RADIUS_MM: Final = 11.75  # scleral sphere: gives an axial length of 24.4 mm
LIMBUS_RADIUS_MM: Final = 5.85  # half of the visible iris diameter, 11.71 +- 0.42 mm
LIMBUS_INSET_MM: Final = 0.12  # the sclera overlaps the cornea by about a millimetre:
LIMBUS_WIDTH_MM: Final = 0.15  # a sigmoid of this width
CLEAR_REACH_MM: Final = 6.6  # beyond this radius less than 0.5 % of the light passes
LIMBUS_HEIGHT_RATIO: Final = 0.95  # the sclera reaches further in above and below: 11.1 mm high

IRIS_DEPTH_MM: Final = 3.3  # iris plane behind the apex; adults 2.2 to 3.7
IRIS_MAP_RADIUS_MM: Final = 5.85  # where the iris maps' disc ends
MAP_PUPIL_RADIUS_MM: Final = 2.0  # pupil of the iris maps; others are reached by stretching

# One interface with the tear film's and aqueous humour's index: within 0.03 mm of the true pair
# (1.376 over 1.336) on the iris plane at any view angle, while the thesis's 1.378 bends up to
# 0.18 mm too far.
CORNEA_IOR: Final = 1.336

# Width of the smooth join of cornea and sclera: the smooth maximum of both heights, blended over
# about +-0.7 mm around the limbus, raises the crease by half of this.
JOIN_HEIGHT_MM: Final = 0.15
JOIN_REACH_MM: Final = 1.6  # the blend's own window, exp(-((r - limbus) / reach)^4)
PROFILE_END_MM: Final = 8.5  # beyond this radius the surface is the scleral sphere

SUN_ANGULAR_RADIUS_DEG: Final = 0.27

LIMBUS_Z_MM: Final = math.sqrt(GLOBE_RADIUS_MM**2 - LIMBUS_RADIUS_MM**2)
LIMBUS_SAG_MM: Final = (
    CORNEA_RADIUS_MM - math.sqrt(CORNEA_RADIUS_MM**2 - CORNEA_ASPHERICITY * LIMBUS_RADIUS_MM**2)
) / CORNEA_ASPHERICITY
APEX_MM: Final = LIMBUS_Z_MM + LIMBUS_SAG_MM  # apex in front of the globe's centre
IRIS_Z_MM: Final = APEX_MM - IRIS_DEPTH_MM  # iris plane in eye space


def shader_constants() -> dict[str, int | float]:
    """Return the numbers that the shaders read, as their generated header."""
    names = (
        "CORNEA_RADIUS_MM",
        "CORNEA_ASPHERICITY",
        "CORNEA_IOR",
        "GLOBE_RADIUS_MM",
        "LIMBUS_RADIUS_MM",
        "LIMBUS_HEIGHT_RATIO",
        "LIMBUS_INSET_MM",
        "LIMBUS_WIDTH_MM",
        "IRIS_MAP_RADIUS_MM",
        "MAP_PUPIL_RADIUS_MM",
        "JOIN_HEIGHT_MM",
        "JOIN_REACH_MM",
        "PROFILE_END_MM",
        "APEX_MM",
        "IRIS_Z_MM",
        "SUN_ANGULAR_RADIUS_DEG",
    )
    return {name: float(globals()[name]) for name in names}
