"""``ocularist power``: how many people a study needs, found out before anyone is recruited."""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from study.commands.power_options import MOST_PEOPLE, add_arguments

if TYPE_CHECKING:
    from tqdm import tqdm

    from analysis.decision.margins import Margins
    from analysis.power.assumed import Assumed
    from analysis.power.plan import Plan
    from analysis.power.replicates import Scene, Studied
    from study.design.definition import StudyDefinition

__all__ = ["DESCRIPTION", "EXAMPLE", "HELP", "add_arguments", "run"]

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


def run(options: argparse.Namespace) -> int:
    """Simulate, print the table and one sentence per distance, name the files."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # of each job: small matrices, many jobs
    from analysis.power.outcome import outcome_of
    from analysis.power.replicates import Scene
    from analysis.power.sentences import answer_lines, opening_lines, takes_more
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
    if takes_more(outcome) and 4 * scene.people[-1] <= MOST_PEOPLE:
        most = scene.people[-1]
        print(f"More people can be tried: --participants {2 * most},{4 * most}")
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
    from analysis.tables.columns import SCALE

    rule = definition.decision
    declared = declared_margins({"decision": rule.model_dump(mode="json")} if rule else {})
    margins = declared.changed(
        realism_points=options.realism_margin,
        noticed_share=options.noticed_margin,
        confidence=options.confidence,
    )
    margins.check(SCALE)
    return margins


def _truth(name: str, plan: Plan, margins: Margins) -> Assumed:
    from analysis.power.assumed import named_truth
    from analysis.power.truth_file import read_truth

    if name.endswith(".toml"):
        return read_truth(Path(name), plan.stimuli, margins)
    return named_truth(name, plan.stimuli, margins)


def _simulate(scene: Scene, options: argparse.Namespace) -> list[Studied]:
    from analysis.power.replicates import simulate_studies

    jobs = min(options.jobs, options.replicates)
    with _told(options.replicates) as told, _executor(jobs) as executor:
        return simulate_studies(
            scene,
            replicates=options.replicates,
            seed=options.seed,
            executor=executor,
            progress=told,
        )


@contextmanager
def _told(total: int) -> Iterator[Callable[[int], None]]:
    """Give what is told how many studies more are done: a bar, or without a terminal four lines."""
    from tqdm import tqdm

    bar: tqdm[Any] = tqdm(total=total, unit="study", leave=False, disable=not sys.stderr.isatty())
    done = 0

    def advance(more: int) -> None:
        nonlocal done
        bar.update(more)
        quarter, done = 4 * done // total, done + more
        if bar.disable and 4 * done // total > quarter:
            print(f"Simulating: {done} of {total} studies", file=sys.stderr, flush=True)

    with bar:
        yield advance


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
