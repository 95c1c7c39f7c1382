"""Which family a browser belongs to: explains odd playback, and tells too little of a person."""

from __future__ import annotations

from typing import Final

# In this order: most browsers also name those that they descend from.
_SIGNS: Final = (
    ("Edg", "Edge"),
    ("OPR/", "Opera"),
    ("SamsungBrowser", "Samsung Internet"),
    ("Firefox/", "Firefox"),
    ("FxiOS", "Firefox"),
    ("CriOS", "Chrome"),
    ("Chromium", "Chrome"),
    ("Chrome/", "Chrome"),
    ("Safari/", "Safari"),
)


def browser_family(user_agent: str) -> str:
    """Return "Firefox", "Safari" and so on, or "other"."""
    return next((family for sign, family in _SIGNS if sign in user_agent), "other")
