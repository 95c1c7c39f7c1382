"""The documents say what the code says: every column, every key, every link."""

from __future__ import annotations

import re
import tomllib
import typing
from collections.abc import Iterator
from pathlib import Path
from types import UnionType
from typing import Any

import pytest
from pydantic import BaseModel

from analysis import COLUMNS, Column
from study.design.audit import warnings
from study.design.definition import StudyDefinition, parse_definition
from study.design.parts import Size

ROOT = Path(__file__).parent.parent
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
TOPS = ("analysis", "renderer", "study")
FOLDERS = (*TOPS, "tests", "templates", "static", "deploy")
SOURCES = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.*")]


def row_of(column: Column) -> str:
    """Return the line of docs/tables.md that describes a column."""
    kind = column.kind + (f", {column.unit}" if column.unit else "")
    accepted = ", ".join(f"`{choice}`" for choice in column.choices)
    if column.low is not None or column.high is not None:
        ends = [f"{end:g}" if end is not None else "" for end in (column.low, column.high)]
        accepted = f"{ends[0]} to {ends[1]}" if all(ends) else f"from {ends[0]}"
    return f"| `{column.name}` | {kind} | {column.meaning} | {accepted} |"


@pytest.mark.parametrize("table", COLUMNS)
def test_every_column_is_described_in_its_order(table: str) -> None:
    text = (ROOT / "docs" / "tables.md").read_text(encoding="utf-8")
    section = text.split(f"## `{table}.csv`\n")[1].split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("| `")]
    assert rows == [row_of(column) for column in COLUMNS[table]]


def models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    """Yield the models that an annotation mentions, and those inside them."""
    if annotation is Size:  # which is written as one text, "1280x720"
        return
    if typing.get_origin(annotation) in (typing.Union, UnionType, typing.Annotated, tuple, dict):
        for argument in typing.get_args(annotation):
            yield from models_in(argument)
    elif isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
        for field in annotation.model_fields.values():
            yield from models_in(field.annotation)


def test_every_key_of_a_study_file_is_explained() -> None:
    text = (ROOT / "docs" / "study-file.md").read_text(encoding="utf-8")
    explained = set(re.findall(r"^\| `(\w+)` \|", text, flags=re.MULTILINE))
    keys = {name for model in models_in(StudyDefinition) for name in model.model_fields}
    assert len(keys) > 50
    assert explained == keys


def links(document: Path) -> list[tuple[str, str]]:
    """Return file and anchor of each link within the documents; an empty file is the same one."""
    targets = re.findall(r"\]\(([^)]+)\)", document.read_text(encoding="utf-8"))
    parts = [target.partition("#") for target in targets if "://" not in target]
    return [(file, anchor) for file, _, anchor in parts]


def anchors(document: Path) -> set[str]:
    """Return the anchors of a document's headings, as GitHub makes them."""
    text = re.sub(r"(?ms)^```.*?^```$", "", document.read_text(encoding="utf-8"))
    titles = re.findall(r"(?m)^#+ (.+)$", text)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_link_leads_somewhere(document: Path) -> None:
    for file, anchor in links(document):
        target = document.parent / file if file else document
        assert target.exists(), file
        assert not anchor or anchor in anchors(target), f"{file}#{anchor}"


def test_the_whole_study_of_the_documents_can_be_checked() -> None:
    text = (ROOT / "docs" / "study-file.md").read_text(encoding="utf-8").split("## A whole study")
    study = parse_definition(tomllib.loads(re.findall(r"(?ms)^```toml\n(.*?)^```$", text[1])[0]))
    shown = len(study.irises), len(study.distances), len(study.trial_clips), len(study.gold)
    assert shown == (2, 3, 12, 1)
    assert "PROLIFIC_PID" in {each.name for each in study.recruiting.parameters}
    assert unanswered(study) == ["questions: none is called noticed; the analysis goes without it"]


def unanswered(study: StudyDefinition) -> list[str]:
    return [line for line in warnings(study) if line.startswith("questions: ")]


def test_the_index_leads_to_every_page_and_names_every_room() -> None:
    index = ROOT / "docs" / "README.md"
    pages = {path.name for path in index.parent.glob("*.md")} - {"README.md"}
    assert pages - {file for file, _ in links(index)} == set()
    text = index.read_text(encoding="utf-8")
    rooms = {path.parent.name for top in TOPS for path in (ROOT / top).rglob("*/__init__.py")}
    assert {room for room in rooms - {"versions"} if f"`{room}`" not in text} == set()


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_source_that_a_page_names_exists(document: Path) -> None:
    text = document.read_text(encoding="utf-8")
    named = set(re.findall(r"`([\w/]+\.(?:py|frag|vert|glsl))`", text))
    ends = [f"/{path.relative_to(ROOT).as_posix()}" for path in SOURCES]
    assert [name for name in named if not any(end.endswith(f"/{name}") for end in ends)] == []


def test_every_file_that_the_decisions_name_exists() -> None:
    text = (ROOT / "docs" / "decisions.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`((?:renderer|study|analysis)/[\w/.]+\.\w+)`", text))
    assert named
    assert [name for name in named if not (ROOT / name).is_file()] == []


def test_every_command_of_the_readme_exists() -> None:
    from study.cli import COMMANDS

    text = (ROOT / "README.md").read_text(encoding="utf-8")
    named = re.findall(r"^\| `ocularist ([\w-]+)", text, flags=re.MULTILINE)
    assert list(dict.fromkeys(named)) == [*COMMANDS]


def test_every_setting_is_explained() -> None:
    text = (ROOT / "docs" / "running.md").read_text(encoding="utf-8")
    source = (ROOT / "study" / "settings.py").read_text(encoding="utf-8")
    named = set(re.findall(r"OCULARIST_[A-Z]+", source))
    assert named
    assert named <= set(re.findall(r"`(OCULARIST_[A-Z]+)`", text))
