"""Ocularist's own version, as results name it."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version


def own_version() -> str:
    """Return the installed version; "from source" in a tree that was never installed."""
    try:
        return version("ocularist")
    except PackageNotFoundError:
        return "from source"
