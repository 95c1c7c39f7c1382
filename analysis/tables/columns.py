"""The columns of the tables: name, kind, unit, meaning and accepted values, as data.

Everything that writes, reads or describes ``ratings.csv``, ``comparisons.csv`` or
``participants.csv`` takes its columns from here: the export, ``codebook`` and the reader.
Pure vocabulary: no pandas, no files. Missing is empty, never zero. Left and right are the
viewer's, as seen on the screen.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from analysis.tables.check_columns import CHECKS
from analysis.tables.column import Column

EFFECTS: Final = (
    "texture",
    "refraction",
    "reflection",
    "subsurface",
    "caustics",
    "tessellation",
    "sclera",
)
LEVELS: Final = ("off", "low", "medium", "high", "ultra")
STANDARD_LODS: Final = ("low", "medium", "high", "ultra")
DISTANCES: Final = ("macroscopic", "near", "medium", "far")
EYES: Final = ("left", "right")
WIDEST_PX: Final = 7680
"""The widest picture: an iris of more pixels is a slip of the pen."""
NOTICED: Final = ("yes", "unsure", "no")
SCALE: Final = (1, 5)
"""Lowest and highest rating of the thesis's scale (Appendix B, question 4)."""

_WHO: Final = (
    Column("study", "text", "name of the study"),
    Column("study_version", "text", "version of the study's definition"),
    Column("simulated", "boolean", "true if the answers come from a simulated observer"),
    Column(
        "participant", "text", "pseudonym of the participant", required=True, may_be_empty=False
    ),
)

_TRIAL: Final = (
    Column("session", "text", "one sitting of the participant"),
    Column("trial", "text", "one clip shown to one participant, with its answers"),
    Column("position", "integer", "place of the trial in the session, from 1", low=1),
    Column("clip", "text", "name of the clip in the study's definition"),
    Column(
        "distance",
        "text",
        "viewing distance, from closest to farthest: " + ", ".join(DISTANCES),
    ),
    Column(
        "iris_px",
        "number",
        "diameter of the iris in the clip's pixels",
        "px",
        low=0,
        high=WIDEST_PX,
    ),
    Column("iris_deg", "number", "angle of the iris at the participant's eye", "degree", low=0),
    Column("iris_deg_se", "number", "standard error of iris_deg", "degree", low=0),
    Column("shown_scale", "number", "device pixels shown per pixel of the clip", "ratio", low=0),
    Column("shown_scale_se", "number", "standard error of shown_scale", "ratio", low=0),
    Column(
        "orbit_direction",
        "category",
        "the camera's way around the head, as the viewer sees it",
        choices=("rightward", "leftward"),
    ),
    Column("iris", "text", "name of the iris in the study's definition, where it has several"),
    Column("iris_seed", "integer", "number from which the iris was made", low=0),
    Column("iris_colour", "text", 'colour of the iris; "photograph" if it was taken from one'),
    Column("crowd", "integer", "number of other characters in the scene", low=0),
)

_CIRCUMSTANCES: Final = (
    Column("is_practice", "boolean", "true for a practice trial; left out of every analysis"),
    Column("is_catch", "boolean", "true if both eyes had the same LoD"),
    Column("is_warm_up", "boolean", "true for one of the first trials, as the study flags them"),
    Column(
        "is_gold",
        "boolean",
        "true for an obvious pair that only shows who looks; left out of every analysis",
    ),
    Column("certified", "boolean", "true if the clip's presentation passed the study's rule"),
    Column(
        "uncertified_because",
        "text",
        "why no presentation passed, words apart by spaces; empty where one did",
    ),
    Column("dropped_frames", "integer", "frames that the browser did not present", "frame", low=0),
    Column("views", "integer", "how often the clip was watched", low=0),
    Column("response_ms", "integer", "from the clip's first frame to the answer", "ms", low=0),
    Column("clock_ms", "number", "coarseness of the clock behind response_ms", "ms", low=0),
    Column("started_at", "time", "when the trial began", "ISO 8601, UTC"),
)

RATINGS: Final = (
    *_WHO,
    *_TRIAL,
    Column("eye", "category", "the rated eye, as the viewer sees it", choices=EYES),
    Column("lod", "text", "LoD of the rated eye", required=True, may_be_empty=False),
    Column(
        "lod_rank", "integer", "1 low to 4 ultra; empty for a LoD that a study names", low=1, high=9
    ),
    Column("other_lod", "text", "LoD of the other eye in the same clip"),
    *(
        Column(effect, "category", f"level of {effect} in the rated eye", choices=LEVELS)
        for effect in EFFECTS
    ),
    Column(
        "rating",
        "integer",
        "realism, 1 completely unrealistic to 5 almost or completely photorealistic",
        low=SCALE[0],
        high=SCALE[1],
        required=True,
    ),
    *_CIRCUMSTANCES,
)

COMPARISON_TABLE: Final = (
    *_WHO,
    *_TRIAL,
    Column("left_lod", "text", "LoD of the left eye", required=True, may_be_empty=False),
    Column("right_lod", "text", "LoD of the right eye", required=True, may_be_empty=False),
    Column(
        "comparison",
        "integer",
        "right relative to left: -1 less realistic, 0 no difference, 1 more realistic",
        low=-1,
        high=1,
    ),
    Column(
        "noticed",
        "category",
        "was anything missing or different between the eyes",
        choices=NOTICED,
    ),
    Column("what_differed", "text", "what was different, in the participant's words"),
    Column("comments", "text", "other comments, in the participant's words"),
    *_CIRCUMSTANCES,
)

PARTICIPANTS: Final = (
    _WHO[3],
    *_WHO[:3],
    Column("started_at", "time", "when consent was given", "ISO 8601, UTC"),
    Column("completed_at", "time", "when the last answer was stored", "ISO 8601, UTC"),
    Column("status", "text", "how far the participant came"),
    Column(
        "outcome",
        "category",
        "how taking part ended; empty while it has not",
        choices=("completed", "screened_out", "failed_checks"),
    ),
    Column("language", "text", "language in which the participant read the study"),
    Column("works_with_graphics", "category", "works with graphics", choices=("yes", "no")),
    Column("last_played", "text", "when the participant last played a computer game"),
    Column("age", "integer", "age", "year", low=0, high=130),
    Column("gender", "text", "gender, as the participant states it"),
    Column("eyesight", "text", "eyesight, as the participant states it"),
    Column("screen_width", "integer", "width of the screen", "CSS px", low=0),
    Column("screen_height", "integer", "height of the screen", "CSS px", low=0),
    Column("pixel_ratio", "number", "device pixels per CSS pixel", "ratio", low=0),
    Column("user_agent_family", "text", "family of the browser"),
    *CHECKS,
    Column("arm", "text", "arm of the schedule that the participant was assigned to"),
    Column("block", "integer", "which share of the study's clips the participant saw", low=1),
    Column("order_row", "integer", "row of the Latin square of orders", low=1),
    Column("order_code", "text", "from which ocularist check --order tells the trials again"),
    Column("gold_passed", "integer", "gold trials answered as expected", "trial", low=0),
    Column("gold_failed", "integer", "gold trials answered otherwise", "trial", low=0),
    Column("attention_passed", "integer", "attention questions answered as told", low=0),
    Column("attention_failed", "integer", "attention questions answered otherwise", low=0),
)

COLUMNS: Final[Mapping[str, tuple[Column, ...]]] = MappingProxyType(
    {"ratings": RATINGS, "comparisons": COMPARISON_TABLE, "participants": PARTICIPANTS}
)


def column_names(table: str) -> tuple[str, ...]:
    """Return the names of a table's columns in the order in which they are written."""
    return tuple(column.name for column in COLUMNS[table])
