"""The same study over and over, each time with other people: what is decided how often.

A replicate's people and answers follow from the seed and its number alone, however the work is
shared out. Fewer people are the first of more, so that a line over numbers of people is smooth.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.decision.margins import DEFAULT, Margins
from analysis.power.assumed import Assumed
from analysis.power.crowd import Answers, answer_all, draw_crowd
from analysis.power.plan import Plan
from analysis.power.quick import Prepared, prepare

Floats = NDArray[np.float64]
Verdicts = tuple[tuple[int, str, str, str], ...]  # people, distance, LoD, verdict
Chosen = tuple[tuple[int, str, str], ...]  # people, distance, LoD named as the cheapest


@dataclass(frozen=True)
class Scene:
    """What is simulated: ways in which people may come, what they see, how it is decided.

    ``people`` are the numbers of participants, rising; ``dropout`` is the share of people who leave
    before the end, after a trial of chance; their answers until then count.
    """

    plans: tuple[Plan, ...]
    truth: Assumed
    people: tuple[int, ...]
    margins: Margins = DEFAULT
    dropout: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.dropout < 1.0:
            raise ValueError(f"dropout: found {self.dropout:g}; accepted: from 0 to below 1")
        if min(self.people) < 2:
            raise ValueError("participants: at least 2; one person says nothing about others")


@dataclass(frozen=True)
class Studied:
    """What one replicate came to, for every number of people."""

    verdicts: Verdicts
    chosen: Chosen


@dataclass(frozen=True)
class _Task:
    """A share of the replicates, with the models of every plan and number of people."""

    scene: Scene
    prepared: dict[tuple[int, int], Prepared]
    seed: int
    numbers: tuple[int, ...]


def simulate_studies(
    scene: Scene,
    *,
    replicates: int,
    seed: int,
    executor: Executor | None = None,
    share: int = 10,
    progress: Callable[[int], None] = lambda _done: None,
) -> list[Studied]:
    """Repeat the study; ``progress`` hears how many replicates more are done.

    With an ``executor`` each task is ``share`` replicates; without, they run here.
    """
    prepared = dict(_prepare(scene, seed))
    tasks = [_Task(scene, prepared, seed, numbers) for numbers in _shares(range(replicates), share)]
    found: dict[int, list[Studied]] = {}
    if executor is None:
        for i, task in enumerate(tasks):
            found[i] = _work(task)
            progress(len(task.numbers))
    else:
        waiting = {executor.submit(_work, task): i for i, task in enumerate(tasks)}
        for done in as_completed(waiting):
            found[waiting[done]] = done.result()
            progress(len(tasks[waiting[done]].numbers))
    return [studied for i in range(len(tasks)) for studied in found[i]]


def answers_of(plan: Plan, truth: Assumed, rng: np.random.Generator) -> Answers:
    """Let new people answer a plan."""
    left, right, d = _percepts(plan, truth)
    return answer_all(
        draw_crowd(rng, plan.people, population=truth.population),
        rng,
        person=plan.person,
        position=plan.position,
        left=left[plan.clip],
        right=right[plan.clip],
        sensitivity=d[plan.clip],
    )


def _percepts(plan: Plan, truth: Assumed) -> tuple[Floats, Floats, Floats]:
    """Return each clip's left and right realism and its d' (n_clips,)."""
    rows = [
        (
            truth.realism[clip.distance, clip.left_lod],
            truth.realism[clip.distance, clip.right_lod],
            truth.sensitivity.get((clip.distance, clip.left_lod, clip.right_lod), 0.0),
        )
        for clip in plan.stimuli
    ]
    left, right, d = np.array(rows).T
    return left, right, d


def _prepare(scene: Scene, seed: int) -> Iterator[tuple[tuple[int, int], Prepared]]:
    for number, plan in enumerate(scene.plans):
        for people in scene.people:
            rng = np.random.default_rng([seed, number, people, 1])
            own = plan.first(people)
            yield (number, people), prepare(own, answers_of(own, scene.truth, rng), rng)


def _shares(numbers: Iterable[int], size: int) -> Iterator[tuple[int, ...]]:
    listed = list(numbers)
    return (tuple(listed[start : start + size]) for start in range(0, len(listed), size))


def _work(task: _Task) -> list[Studied]:
    return [_study(task, number) for number in task.numbers]


def _study(task: _Task, number: int) -> Studied:
    scene, which = task.scene, number % len(task.scene.plans)
    plan = scene.plans[which].first(max(scene.people))
    rng = np.random.default_rng([task.seed, number])
    answers = answers_of(plan, scene.truth, rng)
    seen = _stayed(plan, scene.dropout, rng)
    verdicts: list[tuple[int, str, str, str]] = []
    chosen: list[tuple[int, str, str]] = []
    for people in scene.people:
        first = plan.person < people
        given = Answers(*(column[first] for column in answers.columns()))
        decided = task.prepared[which, people].decide(
            given, rng, margins=scene.margins, seen=seen[first]
        )
        chosen += [(people, own.distance, own.lod) for own in decided.decisions]
        verdicts += [(people, *verdict) for verdict in decided.verdicts()]
    return Studied(tuple(verdicts), tuple(chosen))


def _stayed(plan: Plan, dropout: float, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Say of each presentation whether its person was still there."""
    last = np.full(plan.people, np.inf)
    trials = np.bincount(plan.person, minlength=plan.people)
    leaves = rng.random(plan.people) < dropout
    last[leaves] = np.floor(rng.random(plan.people) * trials)[leaves]
    return np.asarray(plan.position <= last[plan.person])
