"""``ocularist check``: read a study file, tell every fault at once, and audit the design."""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Final

from study.commands.errors import CommandError
from study.commands.options import add_study
from study.commands.pictures import check_pictures
from study.commands.values import count, language

if TYPE_CHECKING:
    from study.design.attention import Attention
    from study.design.definition import StudyDefinition
    from study.design.pairings import Clip

HELP = "check a study file and audit its design"
DESCRIPTION = (
    "Read a study file and report every fault with its place, what was found and what is accepted. "
    "A sound file is summed up, and what its design can and cannot show is said."
)
EXAMPLE = "my-study.toml --people 24 48"
WIDTH: Final = 96


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument(
        "--people",
        type=count,
        nargs="+",
        default=[12, 24, 48],
        metavar="N",
        help="count what so many people would see (default: 12 24 48)",
    )
    parser.add_argument(
        "--order",
        metavar="CODE",
        help="only tell the trials of one participant again, in order: the order_code of "
        "participants.csv",
    )
    parser.add_argument(
        "--translation",
        type=language,
        metavar="LANGUAGE",
        help="only write a file to translate: every text that participants read, in its place",
    )


def run(options: argparse.Namespace) -> int:
    """Print the summary and the audit; a faulty file ends in DefinitionError."""
    definition = _read(options.study, options.translation)
    check_pictures(definition)
    lines: Iterable[str]
    if options.translation is not None:
        from study.design.translation_file import translation_lines

        if options.translation == definition.language:
            raise CommandError(f"--translation {options.translation}: the study's own language")
        lines = translation_lines(definition, options.translation)
    elif options.order is not None:
        lines = order_lines(definition, options.order)
    else:
        exposures = exposure_lines(definition, options.people)
        lines = chain(summary(definition), exposures, audit_lines(definition))
    for line in lines:
        print(line)
    return 0


def _read(study: str, language: str | None) -> StudyDefinition:
    """Read the study; a translation that is asked for may still be absent or have faults."""
    from study.design.definition import read_definition
    from study.design.faults import DefinitionError

    try:
        return read_definition(study)
    except DefinitionError:
        if language is None:
            raise
        return read_definition(study, without_translation=language)


def order_lines(definition: StudyDefinition, code: str) -> Iterator[str]:
    """Yield the trials that an order code stands for; raises OrderCodeError."""
    from study.design.order_codes import read_order_code, trials_of_code

    width = _width(definition)
    for trial in trials_of_code(definition, read_order_code(code, definition)):
        warm_up = definition.order.is_warm_up(trial.number, is_practice=trial.is_practice)
        kind = "practice" if trial.is_practice else "warm-up" if warm_up else "trial"
        yield f"{_clip_line(f'{kind} {trial.number}', trial.clip, width)}{trial.clip.id}"


def exposure_lines(definition: StudyDefinition, people: Sequence[int]) -> Iterator[str]:
    """Yield how often each thing is shown to so many people, and how evenly."""
    from study.design.exposure import exposure_table, people_until

    yield "How often each thing is shown, to so many people who all finish (rarest to most):"
    yield from (f"  {line}" for line in exposure_table(definition, people))
    needed = {each: people_until(definition, each) for each in people}
    if all(each == number for each, number in needed.items()):
        yield "Everybody sees each LoD at each distance at which it is shown."
        needed = {}
    for each, number in needed.items():
        after = f"after {number} took part" if number else "not even after 2000 took part"
        yield f"Each LoD at each distance was seen by {each} people {after}."
    yield ""


def summary(definition: StudyDefinition) -> Iterator[str]:
    """Yield what the study shows, clip by clip."""
    wanted = definition.wanted_specs()
    seconds = sum(entry.spec.duration_s for entry in wanted)
    yield f"{definition.title} ({definition.key}, version {definition.version})"
    files = len({w.spec.clip_id for w in wanted})
    clips = (
        _counted(definition.trial_clips, "clip"),
        f"{len(definition.practice)} for practice" if definition.practice else "",
        f"{len(definition.gold)} gold" if definition.gold else "",
    )
    yield (
        f"{' and '.join(filter(None, clips))}, in "
        f"{' and '.join(map(str, definition.sizes))}, "
        f"{' and '.join(definition.orbit.directions)}: {files} files, {seconds:g} s of video"
    )
    first = len({clip.id for clip in (*definition.practice, *definition.blocks[0])})
    yield f"The first participant can start when {first + len(definition.gold)} of them are there"
    yield (
        f"{_counted(definition.about, 'question')} about the participant, "
        f"{len(definition.questions)} after each clip"
    )
    if definition.attention:
        yield f"Attention questions: {', '.join(map(_attention_place, definition.attention))}"
    yield ""
    width = _width(definition)
    iris = "iris" if definition.irises else ""
    yield f"{'clip':{width}}{'distance':14}{'left':18}{'right':18}{iris}".rstrip()
    for alike in _with_irises(definition):
        clip = alike[0]
        mark = " (catch)" if clip.is_catch else ""
        mark = " (practice)" if clip in definition.practice else mark
        mark = " (gold)" if clip in definition.gold else mark
        irises = ", ".join(one.iris for one in alike if one.iris is not None)
        yield f"{_clip_line(clip.pairing, clip, width)}{irises}{mark}".rstrip()
    yield ""


def _counted(things: Sequence[object], one: str) -> str:
    return f"{len(things)} {one if len(things) == 1 else f'{one}s'}"


def _attention_place(asked: Attention) -> str:
    place = f"within trial {asked.within}" if asked.after is None else f"after trial {asked.after}"
    return f"{asked.question.id} {place}"


def _with_irises(definition: StudyDefinition) -> list[list[Clip]]:
    """Return the clips, those that differ in their iris alone together."""
    alike: dict[str, list[Clip]] = {}
    for clip in definition.every_clip:
        alike.setdefault(clip.pairing, []).append(clip)
    return list(alike.values())


def _width(definition: StudyDefinition) -> int:
    return max(24, *(len(clip.pairing) + 2 for clip in definition.every_clip))


def _clip_line(name: str, clip: Clip, width: int) -> str:
    return f"{name:{width}}{clip.distance:14}{clip.left:18}{clip.right:18}"


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
