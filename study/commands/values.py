"""How the texts of options become values, and how those that cannot be are refused."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


def reading(read: Callable[[str], T]) -> Callable[[str], T]:
    """Let argparse show the message of a reader's ValueError instead of a general one."""

    def convert(text: str) -> T:
        try:
            return read(text)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return convert


@reading
def size(text: str) -> tuple[int, int]:
    """Read ``1280x720`` as width and height in pixels."""
    match = re.fullmatch(r"(\d{2,5})x(\d{2,5})", text.strip())
    if not match:
        raise ValueError(f'"{text}" is no size; write width x height in pixels, like 1280x720')
    return int(match[1]), int(match[2])


@reading
def count(text: str) -> int:
    """Read a whole number of at least 1."""
    if not text.isdecimal() or int(text) < 1:
        raise ValueError(f'"{text}" is no count; write a whole number, 1 or more')
    return int(text)


@reading
def port(text: str) -> int:
    """Read a TCP port."""
    if not text.isdecimal() or not 0 < int(text) < 65536:
        raise ValueError(f'"{text}" is no port; write a number from 1 to 65535')
    return int(text)


@reading
def whole_number(text: str) -> int:
    """Read a whole number from 0 on, such as a seed."""
    if not re.fullmatch(r"[0-9]{1,18}", text):
        raise ValueError(f'"{text}" is no whole number; write one from 0 on, like 7')
    return int(text)


@reading
def number(text: str) -> float:
    """Read a decimal number with a point."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f'"{text}" is no number; write one like 0.5')
    return value


@reading
def language(text: str) -> str:
    """Read a language as study files name it."""
    if not re.fullmatch("[a-z]{2,3}(-[a-z0-9]{2,8})*", text):
        raise ValueError(f'"{text}" is no language; write its code in small letters: ar, pt-br')
    return text
