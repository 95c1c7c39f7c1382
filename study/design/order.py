"""How trials follow each other: drawn for each participant, balanced over them, or as the file has
them."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from study.design.faults import refuse
from study.design.parts import Part, Whole


class Order(Part):
    """The trials' order, how often a clip may be watched, and which trials are warm-up.

    ``trials``: "random" draws an order for everybody, "balanced" gives everybody a row of a Latin
    square, "file" keeps the file's order. The first ``warm_up`` trials are flagged in the tables.
    """

    trials: Literal["random", "balanced", "file"] = "random"
    min_views: Annotated[Whole, Field(ge=1, le=10)] = 1
    max_views: Annotated[Whole, Field(ge=1, le=100)] | None = None
    warm_up: Annotated[Whole, Field(ge=0)] = 0

    def is_warm_up(self, number: int, *, is_practice: bool) -> bool:
        """Say whether a trial is one of the first, in which people still find their scale."""
        return not is_practice and number <= self.warm_up

    @model_validator(mode="after")
    def _views_fit(self) -> Self:
        if self.max_views is not None and self.max_views < self.min_views:
            raise refuse(f"max_views: {self.max_views} is fewer than min_views, {self.min_views}")
        return self
