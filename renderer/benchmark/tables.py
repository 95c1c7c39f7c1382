"""The benchmark as tables, one or more for each part. Pure."""

from __future__ import annotations

from collections.abc import Callable

from renderer.benchmark.cells import NOTHING, Table, counts, ms
from renderer.benchmark.effects import is_none
from renderer.benchmark.frame_tables import aim_tables, clip_cube_tables, crowd_tables, lod_tables
from renderer.benchmark.result import Bench, Work
from renderer.detail import EFFECTS, STANDARD_LODS


def tables_of(bench: Bench) -> list[Table]:
    """Return a table for every part that was measured."""
    makers: tuple[Callable[[Bench], list[Table]], ...] = (
        lod_tables, _effects, _samples, _cubes, clip_cube_tables, crowd_tables, aim_tables, _work,
        _startup, _memory,
    )  # fmt: skip
    return [table for make in makers for table in make(bench) if table.rows]


def _effects(bench: Bench) -> list[Table]:
    cell = {(row.base, row.effect, row.level): row for row in bench.of_part("effects")}
    tables = []
    for base in dict.fromkeys(base for base, _, _ in cell):
        rows = [
            (
                effect,
                *(
                    "none" if is_none(effect, level) else ms(cell.get((base, effect, level)))
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
                ms(row),
                f"{row.rms_percent:.2f}",
                f"{row.bias_percent:+.2f}",
            )
        )
    note = "ms: subsurface minus none, one ultra eye. Error in % of the mean against 4000 steps."
    head = ("", "fetches", "arithmetic", "ms", "rms %", "bias %")
    return [Table("Subsurface: samples against our integrator", note, head, rows)]


def _cubes(bench: Bench) -> list[Table]:
    cell = {(row.cube_px, row.cube): row for row in bench.of_part("cubes") if row.effect}
    sizes = dict.fromkeys(size for size, _ in cell)
    rows = [
        (f"{size} px", *(ms(cell.get((size, kind))) for kind in ("static", "dynamic")))
        for size in sizes
    ]
    note = "ms with the reflection minus none, ± MAD; one ultra eye."
    return [Table("Cube maps by size of a face", note, ("", "static", "dynamic"), rows)]


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
                "none" if is_none(effect, level) else counts(effects.get((effect, level)))
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
