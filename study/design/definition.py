"""A whole study in one file: read it and check it as a whole. Code names no clip.

Pure apart from reading the file. Every fault of a file is reported at once, with its place.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from importlib import resources
from itertools import product
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from renderer.clip_values import DIRECTIONS
from study.design.attention import late_attention
from study.design.checks import cross_faults
from study.design.faults import DefinitionError, Fault, faults_of, suggestion
from study.design.files import find_files
from study.design.model import StudyDefinition
from study.design.pauses import late_breaks
from study.design.per_person import per_person_faults
from study.design.translations import find_translations, translation_faults
from study.design.wanted import WantedClip

__all__ = [
    "DefinitionError",
    "StudyDefinition",
    "WantedClip",
    "built_in_names",
    "parse_definition",
    "read_definition",
]


def built_in_names() -> list[str]:
    """Return the names of the studies that come with Ocularist."""
    folder = resources.files("study.design") / "definitions"
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in folder.iterdir()
        if entry.name.endswith(".toml") and entry.name.count(".") == 1  # lod.ar.toml is no study
    )


def read_definition(
    name_or_path: str | Path, *, without_translation: str | None = None
) -> StudyDefinition:
    """Read a built-in study by name or any study by the path of its file.

    ``without_translation`` is a language whose file is not looked at, for it is yet to be written.
    Raises DefinitionError with every fault of the file.
    """
    text, source = _read_text(str(name_or_path))
    folder = Path() if str(name_or_path) in built_in_names() else Path(name_or_path).parent
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise DefinitionError(source, [Fault("", f"not a TOML file: {error}")]) from None
    if isinstance(named := data.get("translations"), list) and without_translation in named:
        data["translations"] = [language for language in named if language != without_translation]
    found, absent = find_files(data, folder)
    found, untranslated = find_translations(found, _beside(str(name_or_path)))
    return parse_definition(found, source=source, faults=[*absent, *untranslated])


def _beside(name_or_path: str) -> Path:
    """Return the path of a study's own file, beside which its translations lie."""
    if name_or_path in built_in_names():
        return Path(str(resources.files("study.design") / "definitions" / f"{name_or_path}.toml"))
    return Path(name_or_path)


def parse_definition(
    data: Mapping[str, Any], *, source: str = "definition", faults: Sequence[Fault] = ()
) -> StudyDefinition:
    """Check the contents of a study file; raises DefinitionError with every fault at once.

    ``faults`` are those that reading its files has shown already.
    """
    faults = [*faults, *cross_faults(data)]
    try:
        definition = StudyDefinition.model_validate(dict(data))
    except ValidationError as error:
        faults = faults_of(error, StudyDefinition) + faults
    faults = faults or [
        *_clip_faults(definition),
        *_design_faults(definition),
        *_translation_faults(definition),
    ]
    if faults:
        raise DefinitionError(source, list(dict.fromkeys(faults)))
    return definition


def _translation_faults(definition: StudyDefinition) -> Iterator[Fault]:
    """Yield what the translations lack; a study must be whole in each of its languages."""
    for language, words in definition.translations.items():
        if language == definition.language:
            yield Fault(f"translations.{language}", "this is the study's own language")
        else:
            yield from translation_faults(definition, words, f"translations.{language}")


def _clip_faults(definition: StudyDefinition) -> Iterator[Fault]:
    """Yield what a clip refuses about an approach: its end may lie too near for a size's shape."""
    for size, clip in product(definition.sizes, definition.every_clip):
        if clip.motion == "approach":
            try:
                definition.clip_spec(clip, size=size, orbit_direction=DIRECTIONS[0])
            except ValueError as error:
                yield Fault("approach", f"{size}: {error}")


def _design_faults(definition: StudyDefinition) -> Iterator[Fault]:
    """Yield what only the whole design shows: blocks out of balance, pauses after the end."""
    faults = list(per_person_faults(definition.trial_clips, definition.per_person))
    yield from faults
    if not faults:
        count = definition.trial_count
        yield from late_attention(count, definition.attention)
        yield from late_breaks(count, definition.breaks)
        for index, gold in enumerate(definition.gold):
            if gold.after >= count:
                place = f"gold.{index}.after"
                yield Fault(place, f"{gold.after} is no place among {count} trials")
        if definition.order.warm_up >= count:
            found = f"{definition.order.warm_up} of {count} trials"
            yield Fault("order.warm_up", f"{found}; no trial would be left")


def _read_text(name_or_path: str) -> tuple[str, str]:
    """Return the text and the name that messages give it."""
    names = built_in_names()
    if name_or_path in names:
        resource = resources.files("study.design") / "definitions" / f"{name_or_path}.toml"
        return resource.read_text(encoding="utf-8"), resource.name
    path = Path(name_or_path)
    try:
        # Some editors put a mark of their own before UTF-8 text.
        return path.read_text(encoding="utf-8-sig"), path.name
    except UnicodeDecodeError as error:
        raise DefinitionError(path.name, [Fault("", f"not UTF-8 text: {error}")]) from None
    except OSError as error:
        reason = (
            f"cannot be read ({error.strerror}); give the path of a TOML file or a built-in study: "
            f"{', '.join(names)}{suggestion(name_or_path, names)}"
        )
        raise DefinitionError(name_or_path, [Fault("", reason)]) from None
