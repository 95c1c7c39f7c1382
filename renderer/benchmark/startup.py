"""How long a start takes and how much memory it needs, measured in fresh processes.

Cold: an empty cache of bakes and of compiled shaders, as on the first start after an installation.
Warm: the same caches again. Memory: a process per LoD with the user's own cache.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, Final

from renderer.benchmark.result import Bench, Memory, Stage
from renderer.benchmark.stand import Stand, Step
from renderer.detail import STANDARD_LODS

STARTUP, MEMORY = "startup", "memory"
LOD: Final = "ultra"
MEGA: Final = 1e6


def startup_steps(*, is_quick: bool) -> list[Step]:
    """Return one step: a cold start, then a warm one; in a hurry one with the cache as it is."""
    if is_quick:
        return [Step(STARTUP, "as it is", 25.0, _start_as_it_is)]
    return [Step(STARTUP, "cold, then warm", 200.0, _start)]


def memory_steps(*, is_quick: bool) -> list[Step]:
    """Return a step per LoD; in a hurry ultra alone."""
    lods = STANDARD_LODS[-1:] if is_quick else STANDARD_LODS
    return [Step(MEMORY, lod, 30.0, partial(_remember, lod=lod)) for lod in lods]


def _start(stand: Stand, bench: Bench) -> None:
    with tempfile.TemporaryDirectory() as folder:
        for cache in ("cold", "warm"):
            _add(bench, cache, in_fresh_process(LOD, stand.size, caches_in(Path(folder))))


def _start_as_it_is(stand: Stand, bench: Bench) -> None:
    _add(bench, "as it is", in_fresh_process(LOD, stand.size, {}))


def _add(bench: Bench, cache: str, told: Mapping[str, Any]) -> None:
    bench.startup.extend(
        Stage(lod=LOD, cache=cache, stage=stage, seconds=round(seconds, 3))
        for stage, seconds in told["seconds"].items()
    )


def _remember(stand: Stand, bench: Bench, *, lod: str) -> None:
    told = in_fresh_process(lod, stand.size, {})
    bench.memory.extend(
        Memory(lod=lod, kind=kind, megabytes=round(held / MEGA, 1))
        for kind, held in told["bytes"].items()
    )


def caches_in(folder: Path) -> dict[str, str]:
    """Return the environment that puts our cache and the drivers' caches into a folder."""
    return {
        "OCULARIST_CACHE": str(folder / "bakes"),
        "MESA_SHADER_CACHE_DIR": str(folder / "mesa"),
        "__GL_SHADER_DISK_CACHE_PATH": str(folder / "nvidia"),
    }


def in_fresh_process(lod: str, size: tuple[int, int], changes: Mapping[str, str]) -> dict[str, Any]:
    """Set up a LoD in a process of its own, with some environment variables changed.

    Raises RuntimeError with the last line that it wrote when it fails.
    """
    for folder in changes.values():
        Path(folder).mkdir(parents=True, exist_ok=True)
    done = subprocess.run(
        [sys.executable, "-m", "renderer.benchmark.setting_up", lod, "{}x{}".format(*size)],
        env={**os.environ, **changes},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise RuntimeError(f"startup: setting up {lod} failed ({done.returncode}): {last}")
    return dict(json.loads(done.stdout.splitlines()[-1]))
