"""A person's build and features: MakeHuman's shape targets, weighed and summed. Pure numpy."""

from __future__ import annotations

import functools
import gzip
import itertools
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from renderer.body.makehuman import MM_PER_UNIT, Floats, Indices, base_mesh, data_folder

RACES: Final = ("african", "asian", "caucasian")
# Where each macro property has a modelled shape: MakeHuman's macro.json.
ANCHORS: Final[Mapping[str, Mapping[str, float]]] = MappingProxyType(
    {
        "gender": {"female": 0.0, "male": 1.0},
        "age": {"baby": 0.0, "child": 0.1875, "young": 0.5, "old": 1.0},  # 1, 11, 25, 90 years
        "muscle": {"minmuscle": 0.0, "averagemuscle": 0.5, "maxmuscle": 1.0},
        "weight": {"minweight": 0.0, "averageweight": 0.5, "maxweight": 1.0},
        "height": {"minheight": 0.0, "": 0.5, "maxheight": 1.0},
        "proportions": {"uncommonproportions": 0.0, "": 0.5, "idealproportions": 1.0},
        "cupsize": {"mincup": 0.0, "averagecup": 0.5, "maxcup": 1.0},
        "firmness": {"minfirmness": 0.0, "averagefirmness": 0.5, "maxfirmness": 1.0},
    }
)
_BODY: Final = ("gender", "age", "muscle", "weight")
# Folder and file prefix of each family of macro targets, and the properties in its file names.
_FAMILIES: Final = (
    ("macrodetails/universal-", _BODY),
    ("macrodetails/height/", (*_BODY, "height")),
    ("macrodetails/proportions/", (*_BODY, "proportions")),
    ("breast/", (*_BODY, "cupsize", "firmness")),
)


@functools.cache
def _sparse_target(name: str) -> tuple[Indices, Floats]:
    path = _target_path(name)
    if path is None:
        raise ValueError(
            f'unknown target "{name}"; choose a file below mpfb2/targets such as '
            "nose/nose-width1-decr, or faceunits/eyeBlinkLeft"
        )
    data = path.read_bytes()
    text = (gzip.decompress(data) if path.suffix == ".gz" else data).decode()
    rows = [line.split() for line in text.splitlines() if line[:1].isdigit()]
    table = np.array(rows, dtype=float).reshape(-1, 4)
    return table[:, 0].astype(np.int64), table[:, 1:] * MM_PER_UNIT


def _target_path(name: str) -> Path | None:
    data = data_folder()
    for folder in (data / "mpfb2" / "targets", data / "faceunits01" / "targets"):
        for suffix in (".target.gz", ".target"):
            path = folder / f"{name}{suffix}"
            if path.is_file():
                return path
    return None


def target_offsets(weights: Mapping[str, float]) -> Floats:
    """Return the summed offsets (n, 3) in mm of named targets with their weights.

    Names are paths below ``mpfb2/targets`` (``nose/nose-width1-decr``) or ``faceunits/...``.
    """
    offsets = np.zeros_like(base_mesh().vertices_mm)
    for name, weight in weights.items():
        rows, moves = _sparse_target(name)
        offsets[rows] += weight * moves
    return offsets


def phenotype(
    *, races: Mapping[str, float] | None = None, cupsize: float = 0.5, **values: float
) -> Floats:
    """Return the offsets (n, 3) in mm that give the base mesh a person's build.

    ``values``: gender (0 female, 1 male), age (0.1875: 11, 0.5: 25, 1: 90 years), muscle, weight,
    height, proportions, firmness, each 0 to 1 and 0.5 if left out; ``races``: shares of RACES.
    """
    unknown = sorted(set(values) - set(ANCHORS))
    if unknown:
        raise ValueError(
            f"phenotype: unknown {', '.join(unknown)}; choose from {', '.join(ANCHORS)}"
        )
    wanted = {**dict.fromkeys(ANCHORS, 0.5), "cupsize": cupsize, **values}
    shares = {name: _anchor_weights(name, wanted[name]) for name in ANCHORS}
    weights = dict(_race_weights(races or dict.fromkeys(RACES, 1.0), shares))
    for prefix, names in _FAMILIES:
        for combination in itertools.product(*(shares[name].items() for name in names)):
            name = prefix + "-".join(anchor for anchor, _ in combination)
            weight = float(np.prod([share for _, share in combination]))
            # The averages of height, proportions and bust are the base shape: they have no file.
            if weight > 0 and _target_path(name) is not None:
                weights[name] = weight
    return target_offsets(weights)


def _race_weights(
    races: Mapping[str, float], shares: Mapping[str, Mapping[str, float]]
) -> Iterable[tuple[str, float]]:
    total = sum(races.values())
    for (race, part), (gender, g), (age, a) in itertools.product(
        races.items(), shares["gender"].items(), shares["age"].items()
    ):
        yield f"macrodetails/{race}-{gender}-{age}", part / total * g * a


def _anchor_weights(name: str, value: float) -> dict[str, float]:
    """Share a value between the two anchors around it, linearly."""
    if not 0.0 <= value <= 1.0:
        raise ValueError(f"phenotype: {name} = {value} lies outside 0 to 1")
    anchors = list(ANCHORS[name].items())
    places = [place for _, place in anchors]
    upper = max(1, int(np.searchsorted(places, value)))
    part = (value - places[upper - 1]) / (places[upper] - places[upper - 1])
    pairs = ((anchors[upper - 1][0], 1.0 - part), (anchors[upper][0], part))
    return {anchor: share for anchor, share in pairs if share > 0}
