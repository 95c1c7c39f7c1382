"""Tasks beside the drawing: in order, never far behind, their errors not lost."""

from __future__ import annotations

import threading
from functools import partial

import pytest

from renderer.production.beside import WAITING, Beside


def fail() -> None:
    raise OSError("no space left")


def test_tasks_are_done_in_order_before_the_block_is_left() -> None:
    done: list[int] = []
    with Beside() as beside:
        for number in range(20):
            beside.do(partial(done.append, number))
    assert done == list(range(20))


def test_whoever_is_too_far_ahead_waits() -> None:
    gate, started = threading.Event(), threading.Event()
    given: list[int] = []

    def open_gate() -> None:
        gate.wait(30)

    def give() -> None:
        with Beside() as beside:
            for number in range(WAITING + 1):
                beside.do(open_gate)
                given.append(number)
                if len(given) == WAITING:
                    started.set()

    thread = threading.Thread(target=give)
    thread.start()
    assert started.wait(10)
    thread.join(0.05)
    assert given == list(range(WAITING))
    gate.set()
    thread.join(10)
    assert len(given) == WAITING + 1


def failing(times: int) -> None:
    with Beside() as beside:
        for _ in range(times):
            beside.do(fail)


@pytest.mark.parametrize("times", [1, WAITING + 1])
def test_an_error_is_raised_by_a_later_call_or_at_the_end(times: int) -> None:
    with pytest.raises(OSError, match="no space left"):
        failing(times)


def wait_a_moment() -> None:
    threading.Event().wait(0.05)


def leaving_early(done: list[int]) -> None:
    with Beside() as beside:
        beside.do(wait_a_moment)
        beside.do(partial(done.append, 1))
        raise KeyError


def test_an_error_inside_the_block_goes_first_and_nothing_more_is_begun() -> None:
    done: list[int] = []
    with pytest.raises(KeyError):
        leaving_early(done)
    assert done == []
