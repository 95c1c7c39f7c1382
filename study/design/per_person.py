"""How many of its clips one person sees: blocks that show every clip equally often over people.

Pure. A block is one person's clips, in slots that an order arranges. Blocks are cyclic: at each
distance the pairings stand in a ring, LoDs and sides alternating, and a person sees a window of it
that moves on by one from block to block; the irises move along within the window. So over all
blocks every pairing is shown equally often with every iris, and within one block every distance
has equally many clips, with sides and irises as even as the numbers allow.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import gcd, lcm
from typing import Annotated, Final

from pydantic import Field

from study.design.faults import Fault
from study.design.pairings import Clip, Condition
from study.design.parts import Part, Whole

MOST_BLOCKS: Final = 240  # more are never filled, and preparing would take seconds

Block = tuple[Clip, ...]


class PerPerson(Part):
    """How many clips one person sees: pairings of two LoDs, and catch clips."""

    pairs: Annotated[Whole, Field(ge=1)]
    catch: Annotated[Whole, Field(ge=0)] = 0


def blocks_of(clips: Sequence[Clip], per_person: PerPerson | None) -> tuple[Block, ...]:
    """Return every block of a study; one with all the clips where everybody sees them all."""
    if per_person is None:
        return (tuple(clips),)
    pairs, catch = _strata(clips, is_catch=False), _strata(clips, is_catch=True)
    rings = [_ring(stratum) for stratum in pairs]
    shares = [per_person.pairs // max(1, len(rings)), per_person.catch // max(1, len(catch))]
    count = _count(rings, catch, shares)
    return tuple(
        _dealt([_window(ring, number, shares[0], place=at) for at, ring in enumerate(rings)])
        + _dealt([_set(stratum, number, shares[1]) for stratum in catch])
        for number in range(count)
    )


def _strata(clips: Sequence[Clip], *, is_catch: bool) -> list[list[Clip]]:
    """Return the clips of one kind, distance by distance in the file's order."""
    mine = [clip for clip in clips if clip.is_catch == is_catch]
    return [
        [clip for clip in mine if clip.distance == distance]
        for distance in dict.fromkeys(clip.distance for clip in mine)
    ]


def _ring(stratum: Sequence[Clip]) -> list[list[Clip]]:
    """Arrange one distance's pairings: each entry holds a pairing's clips, one per iris.

    Where every pairing is there both ways round, neighbours differ in LoD and in side.
    """
    by_condition: dict[Condition, list[Clip]] = {}
    for clip in stratum:
        by_condition.setdefault(clip.condition, []).append(clip)
    pairs: list[Condition] = []  # each as the file shows it first
    for condition in by_condition:
        if condition.swapped() not in pairs:
            pairs.append(condition)
    if len(by_condition) != 2 * len(pairs):
        return list(by_condition.values())
    ring = []
    for place in range(2 * len(pairs)):
        pair = pairs[place % len(pairs)]
        # With an even number of pairs the second round would repeat the first round's sides.
        is_second = place // len(pairs) == 1 and len(pairs) % 2 == 0
        ring.append(by_condition[pair if (place + is_second) % 2 == 0 else pair.swapped()])
    return ring


def _window(ring: Sequence[Sequence[Clip]], number: int, share: int, *, place: int) -> list[Clip]:
    """Return the clips of block ``number`` at the ``place``-th distance."""
    size, irises = len(ring), len(ring[0])
    # Distances start elsewhere in the ring, so that one person's windows cover all of it; irises
    # start elsewhere too, by a shift that keeps them apart from the sides, which alternate.
    start = number + share * place
    shift = place if share % 2 == 0 else place // 2
    lap = (number // size) * gcd(irises, share)
    return [ring[(start + step) % size][(step + shift + lap) % irises] for step in range(share)]


def _set(stratum: Sequence[Clip], number: int, share: int) -> list[Clip]:
    """Return the catch clips of a block at one distance: the next ones of the file, in turn."""
    return [stratum[(number * share + step) % len(stratum)] for step in range(share)]


def _dealt(hands: Sequence[Sequence[Clip]]) -> Block:
    """Deal clips into slots, one distance after the other: the first of each, the second of ..."""
    longest = max(map(len, hands), default=0)
    return tuple(hand[i] for i in range(longest) for hand in hands if i < len(hand))


def _count(
    rings: Sequence[Sequence[Sequence[Clip]]], catch: Sequence[Sequence[Clip]], shares: list[int]
) -> int:
    """Return after how many blocks every clip was shown equally often."""
    counts = [1]
    for ring in rings:
        irises = len(ring[0])
        if shares[0] < len(ring) or irises > 1:
            counts.append(len(ring) * (irises // gcd(irises, shares[0])))
    counts += [len(stratum) // gcd(len(stratum), shares[1]) for stratum in catch if shares[1]]
    return lcm(*counts)


def per_person_faults(clips: Sequence[Clip], per_person: PerPerson | None) -> Iterator[Fault]:
    """Yield what keeps a study's blocks from being balanced; called with sound clips only."""
    if per_person is None:
        return
    faults = [
        *_share_faults("pairs", per_person.pairs, _strata(clips, is_catch=False)),
        *_share_faults("catch", per_person.catch, _strata(clips, is_catch=True)),
    ]
    yield from faults
    if not faults and (count := len(blocks_of(clips, per_person))) > MOST_BLOCKS:
        yield Fault(
            "per_person",
            f"{count} blocks are needed to show every clip equally often; at most {MOST_BLOCKS}. "
            "Choose numbers that divide those of the clips at a distance",
        )


def _share_faults(key: str, wanted: int, strata: Sequence[Sequence[Clip]]) -> Iterator[Fault]:
    noun = "pairings" if key == "pairs" else "catch clips"
    place = f"per_person.{key}"
    if not wanted:
        return
    if not strata:
        yield Fault(place, f"{wanted} of no {noun}; add some, or leave this out")
        return
    rings = [_ring(stratum) if key == "pairs" else [[c] for c in stratum] for stratum in strata]
    sizes = {stratum[0].distance: len(r) for stratum, r in zip(strata, rings, strict=True)}
    if len(set(sizes.values())) > 1:
        found = ", ".join(f"{distance} {size}" for distance, size in sizes.items())
        yield Fault(place, f"every distance needs equally many {noun}; found {found}")
        return
    irises = {len(entry) for ring in rings for entry in ring}
    if len(irises) > 1:
        found = " and ".join(map(str, sorted(irises)))
        yield Fault(place, f"every pairing needs equally many irises; found {found}")
        return
    most, step = sum(sizes.values()), len(sizes)
    if wanted > most:
        yield Fault(
            place, f"{wanted} of {most} {noun}; nobody sees one twice, so {most} is the most"
        )
    elif wanted % step:
        accepted = ", ".join(str(n) for n in range(step, most + 1, step))
        yield Fault(place, f"{wanted} cannot be shared equally by {step} distances; use {accepted}")
