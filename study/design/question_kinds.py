"""The kinds of question that a study can ask.

Pure models of the study file's tables. What counts as an answer to each is ``questions``'s to say.
A matrix is a set of scales, one per row, or one per row and eye: ``each_asked`` takes it apart.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Final, Literal

from pydantic import Field

from study.design.parts import Flag, MaybeText, Name, Part, Real, StoredText, Text, Whole

Value = int | float | str | list[str]
MAX_TEXT_CHARS: Final = 10_000
MAX_DECIMALS: Final = 6
EYES: Final = ("left", "right")
Number = Whole | Real


class Labelled(Part):
    """Something to choose or to rate that is known by its label."""

    label: Text


class Option(Labelled):
    """One answer of a choice: what is stored and what is read on the page."""

    value: Whole | StoredText


class TickOption(Labelled):
    """One of several answers that may be ticked together; an exclusive one stands alone."""

    value: Name
    is_exclusive: Flag = False


class MatrixRow(Labelled):
    """One row of a matrix."""

    id: Name


class ShownIf(Part):
    """Show a question only after certain answers to another one.

    Either one of ``values`` was given (of several ticked, any), or a number within bounds.
    """

    question: Name
    values: tuple[Whole | StoredText, ...] = ()
    at_least: Number | None = None
    at_most: Number | None = None


class _Question(Part):
    """What all questions have. ``is_required`` is false unless the file says otherwise."""

    id: Name
    text: Text
    help: MaybeText = ""
    is_required: Flag = False
    shown_if: ShownIf | None = None


class _Steps(_Question):
    """Whole numbers between two named ends; ``labels`` may name every one of them."""

    lowest: Whole = 1
    highest: Whole = 5
    lowest_label: MaybeText = ""
    highest_label: MaybeText = ""
    labels: tuple[Text, ...] = ()

    def label(self, step: int) -> str:
        """Return the words at a step; empty where it has none."""
        if self.labels:
            return self.labels[step - self.lowest]
        return {self.lowest: self.lowest_label, self.highest: self.highest_label}.get(step, "")


class ChoiceQuestion(_Question):
    """Pick one of a few."""

    kind: Literal["choice"]
    options: Annotated[tuple[Option, ...], Field(min_length=2)]


class MultipleQuestion(_Question):
    """Tick as many as apply, within limits."""

    kind: Literal["multiple"]
    options: Annotated[tuple[TickOption, ...], Field(min_length=2)]
    fewest: Annotated[Whole, Field(ge=1)] = 1
    most: Annotated[Whole, Field(ge=1)] | None = None


class ScaleQuestion(_Steps):
    """Pick a whole number between two named ends."""

    kind: Literal["scale"]


class AnalogueQuestion(_Question):
    """Mark a place on a line between two named ends; stored as a whole number."""

    kind: Literal["analogue"]
    lowest_label: Text
    highest_label: Text
    minimum: Whole = 0
    maximum: Whole = 100


class NumberQuestion(_Question):
    """Type a number within limits, whole unless ``decimals`` are wanted."""

    kind: Literal["number"]
    minimum: Number
    maximum: Number
    unit: MaybeText = ""
    decimals: Annotated[Whole, Field(ge=0, le=MAX_DECIMALS)] = 0


class TextQuestion(_Question):
    """Write in one's own words."""

    kind: Literal["text"]
    max_chars: Annotated[Whole, Field(ge=1, le=MAX_TEXT_CHARS)] = 2000
    is_long: Flag = True


class MatrixQuestion(_Steps):
    """Rate several things on the same scale, for each eye if ``per_eye``."""

    kind: Literal["matrix"]
    rows: Annotated[tuple[MatrixRow, ...], Field(min_length=1)]
    per_eye: Flag = False

    @property
    def sides(self) -> tuple[str, ...]:
        """The eyes that it asks about: both, or one empty word for neither in particular."""
        return EYES if self.per_eye else ("",)

    def cell(self, row: MatrixRow, side: str) -> ScaleQuestion:
        """Return the scale of one row, for one eye where it asks about each."""
        shared = {name: getattr(self, name) for name in _Steps.model_fields}
        words = {"id": cell_id(self.id, row.id, side), "text": f"{self.text} – {row.label}"}
        return ScaleQuestion(kind="scale", **{**shared, **words})

    def cells(self) -> tuple[ScaleQuestion, ...]:
        """Return every scale, eye by eye."""
        return tuple(self.cell(row, side) for side in self.sides for row in self.rows)


def cell_id(matrix: str, row: str, side: str = "") -> str:
    """Return the id of one scale of a matrix: ``realism_iris_left``."""
    return "_".join(part for part in (matrix, row, side) if part)


Asked = (
    ChoiceQuestion
    | MultipleQuestion
    | ScaleQuestion
    | AnalogueQuestion
    | NumberQuestion
    | TextQuestion
)
Question = Annotated[Asked | MatrixQuestion, Field(discriminator="kind")]


def each_asked(questions: Iterable[Question]) -> tuple[Asked, ...]:
    """Return everything that gets an answer of its own: questions, and the scales of a matrix."""
    asked: list[Asked] = []
    for question in questions:
        if isinstance(question, MatrixQuestion):
            asked += question.cells()
        else:
            asked.append(question)
    return tuple(asked)
