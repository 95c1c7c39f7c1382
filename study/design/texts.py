"""The words that a participant reads: consent, instructions, thanks, contact."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from study.design.parts import Name, Part, Text


class Paragraph(Part):
    """One paragraph, with a heading if it opens a section."""

    heading: str = ""
    text: Text


class Page(Part):
    """A page of text with the words on its button."""

    title: Text
    paragraphs: Annotated[tuple[Paragraph, ...], Field(min_length=1)]
    button: Text


class Consent(Page):
    """What a participant agrees to; the version is stored with the agreement.

    ``statements`` are the sentences to tick before going on; ``decline`` is the other way out.
    """

    version: Name
    statements: tuple[Text, ...] = ()
    decline: Text = "I do not want to take part"


class Contact(Part):
    """Whom to ask: shown with the consent and on every page that reports a problem."""

    name: Text
    email: str = ""
    details: str = ""


class Thanks(Part):
    """The last page; the completion code is shown with it."""

    title: Text
    paragraphs: Annotated[tuple[Paragraph, ...], Field(min_length=1)]
