"""The file of a LoD policy: thresholds in pixels, what they rest on, and what each LoD costs.

``docs/lod-by-pixels.md`` describes the format. Reads and writes its own file, knows no GL.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, Final

from renderer.atomic_file import write_atomically
from renderer.detail import STANDARD_LODS, Detail
from renderer.lod.choice import LodPolicy, LodStep

SCHEMA: Final = 1
DEFAULT_NAME: Final = "policy.json"  # beside this module
_KEYS: Final = {"schema", "measure", "hysteresis", "band", "steps", "provenance"}
_STEP_KEYS: Final = {"lod", "levels", "up_to_iris_px", "interval_px", "ms"}


@dataclass(frozen=True)
class Evidence:
    """What a step's threshold rests on: its interval in pixels, and the LoD's cost in ms an eye."""

    interval_px: tuple[float, float] | None = None
    ms: float | None = None


@dataclass(frozen=True)
class PolicyFile:
    """A policy with its evidence, step by step, and where it comes from."""

    policy: LodPolicy
    evidence: tuple[Evidence, ...]
    measure: str
    provenance: Mapping[str, Any] = field(default_factory=dict)


@cache
def default_policy() -> LodPolicy:
    """Return the policy that comes with the renderer, derived by ``renderer.lod.derivation``."""
    text = (resources.files("renderer.lod") / DEFAULT_NAME).read_text(encoding="utf-8")
    return parse_policy(text, source=DEFAULT_NAME).policy


def read_policy(path: Path) -> PolicyFile:
    """Read a policy file; raises ValueError naming the file and what is wrong in it."""
    return parse_policy(path.read_text(encoding="utf-8"), source=path.name)


def parse_policy(text: str, *, source: str) -> PolicyFile:
    """Read a policy file's text; ``source`` names it in messages."""
    try:
        return _policy_file(json.loads(text))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        told = f"no {error}" if isinstance(error, KeyError) else str(error)
        raise ValueError(
            f"{source}: not a LoD policy of schema {SCHEMA}: {told}; docs/lod-by-pixels.md "
            "describes the format"
        ) from error


def _policy_file(data: Mapping[str, Any]) -> PolicyFile:
    if data["schema"] != SCHEMA:
        raise ValueError(f"schema: {data['schema']}")
    _refuse_unknown("", data, _KEYS)
    steps, evidence = [], []
    for number, row in enumerate(data["steps"]):
        _refuse_unknown(f"steps.{number}.", row, _STEP_KEYS)
        limit = row.get("up_to_iris_px")
        if limit is not None:
            limit = _number(f"steps.{number}.up_to_iris_px", limit)
        steps.append(LodStep(row["lod"], _detail(row, number), limit))
        interval = row.get("interval_px")
        evidence.append(Evidence((interval[0], interval[1]) if interval else None, row.get("ms")))
    shares = {name: _number(name, data[name]) for name in ("hysteresis", "band")}
    policy = LodPolicy(tuple(steps), **shares)
    return PolicyFile(policy, tuple(evidence), data["measure"], data.get("provenance", {}))


def _refuse_unknown(place: str, row: Mapping[str, Any], accepted: set[str]) -> None:
    for key in row:
        if key not in accepted:
            raise ValueError(
                f"{place}{key}: unknown key; choose one of {', '.join(sorted(accepted))}"
            )


def _number(place: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{place}: {value!r} is no number")
    return float(value)


def _detail(row: Mapping[str, Any], number: int) -> Detail:
    if "levels" in row:
        return Detail(**row["levels"])
    if row["lod"] not in STANDARD_LODS:
        raise ValueError(
            f"steps.{number}.levels: missing; only {', '.join(STANDARD_LODS)} are known by name, "
            f'"{row["lod"]}" needs the level of each effect'
        )
    return Detail.uniform(row["lod"])


def write_policy(file: PolicyFile, path: Path) -> None:
    """Write a policy file atomically."""
    write_atomically(path, (policy_text(file) + "\n").encode())


def policy_text(file: PolicyFile) -> str:
    """Return a policy file's text; ``parse_policy`` reads it back."""
    rows: list[dict[str, Any]] = []
    for step, evidence in zip(file.policy.steps, file.evidence, strict=True):
        is_standard = step.lod in STANDARD_LODS and step.detail == Detail.uniform(step.lod)
        rows.append(
            {
                "lod": step.lod,
                **({} if is_standard else {"levels": step.detail.levels()}),
                "up_to_iris_px": step.up_to_iris_px,
                "interval_px": list(evidence.interval_px) if evidence.interval_px else None,
                "ms": evidence.ms,
            }
        )
    return json.dumps(
        {
            "schema": SCHEMA,
            "measure": file.measure,
            "hysteresis": file.policy.hysteresis,
            "band": file.policy.band,
            "steps": rows,
            "provenance": dict(file.provenance),
        },
        indent=1,
    )
