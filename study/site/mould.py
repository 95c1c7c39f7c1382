"""Moulds: a page rendered once, with places for what differs from one to the next.

Filling one costs a hundredth of rendering the page. What a template asks about (whether, how many)
cannot be a place: it belongs to the mould's name.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field
from typing import Final

from markupsafe import Markup, escape

MOST: Final = 2000
"""Moulds that are kept, each some kilobytes; then it begins anew."""
# Nobody who writes a study or an answer knows it, so nobody's words can be taken for a place.
_EDGE: Final = f"place-{secrets.token_hex(8)}-"


def place(name: str) -> Markup:
    """Return what stands for a value while a mould is rendered."""
    return Markup(f"{_EDGE}{name}.")


@dataclass(frozen=True)
class Mould:
    """The parts of a page, and the names of what stands between them."""

    parts: tuple[str, ...]
    names: tuple[str, ...]

    def fill(self, values: Mapping[str, object]) -> str:
        """Return the page; values are escaped unless they are marked safe."""
        pieces = list(self.parts)
        for n, name in enumerate(self.names):
            pieces[n] += str(escape(values[name]))
        return "".join(pieces)


def mould_of(rendered: str) -> Mould:
    """Cut a page that was rendered with ``place`` for its values."""
    first, *rest = rendered.split(_EDGE)
    pairs = [piece.split(".", 1) for piece in rest]
    return Mould((first, *(part for _, part in pairs)), tuple(name for name, _ in pairs))


@dataclass
class Moulds:
    """Moulds by their names."""

    _kept: dict[Hashable, Mould] = field(default_factory=dict)

    def of(self, name: Hashable, render: Callable[[], str]) -> Mould:
        """Return the mould of a name; ``render`` makes the page for a new one."""
        kept = self._kept.get(name)
        if kept is None:
            if len(self._kept) >= MOST:
                self._kept.clear()
            kept = self._kept[name] = mould_of(render())
        return kept
