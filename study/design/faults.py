"""Faults of a study file: where each stands, what was found, what is accepted.

Pure text work. Knows pydantic's error records, and nothing of studies.
"""

from __future__ import annotations

import difflib
import types
import typing
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails, PydanticCustomError

Place = tuple[str | int, ...]
# What tables are told apart by: the kinds of question (``question_kinds``).
KINDS: Final = ("choice", "multiple", "scale", "analogue", "number", "text", "matrix")


@dataclass(frozen=True, order=True)
class Fault:
    """One fault: its place in the file ("clips.0.distance") and what to do about it."""

    place: str
    message: str

    def __str__(self) -> str:
        return f"{self.place}: {self.message}" if self.place else self.message


class DefinitionError(ValueError):
    """A study file cannot be used; ``faults`` holds every reason at once, one line each."""

    def __init__(self, source: str, faults: Sequence[Fault]) -> None:
        self.source = source
        self.faults = tuple(faults)
        super().__init__("\n".join(f"{source}: {fault}" for fault in faults))


def dotted(place: Iterable[str | int]) -> str:
    """Write a place as in the file: ``("clips", 0, "left")`` becomes ``clips.0.left``."""
    return ".".join(str(part) for part in place)


def suggestion(found: str, accepted: Iterable[str]) -> str:
    """Return ``; did you mean "..."?`` when an accepted name is close to ``found``."""
    close = difflib.get_close_matches(found, list(accepted), n=1, cutoff=0.6)
    return f'; did you mean "{close[0]}"?' if close else ""


def unknown(noun: str, found: object, accepted: Iterable[str]) -> str:
    """Say that ``found`` is no such ``noun``, and which there are."""
    names = list(accepted)
    listed = f"choose one of {', '.join(names)}" if names else f"no {noun} is defined"
    return f'unknown {noun} "{found}"; {listed}{suggestion(str(found), names)}'


def refuse(message: str) -> PydanticCustomError:
    """Wrap a finished sentence so that pydantic reports it as it stands."""
    return PydanticCustomError("study", "{message}", {"message": message})


def faults_of(error: ValidationError, model: type[BaseModel]) -> list[Fault]:
    """Turn pydantic's errors about ``model`` into our sentences."""
    records = error.errors(include_url=False)
    deep = {details["loc"][:-1] for details in records}
    # A list whose only entries are faulty is also reported as too short: one fault is enough.
    return [
        _fault(details, model)
        for details in records
        if not (details["type"] == "too_short" and details["loc"] in deep)
    ]


def _fault(details: ErrorDetails, model: type[BaseModel]) -> Fault:
    place, parent = _walk(model, details["loc"])
    kind, context = details["type"], details.get("ctx", {})
    if kind == "extra_forbidden":
        accepted = list(parent.model_fields) if parent else []
        return Fault(dotted(place), unknown("key", place[-1], accepted))
    if kind == "missing":
        return Fault(dotted(place), "missing; this key is required")
    if kind == "union_tag_not_found":
        return Fault(dotted((*place, "kind")), f"missing; choose one of {', '.join(KINDS)}")
    if kind == "union_tag_invalid":
        found = str(context.get("tag"))
        return Fault(dotted((*place, "kind")), unknown("kind", found, KINDS))
    if kind == "study":
        return Fault(dotted(place), str(context["message"]))
    words = _EXPECTED.get(kind)
    message = f"expected {words}" if words else details["msg"][0].lower() + details["msg"][1:]
    return Fault(dotted(place), f"{message}; found {_shown(details['input'])}")


# What pydantic calls dictionaries and tuples, in the words of a TOML file.
_EXPECTED: Final = {
    **dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), "a table"),
    **dict.fromkeys(("tuple_type", "list_type"), "a list"),
    "string_type": "text in quotes",
    "float_type": "a number",
    **dict.fromkeys(("int_type", "int_from_float", "int_parsing"), "a whole number"),
    **dict.fromkeys(("bool_type", "bool_parsing"), "true or false"),
}


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _walk(model: type[BaseModel], location: Place) -> tuple[Place, type[BaseModel] | None]:
    """Follow a location through the models.

    Returns the place without the names of union branches that pydantic puts into it, and the model
    that holds the last part.
    """
    place: list[str | int] = []
    current: Any = model
    parent: type[BaseModel] | None = None
    for part in location:
        branches = _branches(current)
        if isinstance(part, str) and part in branches:
            current = branches[part]
            continue
        place.append(part)
        inner = _unwrapped(current)
        parent = inner if isinstance(inner, type) and issubclass(inner, BaseModel) else None
        current = _inside(inner, part)
    return tuple(place), parent


def _unwrapped(annotation: Any) -> Any:
    """Strip ``Annotated`` and ``| None`` from an annotation."""
    if typing.get_origin(annotation) is typing.Annotated:
        return _unwrapped(typing.get_args(annotation)[0])
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        kept = [arg for arg in typing.get_args(annotation) if arg is not types.NoneType]
        return _unwrapped(kept[0]) if len(kept) == 1 else annotation
    return annotation


def _branches(annotation: Any) -> dict[str, Any]:
    """Return tag -> model of a union that is told apart by ``kind``."""
    inner = _unwrapped(annotation)
    if typing.get_origin(inner) not in (typing.Union, types.UnionType):
        return {}
    models = [arg for arg in typing.get_args(inner) if hasattr(arg, "model_fields")]
    tagged = [model for model in models if "kind" in model.model_fields]
    return {typing.get_args(model.model_fields["kind"].annotation)[0]: model for model in tagged}


def _inside(annotation: Any, part: str | int) -> Any:
    """Return the annotation of a model's field, a mapping's value or a sequence's element."""
    if hasattr(annotation, "model_fields"):
        field = annotation.model_fields.get(part)
        return None if field is None else field.annotation
    arguments = typing.get_args(annotation)
    if typing.get_origin(annotation) is dict:
        return arguments[1]
    return arguments[0] if arguments else None
