"""Clips in which the camera approaches, and LoDs that follow from the size of the eye.

Pure. The policy's thresholds stand in a file beside the study; a study keeps its contents.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator

from renderer.camera import IRIS_PX
from renderer.clip_values import DISTANCES
from renderer.lod.choice import LodPolicy
from renderer.lod.policy import default_policy, parse_policy
from study.design.faults import Fault, dotted, refuse, unknown
from study.design.parts import Part, Real, clip_value
from study.design.raw import Data, rows_of, table_of


def _read_place(value: Any) -> float:
    """Read where an approach starts or ends: a distance's name, or an iris in pixels."""
    if isinstance(value, str):
        if value not in DISTANCES:
            raise refuse(
                unknown("distance", value, DISTANCES) + "; or give an iris's diameter in pixels"
            )
        return IRIS_PX[value]
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise refuse(f"{value!r} is no place; write a distance, or an iris's diameter in pixels")
    return float(value)


class Approach(Part):
    """The camera's way in clips with the motion "approach".

    ``start`` and ``end`` are iris diameters in pixels on 1080 lines, or distances that stand for
    theirs; without an ``end`` the camera ends at the clip's distance.
    """

    start: Annotated[float, BeforeValidator(_read_place), clip_value("approach_start_px")] = 12.0
    end: Annotated[float, BeforeValidator(_read_place), clip_value("approach_end_px")] | None = None
    azimuth_deg: Annotated[Real, clip_value("approach_azimuth_deg")] = 0.0
    duration_s: Annotated[Real, clip_value("duration_s")] = 5.0

    def fields(self, distance: str) -> dict[str, Any]:
        """Return the fields of a clip's spec that an approach to a distance sets."""
        return {
            "motion": "approach",
            "approach_start_px": self.start,
            "approach_end_px": IRIS_PX[distance] if self.end is None else self.end,
            "approach_azimuth_deg": self.azimuth_deg,
            "duration_s": self.duration_s,
        }


def _check_policy(data: dict[str, Any]) -> dict[str, Any]:
    try:
        parse_policy(json.dumps(data), source="lod_policy")
    except ValueError as error:
        raise refuse(str(error).removeprefix("lod_policy: ")) from None
    return data


PolicyData = Annotated[dict[str, Any], AfterValidator(_check_policy)]


def policy_of(data: Mapping[str, Any] | None) -> LodPolicy:
    """Return a study's policy: its own, or the one that comes with the renderer."""
    if data is None:
        return default_policy()
    return parse_policy(json.dumps(data), source="lod_policy").policy


def check_switching(data: Data) -> Iterator[Fault]:
    """Yield the faults of LoDs that switch: levels of their own, or others built on them."""
    lods = table_of(data, "lods")
    for name, row in lods.items():
        if not isinstance(row, Mapping):
            continue
        if row.get("switching") is not None:
            for key in row:
                if key != "switching" and row[key] is not None:
                    yield Fault(
                        dotted(("lods", name, key)),
                        "a LoD that switches takes its levels from the lod_policy; leave this out",
                    )
        base = row.get("base")
        built_on = lods.get(base) if isinstance(base, str) else None
        if isinstance(built_on, Mapping) and built_on.get("switching") is not None:
            yield Fault(
                dotted(("lods", name, "base")), f'"{base}" switches and has no levels to start from'
            )


def check_approaches(data: Data) -> Iterator[Fault]:
    """Yield a fault for every approach that would end too near for one camera to show both eyes."""
    if table_of(data, "approach").get("end") is not None:
        return
    for table in ("practice", "clips", "catch", "factors"):
        for index, row in rows_of(data, table):
            if row.get("motion") != "approach":
                continue
            found = row.get("distances") if table == "factors" else [row.get("distance")]
            if isinstance(found, list) and "macroscopic" in found:
                key = "distances" if table == "factors" else "distance"
                yield Fault(
                    dotted((table, index, key)),
                    'one camera cannot show both eyes at "macroscopic"; approach "near", or say '
                    "in [approach] where the camera ends",
                )
