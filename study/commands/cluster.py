"""A Dask cluster as an Executor: reach its scheduler, and see that all of it is of our version."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib import import_module
from typing import Any, Final

from study.commands.errors import CommandError

ANSWER_S: Final = 5.0  # a scheduler that does not answer within is not there
# Sent as text: a function would have to be imported there, which is what this finds out.
_VERSION: Final = "__import__('importlib').import_module('renderer.sources').code_version()"


@contextmanager
def cluster(address: str, *, say: Callable[[str], None]) -> Iterator[Executor]:
    """Give the executor of the cluster whose scheduler listens at ``address``.

    ``say`` hears when nobody works there yet. Raises CommandError when nobody answers, when it is
    no scheduler, or when it or one of its workers has another version of the renderer.
    """
    try:
        dask: Any = import_module("dask")  # neither has types
        distributed: Any = import_module("distributed")
    except ImportError as error:
        raise CommandError(
            f"--scheduler needs {error.name}, which is not installed here; "
            "pip install 'ocularist[cluster]'"
        ) from None
    # A lost connection is told in our words; a picture sent along is meant to be that large.
    with _quiet("distributed", "distributed.client"), dask.config.set(_SETTINGS):
        workers = _identify(distributed, address)
        client = distributed.Client(address, timeout=ANSWER_S, set_as_default=False)
        try:
            _check_versions(client, address)
            if not workers:
                say(f"{address} has no workers yet; start some: dask worker {address} --nthreads 1")
            yield client.get_executor(pure=False)
        finally:
            client.close()


_SETTINGS: Final = {"distributed.admin.large-graph-warning-threshold": "2 GiB"}


def _identify(distributed: Any, address: str) -> int:
    """Return how many workers a scheduler has."""
    try:
        found = asyncio.run(_ask(distributed, address))
    except ValueError as error:
        raise CommandError(
            f"--scheduler {address}: no address ({error}); write tcp://HOST:8786"
        ) from None
    except Exception as error:
        # Whatever else may listen there answers in its own way, and so it fails in any way.
        raise CommandError(
            f"--scheduler {address}: no Dask scheduler answers there "
            f"({str(error) or f'not within {ANSWER_S:g} s'}); start one: dask scheduler"
        ) from None
    if found.get("type") != "Scheduler":
        raise CommandError(
            f"--scheduler {address}: a {found.get('type')} answers there, no scheduler; "
            "dask scheduler prints its address when it starts"
        )
    return int(found.get("n_workers", len(found["workers"])))


async def _ask(distributed: Any, address: str) -> dict[str, Any]:
    async with distributed.rpc(address, timeout=ANSWER_S) as listener:
        return dict(await asyncio.wait_for(listener.identity(), ANSWER_S))


def _check_versions(client: Any, address: str) -> None:
    from renderer.sources import code_version

    found = client.run(eval, _VERSION, on_error="return")
    try:
        found[address] = client.run_on_scheduler(eval, _VERSION)
    except Exception as error:
        found[address] = error
    faults = [
        f"{place} has no Ocularist that can be imported ({answer})"
        if isinstance(answer, BaseException)
        else f"{place} has version {answer} of the renderer, this machine {code_version()}"
        for place, answer in found.items()
        if answer != code_version()
    ]
    if faults:
        raise CommandError(
            "\n".join(f"{fault}; install the same Ocularist there" for fault in faults)
        )


@contextmanager
def _quiet(*names: str) -> Iterator[None]:
    """Keep a library's log out of the terminal."""
    loggers = [logging.getLogger(name) for name in names]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)
