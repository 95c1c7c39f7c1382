"""``ocularist check``: read a study file, tell every fault at once, and audit the design."""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final

from study.commands.options import add_study
from study.commands.pictures import check_pictures

if TYPE_CHECKING:
    from study.design.definition import StudyDefinition

HELP = "check a study file and audit its design"
DESCRIPTION = (
    "Read a study file and report every fault with its place, what was found and what is accepted. "
    "A sound file is summed up, and what its design can and cannot show is said."
)
WIDTH: Final = 96


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)


def run(options: argparse.Namespace) -> int:
    """Print the summary and the audit; a faulty file ends in DefinitionError."""
    from study.design.definition import read_definition

    definition = read_definition(options.study)
    check_pictures(definition)
    for line in [*summary(definition), "", *audit_lines(definition)]:
        print(line)
    return 0


def summary(definition: StudyDefinition) -> Iterator[str]:
    """Yield what the study shows, clip by clip."""
    wanted = definition.wanted_specs()
    seconds = sum(entry.spec.duration_s for entry in wanted)
    yield f"{definition.title} ({definition.key}, version {definition.version})"
    yield (
        f"{len(definition.trial_clips)} clips and {len(definition.practice)} for practice, in "
        f"{' and '.join(map(str, definition.sizes))}, "
        f"{' and '.join(definition.orbit.directions)}: {len({w.spec.clip_id for w in wanted})} "
        f"files, {seconds:g} s of video"
    )
    yield (
        f"{len(definition.about)} questions about the participant, {len(definition.questions)} "
        "after each clip"
    )
    yield ""
    width = max(24, *(len(clip.id) + 2 for clip in definition.every_clip))
    yield f"{'clip':{width}}{'distance':14}{'left':18}{'right':18}"
    for clip in definition.every_clip:
        mark = " (practice)" if clip in definition.practice else ""
        mark = " (catch)" if clip.is_catch else mark
        yield f"{clip.id:{width}}{clip.distance:14}{clip.left:18}{clip.right:18}{mark}".rstrip()


def audit_lines(definition: StudyDefinition) -> Iterator[str]:
    """Yield what the design can and cannot show, then what is worth a second look."""
    from study.design.audit import cell_table, statements, warnings

    yield "Eyes shown per distance and LoD:"
    yield from (f"  {line}" for line in cell_table(definition))
    yield ""
    yield "What this design shows and what it cannot answer:"
    yield from _listed(statements(definition))
    found = warnings(definition)
    if found:
        yield ""
        yield "Worth a second look:"
        yield from _listed(found)


def _listed(sentences: Iterable[str]) -> Iterator[str]:
    for sentence in sentences:
        yield from textwrap.wrap(
            sentence, WIDTH, initial_indent="- ", subsequent_indent="  ", break_on_hyphens=False
        )
