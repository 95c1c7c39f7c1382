"""Make strips one after the other into a folder; those that are there and current are kept."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Final

from renderer.atomic_file import write_atomically
from renderer.gallery.drawing import draw_strip, encode
from renderer.gallery.shots import Shots
from renderer.gallery.strips import Strip
from renderer.sources import code_version

INDEX: Final = "gallery.json"


def chosen(strips: Sequence[Strip], only: Sequence[str]) -> tuple[Strip, ...]:
    """Return the strips named in ``only``, all of them where it is empty.

    Raises ValueError naming each unknown one and those that exist.
    """
    names = [strip.name for strip in strips]
    unknown = [name for name in only if name not in names]
    if unknown:
        raise ValueError(
            "\n".join(f'unknown strip "{name}"; choose of {", ".join(names)}' for name in unknown)
        )
    return tuple(strip for strip in strips if not only or strip.name in only)


def make_strips(
    strips: Sequence[Strip],
    folder: Path,
    *,
    size: tuple[int, int],
    kind: str = "jpg",
    anew: bool = False,
    open_shots: Callable[[tuple[int, int]], Shots] = Shots,
) -> Iterator[tuple[Strip, Path, bool]]:
    """Yield each strip with its file and whether it was made now.

    A strip is kept where the file is as it was written by this version of the code at this size;
    ``anew`` makes all of them. An interrupted run goes on where it stopped.
    """
    version = f"{code_version()}:{size[0]}x{size[1]}"
    shots: Shots | None = None
    try:
        for strip in strips:
            path = folder / f"{strip.name}.{kind}"
            if not anew and _is_current(path, version):
                yield strip, path, False
                continue
            shots = shots or open_shots(size)
            tiles = strip.tiles(shots.take)
            picture = draw_strip(strip.title, tiles, columns=strip.columns, tile_px=strip.tile_px)
            _keep(path, encode(picture, kind), version)
            yield strip, path, True
    finally:
        if shots:
            shots.close()


def _is_current(path: Path, version: str) -> bool:
    try:
        return _index(path.parent).get(path.name) == [version, _digest(path.read_bytes())]
    except OSError:
        return False


def _keep(path: Path, data: bytes, version: str) -> None:
    write_atomically(path, data)
    index = _index(path.parent) | {path.name: [version, _digest(data)]}
    text = json.dumps(index, indent=1, sort_keys=True) + "\n"
    write_atomically(path.parent / INDEX, text.encode())


def _index(folder: Path) -> dict[str, list[str]]:
    """Return file name -> version and digest; nothing where there is no index or a broken one."""
    try:
        index: dict[str, list[str]] = json.loads((folder / INDEX).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return index if isinstance(index, dict) else {}


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]
