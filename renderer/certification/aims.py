"""The aims of a certification: what was wanted, what was reached. Pure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from renderer.certification.metrics import RegionScore
from renderer.certification.plan import (
    FURNACE_PERCENT,
    INSIDE_PERCENT,
    LAYERS_NODES,
    LAYERS_RIVAL,
    PICTURE_NOISE_PERCENT,
    PICTURE_RMS_PERCENT,
)


@dataclass(frozen=True)
class Aim:
    """One aim: ``reached_percent`` may not lie above ``wanted_percent``; ``worst`` says where."""

    words: str
    wanted_percent: float
    reached_percent: float
    worst: str

    @property
    def is_met(self) -> bool:
        """Whether the aim is reached; what is no number reaches nothing."""
        return self.reached_percent <= self.wanted_percent

    def line(self) -> str:
        """Say the aim in one line."""
        verdict = "met   " if self.is_met else "MISSED"
        return (
            f"{verdict} {self.words}: {self.reached_percent:.2f} % ({self.worst}), "
            f"wanted at most {self.wanted_percent:.2f} %"
        )


def aims_of(
    *,
    iris: Mapping[str, RegionScore],
    furnace_percent: Sequence[float],
    suns: Mapping[str, float],
    skies: Mapping[str, float],
    layers: Mapping[str, float],
) -> list[Aim]:
    """Judge the figures: picture scores of the iris by case, and errors in percent by name."""
    rms = {name: max(score.rms_without_noise_percent) for name, score in iris.items()}
    noise = {name: max(score.noise_percent) for name, score in iris.items()}
    channels = dict(zip(("red", "green", "blue"), furnace_percent, strict=True))
    ours, rival = f"pieces {LAYERS_NODES}", f"left sum {LAYERS_RIVAL}"
    return [
        _worst("RMS per channel in the iris, soft light", PICTURE_RMS_PERCENT, rms),
        _worst("the reference's own noise there", PICTURE_NOISE_PERCENT, noise),
        _worst("furnace: mean of an even iris", FURNACE_PERCENT, channels),
        _worst("sun's caustic: mean irradiance inside", INSIDE_PERCENT, suns),
        _worst("surroundings' light: mean irradiance inside", INSIDE_PERCENT, skies),
        Aim(f"layers: RMS of {ours} beside the {rival}", layers[rival], layers[ours], ours),
    ]


def _worst(words: str, wanted: float, errors: Mapping[str, float]) -> Aim:
    name = max(errors, key=lambda key: abs(errors[key]))
    return Aim(words, wanted, abs(errors[name]), name)
