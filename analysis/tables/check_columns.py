"""The columns of the checks before the clips; empty where a study has no such check."""

from __future__ import annotations

from typing import Final

from analysis.tables.column import Column

CHECKS: Final = (
    Column("refresh_hz", "number", "frames that the screen shows", "1/s", low=0),
    Column("refresh_jitter_ms", "number", "how irregularly frames come (scaled MAD)", "ms", low=0),
    Column("zoom", "number", "zoom of the page when it was checked", "ratio", low=0),
    Column("colour_error", "number", "largest error of the test clip's colours", "of 255", low=0),
    Column("codec", "text", "codec of the test clip that the browser decoded"),
    Column("is_decoding_smooth", "boolean", "true if the browser expects to decode smoothly"),
    Column("mbit_s", "number", "rate at which clips arrived", "Mbit/s", low=0),
    Column("dark_steps", "integer", "near-black squares seen of 5", low=0, high=5),
    Column("light_steps", "integer", "near-white squares seen of 5", low=0, high=5),
    Column("night_light", "category", "night light, as stated", choices=("off", "on", "unknown")),
    Column("hdr", "category", "HDR, as stated", choices=("off", "on", "unknown")),
    Column("remote_hints", "integer", "hints at a remote desktop", low=0, high=3),
    Column("device_faults", "text", "items of the screen check that were found bad"),
    Column(
        "scale_method",
        "category",
        "how the pixels' size was found",
        choices=("card", "diagonal", "skipped"),
    ),
    Column("mm_per_px", "number", "size of a device pixel", "mm", low=0),
    Column("mm_per_px_se", "number", "standard error of mm_per_px", "mm", low=0),
    Column(
        "distance_method",
        "category",
        "how the viewing distance was found",
        choices=("blind_spot", "skipped", "not_asked"),
    ),
    Column("view_dist_cm", "number", "distance from eye to screen", "cm", low=0),
    Column("view_dist_cm_se", "number", "standard error of view_dist_cm", "cm", low=0),
    Column("calibration_skipped", "text", "why a part of the calibration was left out"),
    Column(
        "eyesight_test", "category", "whether eyesight was tested", choices=("taken", "refused")
    ),
    Column("glasses", "category", "glasses, as stated", choices=("none", "worn", "not_worn")),
    Column("smallest_gap_px", "integer", "smallest ring's gap that was told", "device px", low=0),
    Column("smallest_gap_arcmin", "number", "the same as an angle", "arc minute", low=0),
    Column("gap_limit_arcmin", "number", "smallest gap that the screen shows", "arc minute", low=0),
    Column("control_plates_read", "integer", "control plates read of 1", low=0, high=1),
    Column("protan_plates_read", "integer", "plates for protans read of 2", low=0, high=2),
    Column("deutan_plates_read", "integer", "plates for deutans read of 2", low=0, high=2),
    Column("tritan_plates_read", "integer", "plates for tritans read of 1", low=0, high=1),
)
