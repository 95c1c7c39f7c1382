"""Which plays of a clip count: the study's rule, judged on the raw record that a browser sends.

A record (``static/certificate.js`` writes it) says what was presented, for how long, at which size,
and what came between. The rule is part of the study file, so it stands before anybody takes part.
Pure: a record and a rule go in, a verdict comes out; what a record does not tell is not held
against it, except the frames themselves: uncounted frames certify nothing. ``counted_by`` says what
``presented_frames`` is: with "frames" what was presented; with "callbacks" what is known of it, and
more may have been; with "quality" what was decoded and not dropped, and less may have been.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final

from pydantic import Field

from study.design.parts import Flag, Part, Real, Whole

Play = Mapping[str, Any]
# The first frame lies under the curtain until the second one lifts it: browsers may present it
# before they begin to count (measured in Chromium, video-rvfc leaves it open).
UNCOUNTED_FRAMES: Final = 1


class Certificate(Part):
    """What may go wrong at most while a clip is shown, and how often people are asked again.

    Shares are of the clip's frames, its duration and its size. Dropped: 1 %, one frame in a clip of
    five seconds.
    """

    max_dropped_share: Annotated[Real, Field(ge=0, le=1)] = 0.01
    max_gap_ms: Annotated[Real, Field(gt=0)] = 150.0
    duration_tolerance: Annotated[Real, Field(ge=0)] = 0.1
    scale_tolerance: Annotated[Real, Field(ge=0)] = 0.01
    may_lose_focus: Flag = False
    may_be_windowed: Flag = True
    retries: Annotated[Whole, Field(ge=0, le=5)] = 2


@dataclass(frozen=True)
class Verdict:
    """Whether a play counts: None if all is well but its frames. ``reasons`` say why not."""

    certified: bool | None
    reasons: tuple[str, ...] = ()


REASONS: Final[Mapping[str, str]] = {
    "incomplete": "the clip was not played to its end",
    "not-counted": "the browser does not tell of every frame whether it was presented",
    "frames-missing": "not every frame is known to have been presented",
    "frames-dropped": "the browser dropped frames",
    "gap": "for too long no frame was presented",
    "stalled": "the clip stood still while the browser waited for data",
    "paused": "the clip was paused",
    "sought": "the clip was moved to another place",
    "speed": "the clip ran faster or slower than it should",
    "hidden": "the page was hidden",
    "unfocused": "another window had the focus",
    "windowed": "the page did not fill the screen",
    "scaled": "the clip was not shown pixel for pixel",
    "cut-off": "part of the clip lay outside the window",
    "other-clip": "the file was not the clip of the trial",
}


def judge(play: Play, rule: Certificate) -> Verdict:
    """Apply a study's rule to the raw record of one play."""
    reasons = tuple(reason for reason, fails in _CHECKS.items() if fails(play, rule))
    return Verdict(None if reasons == ("not-counted",) else not reasons, reasons)


def judge_trial(plays: Iterable[Play], rule: Certificate) -> Verdict:
    """Apply the rule to the plays of one trial: one that counts is enough.

    Without one the reasons are those of the play that came nearest, the later of two alike.
    """
    nearest: Verdict | None = None
    for play in plays:
        verdict = judge(play, rule)
        if verdict.certified:
            return verdict
        if nearest is None or _distance(verdict) <= _distance(nearest):
            nearest = verdict
    return nearest or Verdict(None)


def _distance(verdict: Verdict) -> tuple[bool, int]:
    """Order verdicts that certify nothing; one on counted frames says more than one on none."""
    return verdict.certified is None, len(verdict.reasons)


def number(play: Play, name: str) -> float | None:
    """Return a finite number from 0 on out of a record, or None for anything else."""
    value = play.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if math.isfinite(value) and value >= 0 else None


def _over(name: str, most: float, play: Play) -> bool:
    found = number(play, name)
    return found is not None and found > most


def _is_uncounted(play: Play, rule: Certificate) -> bool:
    enough, by = _are_enough(play, rule), play.get("counted_by")
    return enough is None or (by == "callbacks" and not enough) or (by == "quality" and enough)


def _frames_missing(play: Play, rule: Certificate) -> bool:
    return _are_enough(play, rule) is False and play.get("counted_by") != "callbacks"


def _are_enough(play: Play, rule: Certificate) -> bool | None:
    """Say whether as many frames are told of as the rule wants; None where nothing is told."""
    expected, presented = number(play, "expected_frames"), number(play, "presented_frames")
    if not expected or presented is None:
        return None
    return presented >= expected * (1 - rule.max_dropped_share) - UNCOUNTED_FRAMES


def _frames_dropped(play: Play, rule: Certificate) -> bool:
    expected = number(play, "expected_frames")
    return bool(expected) and _over(
        "dropped_frames", rule.max_dropped_share * (expected or 0), play
    )


def _ran_at_another_speed(play: Play, rule: Certificate) -> bool:
    """Compare the wall clock with the clip's own between the first and the last frame."""
    rates = (number(play, "min_rate"), number(play, "max_rate"))
    if any(rate is not None and rate != 1 for rate in rates):
        return True
    wall_ms, media_ms = number(play, "wall_ms"), number(play, "media_ms")
    expected, fps = number(play, "expected_frames"), number(play, "expected_fps")
    if wall_ms is None or media_ms is None or not expected or not fps:
        return False
    # A screen shows a frame at its next refresh: either end may come a frame late.
    allowed_ms = rule.duration_tolerance * 1000 * expected / fps + 1000 / fps
    return abs(wall_ms - media_ms) > allowed_ms


def _was_scaled(play: Play, rule: Certificate) -> bool:
    scale = number(play, "shown_scale")
    # Records give four decimals: what is on the border is inside.
    is_off = scale is not None and round(abs(scale - 1), 4) > rule.scale_tolerance
    return is_off or _over("resizes", 0, play)


def _visible(play: Play) -> float:
    found = number(play, "visible_share")
    return 1.0 if found is None else found


def _is_other_clip(play: Play, _rule: Certificate) -> bool:
    wanted = play.get("expected_sha256")
    return bool(wanted) and play.get("clip_sha256", wanted) != wanted


_CHECKS: Final[Mapping[str, Callable[[Play, Certificate], bool]]] = {
    "incomplete": lambda play, _: not play.get("is_complete"),
    "not-counted": _is_uncounted,
    "frames-missing": _frames_missing,
    "frames-dropped": _frames_dropped,
    "gap": lambda play, rule: _over("max_gap_ms", rule.max_gap_ms, play),
    "stalled": lambda play, rule: _over("stalled_ms", rule.max_gap_ms, play),
    "paused": lambda play, _: _over("pauses", 0, play),
    "sought": lambda play, _: _over("seeks", 0, play),
    "speed": _ran_at_another_speed,
    "hidden": lambda play, _: bool(play.get("was_hidden")) or _over("hidden_ms", 0, play),
    "unfocused": lambda play, rule: not rule.may_lose_focus and _over("unfocused_ms", 0, play),
    "windowed": lambda play, rule: not rule.may_be_windowed and _over("windowed_ms", 0, play),
    "scaled": _was_scaled,
    "cut-off": lambda play, rule: _visible(play) < 1 - rule.scale_tolerance,
    "other-clip": _is_other_clip,
}
