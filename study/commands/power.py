"""``ocularist power``: how many people a study needs, found out before anyone is recruited."""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import textwrap
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from study.commands.options import add_study, count, reading
from study.commands.places import new_folder

if TYPE_CHECKING:
    from tqdm import tqdm

    from analysis.decision.margins import Margins
    from analysis.power.assumed import Assumed
    from analysis.power.plan import Plan
    from analysis.power.replicates import Scene, Studied
    from study.design.definition import StudyDefinition

HELP = "tell how many people a study needs"
DESCRIPTION = (
    "Let simulated people take a study many times over, by its own schedule, and count how often "
    "each verdict falls and the right LoD is named, for several numbers of people. What people are "
    "assumed to see decides the result: try more than one --truth. docs/power.md tells how to read "
    "it."
)
EXAMPLE = "lod --participants 20,40"
WIDTH: Final = 96
PLANS: Final = 4  # ways in which people come, taken in turns by the replicates


@reading
def people(text: str) -> tuple[int, ...]:
    """Read ``10,20,40``: numbers of participants, at least 2 each."""
    words = [word.strip() for word in text.split(",")]
    if not all(word.isdecimal() and 2 <= int(word) <= 5000 for word in words):
        raise ValueError(f'"{text}": write whole numbers from 2 to 5000, like 10,20,40')
    return tuple(sorted({int(word) for word in words}))


@reading
def share(text: str) -> float:
    """Read a share below 1."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value < 1.0:
        raise ValueError(f'"{text}" is no share; write a number from 0 to below 1, like 0.1')
    return value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this command's arguments."""
    add_study(parser)
    parser.add_argument(
        "--participants",
        type=people,
        default=(10, 20, 40, 80),
        metavar="N,N,...",
        help="numbers of people, apart by commas (default: 10,20,40,80)",
    )
    parser.add_argument(
        "--replicates",
        type=count,
        default=400,
        metavar="N",
        help="simulated studies of each number of people (default: %(default)s)",
    )
    parser.add_argument(
        "--truth",
        default="thesis",
        metavar="NAME|FILE.toml",
        help="what people are assumed to see: thesis (as the thesis says in words), equal (no LoD "
        "differs), realism-margin or noticed-margin (every LoD just at a margin, where enough "
        "would be wrong), or a file with losses and shares (default: %(default)s)",
    )
    parser.add_argument(
        "--dropout",
        type=share,
        default=0.0,
        metavar="SHARE",
        help="share of people who leave before the end; what they answered counts "
        "(default: %(default)s)",
    )
    for name, metavar, meaning, default in (
        ("realism-margin", "POINTS", "a loss of realism that does not matter", "0.5"),
        ("noticed-margin", "SHARE", "share of people, beyond false alarms, who may notice", "0.25"),
        ("confidence", "SHARE", "confidence of each bound, one-sided", "0.95"),
    ):
        parser.add_argument(
            f"--{name}",
            type=float,
            metavar=metavar,
            help=f"{meaning} (default: what the study declares, else {default})",
        )
    parser.add_argument(
        "--seed",
        type=int,
        default=1,
        help="the same seed gives the same result, however many jobs (default: %(default)s)",
    )
    parser.add_argument(
        "--jobs",
        type=count,
        default=os.cpu_count() or 1,
        metavar="N",
        help="processes that work at once (default: one for each processor, here %(default)s)",
    )
    parser.add_argument(
        "--out",
        type=new_folder,
        default="out/power",
        metavar="DIR",
        help="folder for power.csv, power-cheapest.csv, power.json and the chart "
        "(default: %(default)s)",
    )


def run(options: argparse.Namespace) -> int:
    """Simulate, print the table and one sentence per distance, name the files."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # of each job: small matrices, many jobs
    from analysis.power.outcome import outcome_of
    from analysis.power.replicates import Scene
    from analysis.power.sentences import answer_lines, opening_lines
    from analysis.power.text_table import table_lines
    from analysis.power.writing import write_power
    from study.design.definition import read_definition
    from study.planning import plans_of, studied_lods

    definition = read_definition(options.study)
    margins = _margins(definition, options)
    plans = plans_of(definition, options.participants[-1], seed=options.seed, count=PLANS)
    truth = _truth(options.truth, plans[0], margins)
    scene = Scene(plans, truth, options.participants, margins, options.dropout)
    studies = _simulate(scene, options)
    outcome = outcome_of(
        scene, studies, distances=definition.distances, lods=studied_lods(definition)
    )
    files = write_power(
        outcome,
        options.out,
        title=f"Power of {definition.key}: studies with the right verdict (truth: {truth.name})",
        settings=_settings(definition, scene, options),
    )
    _print_wrapped(opening_lines(scene, outcome, definition.key))
    print("\n".join(["", *table_lines(outcome), ""]))
    _print_wrapped(answer_lines(outcome))
    print(
        f"SIMULATED people, {options.replicates} studies; brackets hold the simulation's own error "
        "at 95 %."
    )
    print(", ".join(str(path) for path in files))
    return 0


def _print_wrapped(lines: Iterable[str]) -> None:
    for line in lines:
        print("\n".join(textwrap.wrap(line, WIDTH, break_on_hyphens=False)))


def _margins(definition: StudyDefinition, options: argparse.Namespace) -> Margins:
    from analysis import declared_margins

    rule = definition.decision
    declared = declared_margins({"decision": rule.model_dump(mode="json")} if rule else {})
    return declared.changed(
        realism_points=options.realism_margin,
        noticed_share=options.noticed_margin,
        confidence=options.confidence,
    )


def _truth(name: str, plan: Plan, margins: Margins) -> Assumed:
    from analysis.power.assumed import named_truth
    from analysis.power.truth_file import read_truth

    if name.endswith(".toml"):
        return read_truth(Path(name), plan.stimuli, margins)
    return named_truth(name, plan.stimuli, margins)


def _simulate(scene: Scene, options: argparse.Namespace) -> list[Studied]:
    from tqdm import tqdm

    from analysis.power.replicates import simulate_studies

    bar: tqdm[Any] = tqdm(
        total=options.replicates, unit="study", leave=False, disable=not sys.stderr.isatty()
    )
    with bar, _executor(min(options.jobs, options.replicates)) as executor:
        return simulate_studies(
            scene,
            replicates=options.replicates,
            seed=options.seed,
            executor=executor,
            progress=lambda done: _advance(bar, done),
        )


@contextmanager
def _executor(jobs: int) -> Iterator[Executor | None]:
    """Give so many processes; None where one is enough, which is this one."""
    if jobs < 2:
        yield None
        return
    spawning = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=spawning) as executor:
        try:
            yield executor
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)  # somebody pressed Ctrl-C
            raise


def _settings(
    definition: StudyDefinition, scene: Scene, options: argparse.Namespace
) -> dict[str, Any]:
    return {
        "study": definition.key,
        "study_version": definition.version,
        "definition_hash": definition.definition_hash,
        "truth": scene.truth.name,
        "realism_margin": scene.margins.realism_points,
        "noticed_margin": scene.margins.noticed_share,
        "confidence": scene.margins.confidence,
        "margins": scene.margins.origins,
        "participants": list(scene.people),
        "dropout": scene.dropout,
        "seed": options.seed,
    }


def _advance(bar: tqdm[Any], done: int) -> None:
    bar.update(done)
