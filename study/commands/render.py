"""``ocularist render``: a study's clips and their manifest, into a folder."""

from __future__ import annotations

import argparse
import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from study.commands.errors import CommandError
from study.commands.options import add_study, count, settings_of, size
from study.commands.pictures import check_pictures

if TYPE_CHECKING:
    from renderer.clip import ClipSpec
    from renderer.manifest import ClipRecord
    from study.design.definition import StudyDefinition

HELP = "render a study's clips and their manifest"
DESCRIPTION = (
    "Render every clip of a study into a folder, with a manifest beside them. A clip that is there "
    "and current is not rendered again; an interrupted run goes on where it stopped."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="folder for the clips (default: ocularist-data/clips, where ocularist run finds them)",
    )
    parser.add_argument(
        "--only",
        action="append",
        metavar="CLIP",
        help="render this clip of the study file only; may be given several times",
    )
    parser.add_argument(
        "--size",
        action="append",
        type=size,
        metavar="WIDTHxHEIGHT",
        help="picture size in pixels instead of the study's; may be given several times",
    )
    parser.add_argument("--fps", type=count, help="frames per second instead of the study's")
    parser.add_argument(
        "--workers",
        type=count,
        default=1,
        help="processes that render at the same time (default: %(default)s; software rendering "
        "already uses every core)",
    )


def run(options: argparse.Namespace) -> int:
    """Render what is missing and say where it lies."""
    from study.commands.progress import ClipBar
    from study.design.definition import read_definition

    definition = read_definition(options.study)
    check_pictures(definition)
    specs = wanted(definition, only=options.only, sizes=options.size, fps=options.fps)
    folder = options.out or settings_of(options).media_folder
    with ClipBar(len(specs)) as bar:
        if options.workers == 1:
            records = _render_here(specs, folder, bar.show)
        else:
            # Each process opens its own GL context; a forked one would share its parent's.
            context = multiprocessing.get_context("spawn")
            with ProcessPoolExecutor(options.workers, mp_context=context) as executor:
                records = render_with(executor, specs, folder, bar.show)
    megabytes = sum(record.file_bytes for record in records) / 1e6
    print(f"{len(records)} clips, {megabytes:.1f} MB, in {folder}")
    return 0


def wanted(
    definition: StudyDefinition,
    *,
    only: Sequence[str] | None,
    sizes: Sequence[tuple[int, int]] | None,
    fps: int | None,
) -> list[ClipSpec]:
    """Return the specs to render in the study's order, narrowed and changed as asked.

    Raises CommandError naming a clip that the study does not have, and those that it has.
    """
    entries = definition.wanted_specs()
    known = list(dict.fromkeys(entry.clip.id for entry in entries))
    for name in only or ():
        if name not in known:
            raise CommandError(f'unknown clip "{name}"; the study has {", ".join(known)}')
    specs = [entry.spec for entry in entries if not only or entry.clip.id in only]
    if sizes:
        specs = [spec.resized(*size) for size in sizes for spec in specs]
    if fps:
        specs = [replace(spec, fps=fps) for spec in specs]
    return list(dict.fromkeys(specs))


def _render_here(
    specs: Sequence[ClipSpec], folder: Path, show: Callable[[float], None]
) -> list[ClipRecord]:
    from renderer.batch import render_clips
    from renderer.studio import Studio

    studio = Studio()
    try:
        return render_clips(
            specs, folder, source=studio, progress=lambda number, share: show(number + share)
        )
    finally:
        studio.close()


def render_with(
    executor: Executor, specs: Sequence[ClipSpec], folder: Path, show: Callable[[float], None]
) -> list[ClipRecord]:
    """Render clips in an executor's processes, one clip each at a time."""
    from renderer.batch import remove_parts

    remove_parts(folder)
    futures = [executor.submit(_render_one, spec, folder) for spec in specs]
    for done, future in enumerate(as_completed(futures), start=1):
        future.result()
        show(done)
    return [future.result() for future in futures]


def _render_one(spec: ClipSpec, folder: Path) -> ClipRecord:
    from renderer.batch import render_clip
    from renderer.studio import Studio

    studio = Studio()
    try:
        return render_clip(spec, folder, source=studio)
    finally:
        studio.close()
