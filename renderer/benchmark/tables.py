"""The benchmark as tables, one or two for each part. Pure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from renderer.benchmark.effects import is_none
from renderer.benchmark.result import Bench, Cost, Work
from renderer.detail import EFFECTS, STANDARD_LODS

NOTHING: Final = "-"  # not measured


@dataclass(frozen=True)
class Table:
    """A title, a note that says how to read it, a head and rows of cells; the first is a name."""

    title: str
    note: str
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


def tables_of(bench: Bench) -> list[Table]:
    """Return a table for every part that was measured."""
    makers: tuple[Callable[[Bench], list[Table]], ...] = (
        _lods, _effects, _samples, _cubes, _crowd, _work, _startup, _memory,
    )  # fmt: skip
    return [table for make in makers for table in make(bench) if table.rows]


def _lods(bench: Bench) -> list[Table]:
    cell = {(row.distance, row.eyes, row.lod): row for row in bench.of_part("lods")}
    places = list(dict.fromkeys((distance, eyes) for distance, eyes, _ in cell))
    iris = {(row.distance, row.eyes): row.iris_px for row in cell.values()}
    rows = [
        (
            f"{place[0]}, {_eyes(place[1])}",
            f"{iris[place]:.0f}",
            *(_frames(cell.get((*place, lod))) for lod in STANDARD_LODS),
        )
        for place in places
    ]
    note = "Whole frames: median ms ± MAD over the orbit, and frames/s."
    return [Table("Frames by LoD", note, ("", "iris px", *STANDARD_LODS), rows)]


def _effects(bench: Bench) -> list[Table]:
    cell = {(row.base, row.effect, row.level): row for row in bench.of_part("effects")}
    tables = []
    for base in dict.fromkeys(base for base, _, _ in cell):
        rows = [
            (
                effect,
                *(
                    "none" if is_none(effect, level) else _ms(cell.get((base, effect, level)))
                    for level in STANDARD_LODS
                ),
            )
            for effect in EFFECTS
        ]
        note = f"ms with the effect minus without it, ± MAD; all other effects at {base}; one eye."
        tables.append(Table(f"Effects, from {base}", note, ("", *STANDARD_LODS), rows))
    return tables


def _samples(bench: Bench) -> list[Table]:
    counted: dict[tuple[str | None, int | None], Work] = {
        (work.level, work.samples): work for work in bench.work if work.samples is not None
    }
    rows = []
    for row in bench.of_part("samples"):
        work = counted.get((row.level, row.samples))
        rows.append(
            (
                f"left sum, {row.samples} samples" if row.samples else f"ours at {row.level}",
                str(row.fetches),
                f"{work.arithmetic:.0f}" if work else NOTHING,
                _ms(row),
                f"{row.rms_percent:.2f}",
                f"{row.bias_percent:+.2f}",
            )
        )
    note = "ms: subsurface minus none, one ultra eye. Error in % of the mean against 4000 steps."
    head = ("", "fetches", "arithmetic", "ms", "rms %", "bias %")
    return [Table("Subsurface: samples against our integrator", note, head, rows)]


def _cubes(bench: Bench) -> list[Table]:
    found = bench.of_part("cubes")
    cell = {(row.cube_px, row.cube): row for row in found if row.effect}
    sizes = dict.fromkeys(size for size, _ in cell)
    rows = [
        (f"{size} px", *(_ms(cell.get((size, kind))) for kind in ("static", "dynamic")))
        for size in sizes
    ]
    note = "ms with the reflection minus none, ± MAD; one ultra eye."
    clips = [(f"{row.cube}, {row.cube_px} px", _ms(row), _fps(row)) for row in found if row.lod]
    whole = "Whole frames of two ultra eyes: cubes of Table 5.1's size, and of what the size shows."
    return [
        Table("Cube maps by size of a face", note, ("", "static", "dynamic"), rows),
        Table("Cube maps in clips", whole, ("cube_size", "ms", "frames/s"), clips),
    ]


def _crowd(bench: Bench) -> list[Table]:
    found = bench.of_part("crowd")
    rows = [
        (
            f"{row.crowd} people",
            row.distance,
            f"{row.eyes} {row.lod}",
            _ms(row),
            _fps(row),
        )
        for row in found
    ]
    note = (
        "Whole frames. At a distance: two ultra eyes and so many other people in the scene. Group: "
        "so many people who face the camera, each eye at the LoD that its size asks for."
    )
    return [Table("Crowd", note, ("", "distance", "eyes", "ms", "frames/s"), rows)]


def _work(bench: Bench) -> list[Table]:
    lods = [
        (
            str(work.lod),
            f"{work.triangles}",
            f"{work.pixels}",
            f"{work.fetches:.1f}",
            f"{work.arithmetic:.0f}",
        )
        for work in bench.work
        if work.lod
    ]
    effects = {(w.effect, w.level): w for w in bench.work if w.effect and w.samples is None}
    rows = [
        (
            effect,
            *(
                "none" if is_none(effect, level) else _counts(effects.get((effect, level)))
                for level in STANDARD_LODS
            ),
        )
        for effect in EFFECTS
        if effects
    ]
    note = "One eye at macroscopic; per pixel means over those that it shades (docs/benchmark.md)."
    head = ("", "triangles", "pixels", "fetches/pixel", "arithmetic/pixel")
    added = "fetches + arithmetic per pixel where the effect acts, with minus without, from ultra."
    return [
        Table("Work of one eye", note, head, lods),
        Table("Work of each effect", added, ("", *STANDARD_LODS), rows),
    ]


def _startup(bench: Bench) -> list[Table]:
    cell = {(stage.stage, stage.cache): stage.seconds for stage in bench.startup}
    stages = list(dict.fromkeys(stage for stage, _ in cell))
    caches = tuple(dict.fromkeys(cache for _, cache in cell))
    rows = [(name, *(f"{cell[name, cache]:.2f}" for cache in caches)) for name in stages]
    if rows:
        rows.append(
            ("sum", *(f"{sum(cell[name, cache] for name in stages):.2f}" for cache in caches))
        )
    note = "Seconds per stage with empty caches (cold) and full ones (warm); two ultra eyes."
    if caches == ("as it is",):
        note = "Seconds per stage with the user's cache as it is; two ultra eyes."
    return [Table("Start", note, ("", *caches), rows)]


def _memory(bench: Bench) -> list[Table]:
    cell = {(item.kind, item.lod): item.megabytes for item in bench.memory}
    lods = [lod for lod in STANDARD_LODS if any(lod == item.lod for item in bench.memory)]
    rows = [
        (kind, *(f"{cell[kind, lod]:.0f}" for lod in lods))
        for kind in dict.fromkeys(kind for kind, _ in cell)
    ]
    note = "MB of GL's objects, and of the process with everything in it; two eyes at macroscopic."
    return [Table("Memory", note, ("", *lods), rows)]


def _eyes(number: int) -> str:
    return "one eye" if number == 1 else f"{number} eyes"


def _frames(row: Cost | None) -> str:
    return f"{_ms(row)} ({_fps(row)}/s)" if row else NOTHING


def _fps(row: Cost) -> str:
    return f"{1000 / row.ms_median:.3g}" if row.ms_median > 0 else NOTHING


def _ms(row: Cost | None) -> str:
    return f"{row.ms_median:.1f} ± {row.ms_mad:.1f}" if row else NOTHING


def _counts(work: Work | None) -> str:
    return f"{work.fetches:+.1f} {work.arithmetic:+.0f}" if work else NOTHING
