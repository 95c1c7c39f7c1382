"""Pages and scripts ask for texts that there are, and every text is asked for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from study.texts import catalogue

ROOT = Path(__file__).parents[2]
TEXTS = catalogue("en").texts
PAGES = sorted((ROOT / "templates" / "participant").rglob("*.html"))
CODE = sorted((ROOT / "study").rglob("*.py"))
SCRIPTS = sorted((ROOT / "static").rglob("*.js"))
SECTIONS = "|".join(sorted({key.partition(".")[0] for key in TEXTS}))
# A key in quotes; "{...}" stands for a part that is put in when the page is made.
KEY = re.compile(rf'["\']((?:{SECTIONS})(?:\.(?:[a-z0-9_]+|\{{[^}}]+\}}))+)["\']')
SCRIPT_KEY = re.compile(r'\btext\(\s*["`]([a-z0-9_.$\{\}]+)["`]')


def keys_in(path: Path) -> set[str]:
    """Return the keys that a file asks for; ``*`` in one stands for anything."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".js":
        found = {f"scripts.{key}" for key in SCRIPT_KEY.findall(source)}
    else:
        found = set(KEY.findall(source))
    found = {key for key in found if not key.endswith((".css", ".js", ".html"))}
    return {re.sub(r"\$?\{[^}]+\}", "*", key) for key in found}


def matches(pattern: str, key: str) -> bool:
    return re.fullmatch(re.escape(pattern).replace(r"\*", "[a-z0-9_]+"), key) is not None


@pytest.mark.parametrize("path", [*PAGES, *SCRIPTS], ids=lambda path: path.name)
def test_every_key_that_is_asked_for_exists(path: Path) -> None:
    missing = {key for key in keys_in(path) if not any(matches(key, known) for known in TEXTS)}
    assert missing == set()


def test_every_text_is_asked_for() -> None:
    asked = {key for path in (*PAGES, *CODE, *SCRIPTS) for key in keys_in(path)}
    exact = {key for key in asked if "*" not in key}
    patterns = asked - exact
    unused = [
        key
        for key in TEXTS
        if key not in exact and not any(matches(pattern, key) for pattern in patterns)
    ]
    assert unused == []


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_pages_hold_no_words_of_their_own(path: Path) -> None:
    source = path.read_text(encoding="utf-8")
    plain = re.sub(r"\{#.*?#\}|\{%.*?%\}|\{\{.*?\}\}", " ", source, flags=re.DOTALL)
    plain = re.sub(r'\s[a-z-]+="[^"]*"(?![^<>]*>)', " ", plain)  # attributes that a macro returns
    labels = re.findall(r'(?:aria-label|alt|title|placeholder)="\s*[^"\s]*[A-Za-z]{2,}', plain)
    words = re.findall(r"[A-Za-z]{2,}", re.sub(r"<[^>]*>", " ", plain))
    assert (labels, words) == ([], [])


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.name)
def test_scripts_of_participants_write_no_words_of_their_own(path: Path) -> None:
    if path.name.startswith(("inspect", "researcher")):
        return  # these pages are English
    source = path.read_text(encoding="utf-8")
    assert re.findall(r'textContent\s*=\s*["`][^"`]*[a-z]{2,} [a-z].*', source) == []
