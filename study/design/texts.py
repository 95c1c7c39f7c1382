"""The words that a participant reads: consent, instructions, thanks, contact."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from study.design.faults import Fault, unknown
from study.design.parts import MaybeText, Name, NameText, Part, Text, Translated, Whole
from study.design.raw import Data, rows_of, table_of


class Paragraph(Part):
    """One paragraph, with a heading if it opens a section."""

    heading: MaybeText = ""
    text: Text


class Page(Part):
    """A page of text with the words on its button."""

    title: Text
    paragraphs: Annotated[tuple[Paragraph, ...], Field(min_length=1)]
    button: Text


class HealthConsent(Part):
    """A consent of its own for what eyes can and cannot see: health data.

    Whoever does not give it takes part all the same; ``questions`` about the participant and the
    checks of eyesight and colour vision are left out for them.
    """

    text: Text | None = None
    statement: Text | None = None
    questions: tuple[Name, ...] = ()


class Consent(Page):
    """What a participant agrees to; the version is stored with the agreement.

    ``statements`` are the sentences to tick before going on; ``decline`` is the other way out.
    ``minimum_age`` in years asks everybody to confirm it. ``backup_days`` is how long copies made
    for safety are kept: the page says so where it says what withdrawing means.
    """

    version: Name
    statements: tuple[Text, ...] = ()
    decline: Text = "I do not want to take part"
    minimum_age: Annotated[Whole, Field(ge=1, le=120)] | None = None
    motion_warning: Text | None = None
    withdrawal: Text | None = None
    backup_days: Annotated[Whole, Field(ge=0, le=3650)] | None = None
    health: HealthConsent | None = None

    @property
    def tick_count(self) -> int:
        """How many sentences have to be ticked: at least one, as agreement has to be explicit."""
        return max(1, len(self.statements) + (self.minimum_age is not None))

    def asks(self, question_id: str, *, with_health: bool) -> bool:
        """Say whether a question about the participant is asked, given the consent to it."""
        return with_health or self.health is None or question_id not in self.health.questions


def check_consent(data: Data) -> Iterator[Fault]:
    """Yield questions that the consent to health data names and nobody asks."""
    asked = [str(row.get("id")) for _, row in rows_of(data, "about")]
    named = table_of(table_of(data, "consent"), "health").get("questions")
    for index, name in enumerate(named if isinstance(named, list) else ()):
        if name not in asked:
            place = f"consent.health.questions.{index}"
            yield Fault(place, unknown("question about the participant", name, asked))


class Contact(Part):
    """Whom to ask: shown with the consent and on every page that reports a problem."""

    name: NameText
    email: str = ""
    details: Annotated[str, Translated(is_needed=False)] = ""


class Thanks(Part):
    """The last page; the completion code is shown with it."""

    title: Text
    paragraphs: Annotated[tuple[Paragraph, ...], Field(min_length=1)]
