"""Tables of whole frames: LoDs, clips' cubes, crowds, aims, and what bounds their rates. Pure."""

from __future__ import annotations

from typing import Final

from renderer.benchmark.cells import NOTHING, Table, frames, is_on_gpu, ms, processor, rate
from renderer.benchmark.result import Bench, Cost
from renderer.benchmark.verdicts import GPU_AIMS, bound_by, software_aims
from renderer.detail import STANDARD_LODS

THESIS: Final = "The thesis's Table 5.1, on a GTX 680: about 999, 700, 200 and 50 frames/s."
MADE_OF: Final = {
    False: "Whole frames: median ms ± MAD over the orbit, and frames/s.",
    True: "Whole frames: the GPU's median ms ± MAD over the orbit, and frames/s in a row.",
}
ASKED_OF: Final = {
    False: (
        "The submitting thread's own ms per frame and draw calls, rehearsed without software GL's "
        "drawing, with the choice of parts that saves it shading. A GPU is spared that: see the "
        "aims."
    ),
    True: (
        "The submitting thread's own ms per frame, driver included, draw calls, and what bounds "
        "the rate in a row: the longer of this and the GPU's ms; waiting for read-backs; neither, "
        "where a row takes a quarter longer than both (other threads of the driver, other work)."
    ),
}


def lod_tables(bench: Bench) -> list[Table]:
    """Return the frames of each LoD by distance and eyes, and what they ask of the processor."""
    found = bench.of_part("lods")
    cell = {(row.distance, row.eyes, row.lod): row for row in found}
    places = list(dict.fromkeys((distance, eyes) for distance, eyes, _ in cell))
    iris = {(row.distance, row.eyes): f"{row.iris_px:.0f}" for row in found}
    names = [f"{distance}, {_eyes(eyes)}" for distance, eyes in places]
    own = [[cell.get((*place, lod)) for lod in STANDARD_LODS] for place in places]
    timed = [
        (name, iris[place], *map(frames, row))
        for name, place, row in zip(names, places, own, strict=True)
    ]
    asked = [
        (name, *map(processor, row))
        for name, row in zip(names, own, strict=True)
        if any(one and one.processor_ms is not None for one in row)
    ]
    is_gpu = is_on_gpu(found)
    return [
        Table(
            "Frames by LoD", f"{MADE_OF[is_gpu]} {THESIS}", ("", "iris px", *STANDARD_LODS), timed
        ),
        Table("The processor by LoD", ASKED_OF[is_gpu], ("", *STANDARD_LODS), asked),
    ]


def clip_cube_tables(bench: Bench) -> list[Table]:
    """Return whole frames with the cubes that a clip's ``cube_size`` gives."""
    found = [row for row in bench.of_part("cubes") if row.lod]
    note = "Whole frames of two ultra eyes: cubes of Table 5.1's size, and of what the size shows."
    rows = [(f"{row.cube}, {row.cube_px} px", *_whole(row, found)) for row in found]
    return [Table("Cube maps in clips", note, ("cube_size", *_head(found)), rows)]


def crowd_tables(bench: Bench) -> list[Table]:
    """Return frames with more and more people."""
    found = bench.of_part("crowd")
    rows = [
        (f"{row.crowd} people", row.distance, f"{row.eyes} {row.lod}", *_whole(row, found))
        for row in found
    ]
    note = (
        "Whole frames. At a distance: two ultra eyes and so many other people in the scene. Group: "
        "so many people who face the camera, from the front; eyes by size have the LoD that their "
        "size asks for, and irises narrower than 4 pixels are painted and not counted."
    )
    return [Table("Crowd", note, ("", "distance", "eyes", *_head(found)), rows)]


def aim_tables(bench: Bench) -> list[Table]:
    """Return whether aims are met: on a GPU its own; on software GL its own and what it can say."""
    found = bench.of_part("aims")
    return _aims_on_a_gpu(found) if is_on_gpu(found) else _aims_without_a_gpu(bench, found)


def _aims_on_a_gpu(found: list[Cost]) -> list[Table]:
    rows = []
    for row in found:
        aim = GPU_AIMS[row.distance]
        is_met = 1000.0 / (row.row_ms or row.ms_median) >= aim.frames_per_s
        rows.append(
            (
                _scene(row),
                f"{aim.frames_per_s:.0f}",
                *_whole(row, found),
                f"{row.row_ms:.1f}",
                f"{row.reads} ({row.wait_ms:.1f} ms)" if row.reads else "0",
                "met" if is_met else "missed",
            )
        )
    head = ("", "aim/s", *_head(found), "ms in a row", "read-backs", "aim")
    note = "Frames/s of frames in a row at 1920x1080; the thesis had about 50 and 15."
    return [Table("Aims on a GPU", note, head, rows)]


def _aims_without_a_gpu(bench: Bench, found: list[Cost]) -> list[Table]:
    own = [
        (
            aim.title,
            f"{aim.most_ms:.0f}",
            ms(row),
            "met" if row.ms_median <= aim.most_ms else "missed",
        )
        for aim, row in software_aims(bench)
    ]
    promised = []
    for row in found:
        aim, asked_ms = GPU_AIMS[row.distance], row.processor_ms or 0.0
        most = 1000.0 / asked_ms if asked_ms else float("inf")
        promised.append(
            (
                _scene(row),
                f"{aim.frames_per_s:.0f}",
                f"{asked_ms:.1f}",
                f"{row.draw_calls}",
                f"{(row.reads or 1) - 1}",  # the picture is always read back here
                f"{most:.0f}",
                "within reach" if most >= aim.frames_per_s else "out of reach",
            )
        )
    return [
        Table(
            "Aims on two cores with software GL",
            "Two eyes at macroscopic, 1920x1080: the longest that a frame may take.",
            ("", "aim, ms", "ms", "aim"),
            own,
        ),
        Table(
            "What the aims for a GPU ask of this processor",
            "Frames at 1920x1080 as a GPU gets them, whole, rehearsed without drawing: the "
            "submitting thread's own ms, and the most frames/s that any GPU could show with them. "
            "A driver's time comes on top, so within reach is not met: that has to be measured on "
            "a GPU. The thesis had about 50 and 15.",
            ("", "aim/s", "processor ms", "draw calls", "read-backs", "at most/s", "the aim"),
            promised,
        ),
    ]


def _head(rows: list[Cost]) -> tuple[str, ...]:
    if not is_on_gpu(rows):
        return "ms", "frames/s", "processor ms", "draw calls"
    return "GPU ms", "frames/s", "processor ms", "draw calls", "bound by"


def _whole(row: Cost, rows: list[Cost]) -> tuple[str, ...]:
    asked_ms = NOTHING if row.processor_ms is None else f"{row.processor_ms:.1f}"
    calls = NOTHING if row.draw_calls is None else f"{row.draw_calls}"
    bound = (bound_by(row) or NOTHING,) if is_on_gpu(rows) else ()
    return ms(row), rate(row), asked_ms, calls, *bound


def _scene(row: Cost) -> str:
    """Return what an aim's row shows, as it was drawn."""
    if row.crowd is not None:
        return f"{row.crowd} people, {row.eyes} eyes {row.lod}"
    return f"{row.eyes} {row.lod} eyes, dynamic cube of {row.cube_px} px"


def _eyes(number: int) -> str:
    return "one eye" if number == 1 else f"{number} eyes"
