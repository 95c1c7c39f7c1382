"""What a benchmark found: its rows, and ``bench.json``. Pure: no GL, no clock.

``rows`` hold times, as the contract with ``ocularist analyse --bench`` has them; work, start and
memory have lists of their own.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

from renderer.atomic_file import write_atomically

PARTS: Final = (
    *("lods", "effects", "samples", "cubes", "crowd", "aims"),
    *("work", "startup", "memory"),
)


@dataclass(frozen=True, kw_only=True)
class Cost:
    """A time in ms: of a whole frame (``lod``), or of an effect at a level (``effect``, ``level``).

    By the clock that ``About`` names: on software GL wall time until a frame is there, on a GPU its
    own time for a frame that was handed over before. An effect's time is that of a frame with it
    minus that of the same frame without it. ``base`` says of which frame: the LoD that the other
    effects have. ``n`` rounds, ``load`` the machine's load average (1 min) when they ended.

    Of whole frames also what they ask of the processor, medians per frame (``processor``), and on a
    GPU how they follow one another: a rate is 1000 / ``row_ms``.
    """

    part: str
    renderer: str
    size: str
    distance: str
    iris_px: float
    eyes: int
    ms_median: float
    ms_mad: float
    n: int
    load: float
    lod: str | None = None
    effect: str | None = None
    level: str | None = None
    base: str | None = None
    samples: int | None = None  # of the thesis's left sum; 0 is our integrator
    fetches: int | None = None  # of thickness, per pixel of iris
    rms_percent: float | None = None  # of the integrator, against 4000 small steps
    bias_percent: float | None = None
    cube: str | None = None  # static or dynamic; of whole frames a clip's cube_size
    cube_px: int | None = None
    crowd: int | None = None
    processor_ms: float | None = None  # the submitting thread's; on software GL without drawing
    draw_calls: int | None = None
    reads: int | None = None  # pictures and buffers read back, on software GL the frame's own too
    row_ms: float | None = None  # on a GPU: wall time of many frames in a row, each
    wait_ms: float | None = None  # of it in reading back
    gaps: int | None = None  # on a GPU: rounds whose time counts its waiting for commands


@dataclass(frozen=True, kw_only=True)
class Work:
    """What one eye takes, per pixel means over the pixels that it shades.

    Of a LoD, or of an effect at a level: the LoD ``base`` with it minus without it. ``triangles``
    are those of the eye's mesh; fetches and arithmetic are counted as ``counting`` says.
    """

    lod: str | None = None
    effect: str | None = None
    level: str | None = None
    base: str | None = None
    samples: int | None = None
    triangles: int | None = None
    pixels: int
    fetches: float
    arithmetic: float


@dataclass(frozen=True, kw_only=True)
class Stage:
    """Seconds that one stage of setting up took.

    ``cache`` is "cold" (empty), "warm" (of the start before) or "as it is" (the user's).
    """

    lod: str
    cache: str
    stage: str
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Memory:
    """Megabytes (10^6 bytes) of one kind after a LoD's first frame."""

    lod: str
    kind: str
    megabytes: float


@dataclass(frozen=True, kw_only=True)
class About:
    """Under which conditions a benchmark ran: figures mean nothing without them."""

    renderer: str
    gl_version: str
    clock: str  # "wall time" or "timer queries"
    size: str
    code_version: str
    processor: str
    cores: int
    load_before: float
    is_quick: bool
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Bench:
    """Everything that was measured; a part that was not asked for is empty."""

    about: About
    rows: list[Cost] = field(default_factory=list)
    work: list[Work] = field(default_factory=list)
    startup: list[Stage] = field(default_factory=list)
    memory: list[Memory] = field(default_factory=list)

    def of_part(self, part: str) -> list[Cost]:
        """Return the times of one part."""
        return [row for row in self.rows if row.part == part]

    def to_dict(self) -> dict[str, Any]:
        """Return plain JSON types; what a row does not have is left out."""
        lists = {name: getattr(self, name) for name in _ROWS}
        return {"about": asdict(self.about)} | {
            name: [{k: v for k, v in asdict(row).items() if v is not None} for row in rows]
            for name, rows in lists.items()
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Bench:
        """Read what ``to_dict`` wrote; raises KeyError or TypeError for anything else."""
        lists: dict[str, Any] = {
            name: [kind(**row) for row in content[name]] for name, kind in _ROWS.items()
        }
        return cls(about=About(**content["about"]), **lists)


_ROWS: Final[dict[str, type]] = {"rows": Cost, "work": Work, "startup": Stage, "memory": Memory}


def write_bench(bench: Bench, path: Path) -> None:
    """Write ``bench.json``."""
    write_atomically(path, json.dumps(bench.to_dict(), indent=1).encode())


def read_bench(path: Path) -> Bench:
    """Read ``bench.json``; raises ValueError where it is not one of this version's."""
    try:
        return Bench.from_dict(json.loads(path.read_text(encoding="utf-8")))
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise ValueError(
            f"{path}: no result of ocularist bench ({type(error).__name__}: {error}); measure anew"
        ) from None
