"""What so many people would see: how often each thing is shown, and how evenly.

Pure. People come one by one, all finish, and all have the same screen; those who leave are made up
for by the next, so this is also where a study with drop-outs ends.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from study.design.arms import Arm, all_arms, assign_arm, assign_row
from study.design.definition import StudyDefinition
from study.design.pairings import Clip
from study.design.schedule import order_rows, schedule


@dataclass(frozen=True)
class Visit:
    """One person's places in the design, and the clips of their trials in order, without gold."""

    arm: Arm
    order_row: int | None
    clips: tuple[Clip, ...]


def visits(definition: StudyDefinition, people: int, *, seed: int = 1) -> list[Visit]:
    """Return what people see who come one by one; the first of more people are the same ones."""
    open_arms = [arm for arm in all_arms(definition) if arm.size == str(definition.sizes[0])]
    rows = len(order_rows(definition))
    filled: Counter[Arm] = Counter()
    used: Counter[tuple[Arm, int]] = Counter()
    golden = {gold.id for gold in definition.gold}
    found = []
    for number in range(people):
        rng = np.random.default_rng([seed, number])
        own = int(rng.integers(2**62))
        arm = assign_arm(filled, open_arms, rng, blocks=definition.blocks)
        row = assign_row(used, arm, rows, rng)
        filled[arm] += 1
        if row is not None:
            used[arm, row] += 1
        trials = schedule(definition, own, block=arm.block, order_row=row)
        clips = (t.clip for t in trials if not t.is_practice and t.clip.id not in golden)
        found.append(Visit(arm, row, tuple(clips)))
    return found


@dataclass(frozen=True)
class Spread:
    """How often the things of one kind are shown: of ``kinds`` things the rarest and the most."""

    name: str
    kinds: int
    least: int
    most: int

    def __str__(self) -> str:
        return str(self.least) if self.least == self.most else f"{self.least} to {self.most}"


def people_until(definition: StudyDefinition, each: int, *, most: int = 2000) -> int | None:
    """Return how many people come until each LoD shown at a distance was seen by ``each`` of them.

    None where more than ``most`` would have to come.
    """
    wanted = {
        (clip.distance, lod) for clip in definition.trial_clips for lod in (clip.left, clip.right)
    }
    number = each
    while number <= most:
        counts: Counter[Hashable] = Counter()
        for place, visit in enumerate(visits(definition, number), start=1):
            counts.update({(c.distance, lod) for c in visit.clips for lod in (c.left, c.right)})
            if place >= each and min(counts[cell] for cell in wanted) >= each:
                return place
        number *= 2
    return None


def spreads(definition: StudyDefinition, shown: Sequence[Visit]) -> list[Spread]:
    """Return how evenly things are spread over visits, one spread for each kind of thing."""
    found = []
    for name, every, of in _kinds(definition):
        counts = Counter(thing for visit in shown for thing in of(visit))
        listed = [counts[thing] for thing in every]
        if len(listed) > 1:
            found.append(Spread(name, len(listed), min(listed), max(listed)))
    return found


Things = Callable[[Visit], Iterable[Hashable]]


def _kinds(definition: StudyDefinition) -> Iterator[tuple[str, list[Hashable], Things]]:
    """Yield what is counted: its name, all there is of it, and what of it one visit shows."""
    pairs = [clip for clip in definition.trial_clips if not clip.is_catch]
    catch = [clip for clip in definition.trial_clips if clip.is_catch]
    distances = list(dict.fromkeys(clip.distance for clip in pairs))
    directions, length = definition.orbit.directions, len(definition.blocks[0])
    yield "each distance", [*distances], lambda v: (c.distance for c in v.clips if not c.is_catch)
    yield "each pairing, each way round", _unique(c.condition for c in pairs), _conditions
    if definition.irises:
        yield "each iris", _unique(c.iris for c in pairs), lambda v: (c.iris for c in v.clips)
        yield "each pairing with each iris", [c.id for c in pairs], _names
    crowds = _unique(definition.scene_of(c).crowd for c in pairs)
    if len(crowds) > 1:
        yield "each crowd", crowds, lambda v: (definition.scene_of(c).crowd for c in v.clips)
    yield "each equal pair", [c.id for c in catch], _names
    yield "each orbit direction", [*directions], lambda v: [v.arm.orbit_direction]
    turned = list(product(directions, _unique(c.condition for c in pairs)))
    yield (
        "each pairing in each direction",
        [*turned],
        lambda v: product([v.arm.orbit_direction], _conditions(v)),
    )
    rows = range(1, len(order_rows(definition)) + 1)
    yield "each row of the orders", [*rows], lambda v: [v.order_row]
    places = list(product(distances, range(length)))
    yield (
        "each distance at each place",
        [*places],
        lambda v: ((clip.distance, place) for place, clip in enumerate(v.clips)),
    )
    steps = [(a, b) for a, b in product(distances, distances) if a != b]
    yield (
        "each distance after each other",
        [*steps],
        lambda v: ((a.distance, b.distance) for a, b in pairwise(v.clips)),
    )


def _unique(things: Iterable[Hashable]) -> list[Hashable]:
    return list(dict.fromkeys(things))


def _conditions(visit: Visit) -> Iterator[Hashable]:
    return (clip.condition for clip in visit.clips)


def _names(visit: Visit) -> Iterator[Hashable]:
    return (clip.id for clip in visit.clips)


def exposure_table(definition: StudyDefinition, people: Sequence[int]) -> list[str]:
    """Return lines that say how often each thing is shown to so many people."""
    everybody = visits(definition, max(people))
    columns = [spreads(definition, everybody[:number]) for number in people]
    width = max((len(spread.name) for spread in columns[0]), default=0) + 2
    cells = [[str(number) for number in people]]
    cells += [[str(column[i]) for column in columns] for i in range(len(columns[0]))]
    across = max(len(cell) for row in cells for cell in row) + 2
    names = ["people", *(spread.name for spread in columns[0])]
    return [
        f"{name:{width}}" + "".join(f"{cell:>{across}}" for cell in row)
        for name, row in zip(names, cells, strict=True)
    ]
