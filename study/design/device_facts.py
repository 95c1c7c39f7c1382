"""What the tables tell of a participant's screen: the columns that follow from its check."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from study.design.device_check import DeviceReport, Finding, remote_hints
from study.design.patches import steps_seen


def device_facts(report: DeviceReport, found: Sequence[Finding], *, seed: int) -> dict[str, Any]:
    """Return the columns of the participant's table; ``seed`` is that of the test pattern."""
    return {
        "refresh_hz": report.refresh_hz,
        "refresh_jitter_ms": report.refresh_jitter_ms,
        "zoom": report.zoom,
        "colour_error": report.colour_error,
        "codec": report.codec or None,
        "is_decoding_smooth": report.is_smooth,
        "mbit_s": report.mbit_s,
        "dark_steps": steps_seen(report.dark_counted, seed, "dark"),
        "light_steps": steps_seen(report.light_counted, seed, "light"),
        "night_light": report.night_light,
        "hdr": report.hdr,
        "remote_hints": len(remote_hints(report)),
        "device_faults": " ".join(one.item for one in found if one.verdict == "bad") or None,
    }
