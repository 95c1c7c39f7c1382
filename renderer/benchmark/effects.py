"""Each effect at each level: frames with it minus frames without it, from two bases.

From ``low`` every other effect stays low: what an effect costs when it is added to almost nothing.
From ``ultra`` every other effect stays ultra: what a game gets back that leaves it out. The two
differ where effects share work, as refraction and caustics share the light's direction. One eye
alone at macroscopic: what its 350-pixel iris costs.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from renderer.benchmark.clock import WARM_UP
from renderer.benchmark.result import Bench
from renderer.benchmark.spread import difference
from renderer.benchmark.stand import Stand, Step
from renderer.detail import EFFECTS, LEVELS, STANDARD_LODS, TABLE, Detail

PART: Final = "effects"
BASES: Final = ("low", "ultra")
WEIGHT: Final = {"low": 0.4, "ultra": 1.0}  # of a frame


def levels_of(effect: str, *, is_quick: bool = False) -> tuple[str, ...]:
    """Return ``off`` and the levels of an effect that are not the same as off (Table 5.1: None).

    In a hurry only the highest.
    """
    off = TABLE[effect]["off"].settings
    levels = [level for level in LEVELS[1:] if TABLE[effect][level].settings != off]
    return ("off", *(levels[-1:] if is_quick else levels))


def effect_steps(rounds: int, *, is_quick: bool) -> list[Step]:
    """Return a step per base and effect; in a hurry ultra minus none, from ultra alone."""
    return [
        Step(
            PART,
            f"{effect} from {base}",
            len(levels_of(effect, is_quick=is_quick)) * WEIGHT[base] * (rounds + WARM_UP + 8),
            partial(_measure, effect=effect, base=base, is_quick=is_quick),
        )
        for base in BASES[1 if is_quick else 0 :]
        for effect in EFFECTS
    ]


def _measure(stand: Stand, bench: Bench, *, effect: str, base: str, is_quick: bool) -> None:
    levels = levels_of(effect, is_quick=is_quick)
    lod = Detail.uniform(base)
    specs = [stand.spec(lod.with_levels(**{effect: level})) for level in levels]
    whole = stand.spec(lod)
    variants = [stand.kept_frames(s) if s == whole else stand.frames(s) for s in specs]
    off, *others = stand.time(variants)
    bench.rows.extend(
        stand.row(PART, spec, difference(own, off), effect=effect, level=level, base=base)
        for level, spec, own in zip(levels[1:], specs[1:], others, strict=True)
    )


def is_none(effect: str, level: str) -> bool:
    """Say whether Table 5.1 says None: that level and ``off`` are the same frames."""
    return level in STANDARD_LODS and level not in levels_of(effect)
