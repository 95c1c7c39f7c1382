"""How an eye of a photograph stands before the camera, from the edges of its pupil and limbus.

A circle's shortening alone says little near 0 degrees and nothing of the side an eye turns to. So
one model eye is fitted to both edges at once, with the anatomy's spread as the prior of everything
that they leave open.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy import optimize

from renderer.eye.anatomy import LIMBUS_HEIGHT_RATIO
from renderer.unrefraction.edges import Edges
from renderer.unrefraction.pose import VISIBLE_LIMBUS_MM, Pose

Array = npt.NDArray[np.float64]

MODEL_LIMBUS_MM: Final = 11.7  # the visible iris's width that the model eye stands for
FEWER_POINTS: Final = 40  # an edge's many points are no independent witnesses: it weighs as these
FIRST_TURN: Final = 0.12  # radians each way that the first trials look

# The fitted parameters in their order, each with the step in which it is felt. ``log_scale`` is the
# logarithm of the pixels per mm; lengths, angles and shares are those of Pose.
STEPS: Final[Mapping[str, float]] = {
    "x": 1.0,
    "y": 1.0,
    "log_scale": 0.01,
    "yaw": 0.1,
    "pitch": 0.1,
    "pupil_mm": 0.05,
    "pupil_x_mm": 0.1,
    "pupil_y_mm": 0.1,
    "height_ratio": 0.01,
    "roll": 0.1,
    "oval_along": 0.01,
    "oval_across": 0.01,
}
# Spread of what the edges leave open.
TILT_DEG: Final = 12.0  # people look into a camera that is asked to photograph their eye
DECENTRE_MM: Final = 0.15
HEIGHT_RATIO: Final = 0.015
PUPIL_OVAL: Final = 0.012  # of the radius, along and across: no pupil is quite round
ROLL_DEG: Final = 30.0  # about the coarse search's, which goes in steps of 45: nearly even
UPRIGHT_DEG: Final = math.degrees(1e-4)  # once no roll is sought
SNAP_DEG: Final = 10.0  # rolls below this are taken for none
PUPIL_NOISE_MM: Final = 0.025  # of single edge points: the ruff's scallops
LIMBUS_NOISE_MM: Final = 0.05
UPRIGHT_NOISE_MM: Final = 0.1  # once no roll is sought: else uneven sclera turns an eye 2 degrees


def find_pose(edges: Edges, *, turn: float, limbus_mm: float, distance_mm: float) -> Pose:
    """Fit the model eye to the edges.

    ``turn`` is the coarse direction of the line between the lids' corners, radians, y down;
    ``limbus_mm`` the visible iris's true width: a larger eye is the same picture of the model eye
    at another scale.
    """
    distance_mm = distance_mm * MODEL_LIMBUS_MM / limbus_mm
    turned = _Problem(edges, distance_mm, _roll(turn), math.radians(ROLL_DEG), LIMBUS_NOISE_MM)
    start = _start(edges, turned.roll)
    # Both turns explain a shortened circle alike until the pupil's shift tells them apart.
    sides = (FIRST_TURN, -FIRST_TURN)
    looks = [{**start, "yaw": yaw, "pitch": pitch} for yaw in sides for pitch in sides]
    first = turned.best((np.array([*look.values()]) for look in looks), most=25)
    found = turned.best([first], most=30)
    if abs(turned.pose(found).roll) > math.radians(SNAP_DEG):
        return turned.pose(found)
    # The limbus is too nearly round to tell a small roll from none: the photograph's own vertical.
    upright = _Problem(edges, distance_mm, 0.0, math.radians(UPRIGHT_DEG), UPRIGHT_NOISE_MM)
    return upright.pose(upright.best([found], most=30))


def _start(edges: Edges, roll: float) -> dict[str, float]:
    """Return first values of all parameters: an eye that looks at the camera."""
    limbus, pupil = edges.limbus.ellipse, edges.pupil.ellipse
    scale = limbus.major / float(VISIBLE_LIMBUS_MM[0, 0])
    known = {"x": limbus.x, "y": limbus.y, "log_scale": math.log(scale), "roll": roll}
    known |= {"pupil_mm": pupil.radius / scale / 1.12, "height_ratio": LIMBUS_HEIGHT_RATIO}
    return {name: known.get(name, 0.0) for name in STEPS}


@dataclass(frozen=True)
class _Problem:
    """Two edges, and what is believed of the eye before they are looked at.

    ``roll`` and ``roll_spread`` are radians; ``limbus_noise_mm`` of single points of the limbus.
    """

    edges: Edges
    distance_mm: float
    roll: float
    roll_spread: float
    limbus_noise_mm: float

    def pose(self, values: Array) -> Pose:
        """Return the eye that parameters in the order of STEPS stand for."""
        x, y, scale, yaw, pitch, radius, px, py, ratio, roll, along, across = map(float, values)
        return Pose(
            x=x,
            y=y,
            px_per_mm=math.exp(scale),
            yaw=yaw,
            pitch=pitch,
            roll=roll,
            distance_mm=self.distance_mm,
            pupil_mm=radius,
            pupil_x_mm=px,
            pupil_y_mm=py,
            height_ratio=ratio,
            oval=(along, across),
        )

    def residuals(self, values: Array) -> Array:
        """Return how far the edges and the eye's anatomy lie off, in standard deviations."""
        trial = self.pose(values)
        parts = [
            _apart(edge.points, contour, trial.px_per_mm)
            / noise_mm
            * math.sqrt(FEWER_POINTS / len(edge.points))
            for edge, contour, noise_mm in (
                (self.edges.pupil, trial.pupil(), PUPIL_NOISE_MM),
                (self.edges.limbus, trial.limbus(), self.limbus_noise_mm),
            )
        ]
        softness = self.edges.softness
        soft = [] if softness is None else [softness.errors(trial.roll)]
        return np.concatenate([*parts, *soft, self._unlikely(trial)])

    def _unlikely(self, trial: Pose) -> Array:
        return np.array(
            [
                trial.yaw / math.radians(TILT_DEG),
                trial.pitch / math.radians(TILT_DEG),
                trial.pupil_x_mm / DECENTRE_MM,
                trial.pupil_y_mm / DECENTRE_MM,
                (trial.height_ratio - LIMBUS_HEIGHT_RATIO) / HEIGHT_RATIO,
                (trial.roll - self.roll) / self.roll_spread,
                trial.oval[0] / PUPIL_OVAL,
                trial.oval[1] / PUPIL_OVAL,
            ]
        )

    def best(self, starts: Iterable[Array], *, most: int) -> Array:
        """Return the parameters that fit best of all that starts lead to in ``most`` steps."""
        steps = np.array([*STEPS.values()])
        fits = [
            optimize.least_squares(
                self.residuals, start, x_scale=steps, loss="soft_l1", max_nfev=most
            )
            for start in starts
        ]
        return np.asarray(min(fits, key=lambda fit: float(fit.cost)).x)


def _roll(turn: float) -> float:
    """Return a turn of the lids' axis, y down, as an anticlockwise roll within a right angle."""
    roll = -turn
    while roll <= -math.pi / 2:
        roll += math.pi
    return roll


def _apart(points: Array, contour: Array, px_per_mm: float) -> Array:
    """Return how far points lie outside a closed contour around its mean, in mm."""
    middle = contour.mean(axis=0)
    angle, radius = _polar(contour - middle)
    order = np.argsort(angle)
    at, r = _polar(points - middle)
    return np.asarray(
        (r - np.interp(at, angle[order], radius[order], period=2 * np.pi)) / px_per_mm
    )


def _polar(v: Array) -> tuple[Array, Array]:
    return np.arctan2(v[:, 1], v[:, 0]), np.hypot(v[:, 0], v[:, 1])
