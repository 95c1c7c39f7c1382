"""``ocularist render``: a study's clips and their manifest, into a folder."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from study.commands.encoding import add_encoding, encoding_choices, warn_of_missed
from study.commands.errors import CommandError
from study.commands.options import add_study, settings_of
from study.commands.pictures import check_pictures
from study.commands.places import new_folder
from study.commands.values import count, size

if TYPE_CHECKING:
    from renderer.clip import ClipSpec
    from renderer.manifest import ClipRecord
    from study.design.definition import StudyDefinition

HELP = "render a study's clips and their manifest"
DESCRIPTION = (
    "Render every clip of a study into a folder, with a manifest beside them. A clip that is there "
    "and current is not rendered again; an interrupted run goes on where it stopped. A killed "
    "process costs only its clip, which is tried again. See docs/rendering-at-scale.md."
)
EXAMPLE = "thesis --size 1280x720 --only 1 --workers 2"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument(
        "--out",
        type=new_folder,
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
    add_encoding(parser)
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=count,
        default=1,
        metavar="N",
        help="processes of this machine that render at the same time (default: %(default)s; "
        "software rendering uses every core already)",
    )
    where.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="render on the Dask cluster whose scheduler listens there, such as tcp://host:8786",
    )


def run(options: argparse.Namespace) -> int:
    """Render what is missing and say where it lies."""
    from study.commands.progress import ClipBar
    from study.design.definition import read_definition

    choices = encoding_choices(options)
    definition = read_definition(options.study)
    check_pictures(definition)
    specs = wanted(definition, only=options.only, sizes=options.size, fps=options.fps)
    folder = options.out or settings_of(options).media_folder
    with ClipBar(len(specs)) as bar:

        def say(line: str) -> None:
            bar.clear()
            print(line, file=sys.stderr, flush=True)

        with _executor(options, say) as executor:
            if executor is None:
                records = _render_here(specs, folder, bar.show, choices)
            else:
                from renderer.production.farm import render_on

                records = render_on(
                    executor,
                    specs,
                    folder,
                    progress=bar.show,
                    say=say,
                    with_flip=choices["with_flip"],
                )
    warn_of_missed(records)
    megabytes = sum(record.file_bytes for record in records) / 1e6
    count = f"{len(records)} clip{'' if len(records) == 1 else 's'}"
    print(f"{count}, {megabytes:.1f} MB, in {folder}")
    drawn_by = sorted({f"{record.gl_renderer}, {record.gl_version}" for record in records})
    if len(drawn_by) > 1:
        print(
            "Drawn by different GL renderers, which may differ in the last bit: "
            + "; ".join(drawn_by)
        )
    return 0


@contextmanager
def _executor(options: argparse.Namespace, say: Callable[[str], None]) -> Iterator[Executor | None]:
    """Give what the options ask for: a cluster, processes of this machine, or this one alone."""
    if options.scheduler:
        from study.commands.cluster import cluster

        with cluster(options.scheduler, say=say) as executor:
            yield executor
    elif options.workers > 1:
        from study.commands.pool import Pool

        with Pool(options.workers, threads=fair_share(options.workers)) as executor:
            yield executor
    else:
        yield None


def fair_share(workers: int) -> int:
    """Return how many threads each of several processes may have of this machine's cores."""
    return max(1, len(os.sched_getaffinity(0)) // workers)


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
    return list({spec.clip_id: spec for spec in specs}.values())  # a name's frames are the same


def _render_here(
    specs: Sequence[ClipSpec],
    folder: Path,
    show: Callable[[float], None],
    choices: dict[str, bool],
) -> list[ClipRecord]:
    from renderer.production.batch import render_clips
    from renderer.studio import Studio

    studio = Studio()
    try:
        return render_clips(
            specs,
            folder,
            source=studio,
            progress=lambda number, share: show(number + share),
            **choices,
        )
    finally:
        studio.close()
