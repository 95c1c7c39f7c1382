"""The check of screen, browser and connection: what a study wants, and what a browser reports.

Pure. Every item is found good, bad or unknown; a study says which items are required (the gate)
and which are only recorded. What could not be measured never holds anybody up.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from study.design.parts import Flag, Part, Real, Size, Whole
from study.design.patches import LEAST_SEEN, STEPS, colour_error, steps_seen

Required = Literal["screen", "window", "refresh", "decoder", "bandwidth", "contrast", "light"]
Item = Literal["device", Required, "remote"]
Verdict = Literal["good", "bad", "unknown", "open"]
"""``open`` is an item that a person has to answer and has not."""

COLOUR_DEPTH_BITS: Final = 24
REMOTE_REFRESH_HZ: Final = 40.0
REMOTE_JITTER_MS: Final = 6.0


class DeviceCheck(Part):
    """What a study wants of a screen. Phones are refused unless it allows them."""

    required: tuple[Required, ...] = ("screen",)
    allow_phones: Flag = False
    min_refresh_hz: Annotated[Real, Field(ge=1, le=500)] = 50.0
    max_colour_error: Annotated[Real, Field(ge=0, le=255)] = 3.0
    min_mbit_s: Annotated[Real, Field(gt=0, le=10_000)] = 5.0
    min_steps: Annotated[Whole, Field(ge=1, le=len(STEPS))] = LEAST_SEEN
    tries: Annotated[Whole, Field(ge=1, le=10)] = 2


Pixels = Annotated[int, Field(ge=1, le=100_000)]
Colour = tuple[float, float, float]
Answer = Literal["off", "on", "unknown"]


class DeviceReport(BaseModel):
    """What a browser found; None is what it could not find out. Pixels are device pixels."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    screen_width_px: Pixels
    screen_height_px: Pixels
    window_width_px: Pixels
    window_height_px: Pixels
    pixel_ratio: Annotated[float, Field(gt=0, le=20)]
    zoom: Annotated[float, Field(gt=0, le=20)] | None = None
    is_phone: bool = False
    refresh_hz: Annotated[float, Field(gt=0, le=2000)] | None = None
    refresh_jitter_ms: Annotated[float, Field(ge=0, le=60_000)] | None = None
    colour_depth: Annotated[int, Field(ge=1, le=128)] | None = None
    dynamic_range: Literal["standard", "high"] | None = None
    colour_gamut: Literal["srgb", "p3", "rec2020"] | None = None
    reduced_motion: bool | None = None
    codec: Annotated[str, Field(max_length=60, pattern=r"^[\x20-\x7e]*$")] = ""
    is_smooth: bool | None = None
    is_power_efficient: bool | None = None
    patches: Annotated[tuple[Colour, ...], Field(max_length=64)] = ()
    mbit_s: Annotated[float, Field(ge=0, le=1_000_000)] | None = None
    dark_counted: Annotated[int, Field(ge=0, le=20)] | None = None
    light_counted: Annotated[int, Field(ge=0, le=20)] | None = None
    night_light: Answer | None = None
    hdr: Answer | None = None

    @property
    def colour_error(self) -> float | None:
        """The largest error of any patch of the self-test's clip, in steps of 255."""
        return colour_error(self.patches)


@dataclass(frozen=True)
class Finding:
    """What came of one item."""

    item: Item
    verdict: Verdict
    is_required: bool

    @property
    def stops(self) -> bool:
        """True if nobody goes on with this."""
        return self.is_required and self.verdict in ("bad", "open")


def findings(
    check: DeviceCheck, report: DeviceReport, *, sizes: Sequence[Size], seed: int
) -> tuple[Finding, ...]:
    """Judge a report item by item, in the page's order; ``seed`` is that of its test pattern."""
    dark = steps_seen(report.dark_counted, seed, "dark")
    light = steps_seen(report.light_counted, seed, "light")
    verdicts: dict[Item, Verdict] = {
        "device": "bad" if report.is_phone and not check.allow_phones else "good",
        "screen": _said(largest_fitting(report, sizes) is not None),
        "window": _unless_unknown(report.zoom, lambda zoom: abs(zoom - 1) < 0.02),
        "refresh": _unless_unknown(report.refresh_hz, lambda hz: hz >= check.min_refresh_hz),
        "decoder": _unless_unknown(report.colour_error, lambda e: e <= check.max_colour_error),
        "bandwidth": _unless_unknown(report.mbit_s, lambda rate: rate >= check.min_mbit_s),
        "contrast": _answered([None if s is None else s >= check.min_steps for s in (dark, light)]),
        "light": _answered([a and a != "on" for a in (report.night_light, report.hdr)]),
        "remote": "bad" if len(remote_hints(report)) > 1 else "good",
    }
    required = {"device", *check.required}
    return tuple(Finding(item, verdict, item in required) for item, verdict in verdicts.items())


def _said(is_good: bool) -> Verdict:
    return "good" if is_good else "bad"


def _unless_unknown(value: float | None, is_good: Callable[[float], bool]) -> Verdict:
    return "unknown" if value is None else _said(is_good(value))


def _answered(answers: Sequence[bool | None]) -> Verdict:
    """Judge answers of a person: each good, bad, or None where it is missing."""
    return "open" if None in answers else _said(all(answers))


def largest_fitting(report: DeviceReport, sizes: Sequence[Size]) -> Size | None:
    """Return the largest clip size that the full screen shows pixel for pixel, or None."""
    fitting = [
        size
        for size in sizes
        if size.width <= report.screen_width_px and size.height <= report.screen_height_px
    ]
    return max(fitting, key=lambda size: size.width * size.height, default=None)


def remote_hints(report: DeviceReport) -> tuple[str, ...]:
    """Return what hints at a screen shown over a network; one alone says nothing."""
    depth, hertz = report.colour_depth, report.refresh_hz
    jitter_ms = report.refresh_jitter_ms
    hints = {
        "colour_depth": depth is not None and depth < COLOUR_DEPTH_BITS,
        "refresh": hertz is not None and hertz < REMOTE_REFRESH_HZ,
        "jitter": jitter_ms is not None and jitter_ms > REMOTE_JITTER_MS,
    }
    return tuple(name for name, is_there in hints.items() if is_there)
