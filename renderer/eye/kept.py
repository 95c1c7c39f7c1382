"""What is made for one eye and fits others: both eyes of a clip, and the clips after it.

Encoding and uploading an iris costs seconds, drawing with it milliseconds. A key names everything
that a thing depends on. Knows no eye and no clip.
"""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeVar

import moderngl
import numpy as np
import numpy.typing as npt

Made = TypeVar("Made")

LIMIT_BYTES: Final = 512 << 20  # two irises at all four LoDs take about half of it
SMALL_BYTES: Final = 1 << 16  # what anything but a texture or an array counts
_MIPS: Final = 4 / 3


@dataclass(frozen=True, eq=False)
class Same:
    """A key's part that means this very object: for what has no value to compare."""

    item: object

    def __hash__(self) -> int:
        return id(self.item)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other.item is self.item


class Kept:
    """Things of one GL context by key, within ``limit_bytes``: what was used last stays."""

    def __init__(self, limit_bytes: int = LIMIT_BYTES) -> None:
        self._limit = limit_bytes
        self._things: OrderedDict[Hashable, tuple[Any, int]] = OrderedDict()
        self.used_bytes = 0

    def get(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """Return what is kept under a key, or make and keep it.

        The newest stays whatever its size; a thing that is dropped lives on where it is in use.
        """
        if key not in self._things:
            made = make()
            size = size_bytes(made)
            self._things[key] = made, size
            self.used_bytes += size
            while self.used_bytes > self._limit and len(self._things) > 1:
                _, (_, dropped) = self._things.popitem(last=False)
                self.used_bytes -= dropped
        self._things.move_to_end(key)
        thing: Made = self._things[key][0]
        return thing


def size_bytes(thing: object) -> int:
    """Return about how much memory a thing takes: textures with mips, arrays, groups of them."""
    if isinstance(thing, Mapping):
        return sum(size_bytes(item) for item in thing.values())
    if isinstance(thing, moderngl.Texture):
        depth = int(thing.dtype[1:]) * thing.components
        return int(thing.width * thing.height * depth * _MIPS)
    return thing.nbytes if isinstance(thing, np.ndarray) else SMALL_BYTES


def fingerprint(*arrays: npt.NDArray[Any]) -> str:
    """Return a name that arrays with the same numbers share."""
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(f"{array.shape}{array.dtype}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()
