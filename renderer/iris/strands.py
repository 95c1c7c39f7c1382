"""The fibres of an iris as tubes: ciliary bundles in four decks, and all strands together.

Millimetres on the iris plane; heights in [0, 1] of the relief. Statistics of width, spacing, run
and wave: reference/eye-rendering.md, 1.4 and 1.6.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from renderer.iris.angles import over_angle
from renderer.iris.inner_strands import collarette_tubes, pupillary_tubes
from renderer.iris.layout import IRIS_RADIUS_MM, Array, IrisLayout
from renderer.iris.runs import (
    Runs,
    bend_with_flow,
    lay_runs,
    polar_tubes,
    push_aside,
    taper,
)
from renderer.textures.noise import Field, Integers, noise_1d
from renderer.textures.tubes import Tubes, join_tubes


@dataclass(frozen=True)
class Deck:
    """One population of ciliary strands.

    ``guides`` bundles around the circle (0: no bundling), ``count`` runs, ``run_mm`` mean length,
    ``whole`` share of runs that span the zone, ``spread_mm`` of a run about its guide, ``sweep``
    turn in radians from collarette to root, ``obeys`` how far crypts push it aside, ``uneven`` how
    much whole bundles differ in tone and height (standard deviation).
    """

    count: int
    guides: int
    half_width_mm: tuple[float, float]
    crest: tuple[float, float]
    tone: tuple[float, float]
    run_mm: float
    whole: float
    spread_mm: float
    sweep: float
    wave_mm: float
    obeys: float
    uneven: float


DECKS: Final = (
    # deep lattice, crossing in both senses
    Deck(
        3200, 0, (0.010, 0.019), (0.08, 0.28), (0.02, 0.30), 1.2, 0.30, 0.0, 0.20, 0.012, 0.2, 0.0
    ),
    # children between the bundles
    Deck(
        2600,
        230,
        (0.011, 0.021),
        (0.20, 0.48),
        (0.15, 0.52),
        0.9,
        0.25,
        0.06,
        0.12,
        0.020,
        0.7,
        0.08,
    ),
    # bundles: ropes of a dozen fibrils
    Deck(
        2200,
        130,
        (0.008, 0.017),
        (0.36, 0.72),
        (0.36, 0.82),
        1.3,
        0.45,
        0.046,
        0.11,
        0.034,
        1.0,
        0.12,
    ),
    # few cords on top
    Deck(
        330,
        46,
        (0.009, 0.017),
        (0.58, 0.88),
        (0.58, 1.00),
        1.5,
        0.45,
        0.020,
        0.19,
        0.042,
        1.0,
        0.08,
    ),
)


def ciliary_tubes(layout: IrisLayout, seed: int, *, index: int, step_mm: float) -> Tubes:
    """Return the deck DECKS[index] of the ciliary zone."""
    deck = DECKS[index]
    key = seed * 16 + index
    rng = np.random.Generator(np.random.PCG64([seed, 0xC1, index]))
    guides = deck.guides or deck.count
    guide = rng.integers(0, guides, deck.count) if deck.guides else np.arange(deck.count)
    guide_angle = (np.arange(guides) + rng.uniform(-0.55, 0.55, guides)) / guides * 2.0 * np.pi
    inner = over_angle(layout.collarette_mm, guide_angle.astype(np.float32))[guide]
    runs = _ciliary_runs(deck, inner, rng, step_mm=step_mm)
    owner, radius = guide[runs.run], runs.at
    beyond = np.maximum(radius - inner[runs.run], 0.0)
    offset = _bundle_offset(deck, runs, owner, beyond=beyond, key=key, rng=rng)
    sweep = rng.normal(0.0, deck.sweep, guides)[owner] * beyond / 2.4
    angle = (guide_angle[owner] + offset / radius + sweep).astype(np.float32)
    angle = bend_with_flow(layout, angle, radius, seed)
    angle, inside = push_aside(layout, angle, radius, deck.obeys)

    def per_run(bounds: tuple[float, float]) -> Array:
        return rng.uniform(*bounds, deck.count).astype(np.float32)[runs.run]

    strong = deck.uneven * rng.normal(0.0, 1.0, guides).astype(np.float32)[owner]
    # A whole bundle rises and dives together, so bundles weave over and under each other.
    crest = per_run(deck.crest) + 0.085 * noise_1d(owner, radius / np.float32(0.55), key + 404)
    crest += np.float32(0.7) * strong
    crest += 0.040 * noise_1d(runs.run, radius / np.float32(0.35), key + 405)
    tone = per_run(deck.tone) + 0.07 * noise_1d(owner, radius / np.float32(0.6), key + 505)
    tone += strong
    tone += 0.04 * noise_1d(runs.run, radius / np.float32(0.2), key + 506)
    ends = taper(runs, reach=0.30)
    swell = 1.0 + 0.18 * noise_1d(runs.run, radius / np.float32(0.3), key + 606)
    return polar_tubes(
        radius,
        angle,
        runs,
        half_width_mm=per_run(deck.half_width_mm) * (0.2 + 0.8 * ends) * swell,
        crest=crest * (0.45 + 0.55 * ends) * (1.0 - 0.80 * inside),
        tone=tone * (1.0 - 0.5 * inside),
    )


def _ciliary_runs(deck: Deck, inner: Array, rng: np.random.Generator, *, step_mm: float) -> Runs:
    """Lay whole runs from the collarette outwards and free runs anywhere beyond it."""
    whole = rng.random(deck.count) < deck.whole
    run_mm = np.clip(rng.exponential(deck.run_mm, deck.count), 0.25, 3.0)
    width = IRIS_RADIUS_MM - inner - 0.15
    free = inner + rng.uniform(-0.25, 1.0, deck.count) * width
    start = np.where(whole, inner - rng.uniform(0, 0.15, deck.count), free)
    stop = np.where(whole, rng.uniform(4.7, IRIS_RADIUS_MM, deck.count), free + run_mm)
    stop = np.minimum(stop, IRIS_RADIUS_MM + 0.02)
    start = np.minimum(start, stop - 0.1)
    return lay_runs(start.astype(np.float32), stop.astype(np.float32), step=step_mm)


def _bundle_offset(
    deck: Deck,
    runs: Runs,
    owner: Integers,
    *,
    beyond: Field,
    key: int,
    rng: np.random.Generator,
) -> Field:
    """Return each point's distance in mm from its guide: own side, the bundle's and own waves."""
    side = rng.normal(0.0, deck.spread_mm, deck.count).astype(np.float32)[runs.run]
    # Bundles open and close along the radius.
    offset = side * (0.75 + 0.45 * noise_1d(owner, runs.at / np.float32(0.45), key + 101))
    wave = deck.wave_mm * np.clip(beyond / 1.2, 0.15, 1.0)
    offset += wave * noise_1d(owner, runs.at / np.float32(0.36), key + 202)
    offset += 0.007 * noise_1d(runs.run, runs.at / np.float32(0.13), key + 303)
    return np.asarray(offset, np.float32)


def iris_tubes(layout: IrisLayout, seed: int, *, step_mm: float) -> list[Tubes]:
    """Return every fibre of the iris, deep to high: what a list's later members cover.

    Points are at most ``step_mm`` apart along the radius.
    """
    deep, children, bundles, cords = (
        ciliary_tubes(layout, seed, index=index, step_mm=step_mm) for index in range(len(DECKS))
    )
    pupillary = pupillary_tubes(layout, seed, step_mm=step_mm)
    collarette = collarette_tubes(layout, seed, step_mm=step_mm)
    return [deep, children, join_tubes([bundles, pupillary]), join_tubes([cords, collarette])]
