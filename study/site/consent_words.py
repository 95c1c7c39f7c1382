"""What a participant agrees to, word for word as the page shows it.

The study file's words, and where it has none the catalogue's, in the participant's language.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass

from study.design.definition import StudyDefinition
from study.texts import Catalogue


@dataclass(frozen=True)
class ConsentWords:
    """The texts of the page; what a study does not need is empty."""

    title: str
    motion_warning: str
    paragraphs: tuple[tuple[str, str], ...]
    parameters: str
    withdrawal: tuple[str, ...]
    statements: tuple[str, ...]
    health: str
    health_statement: str

    @property
    def sha256(self) -> str:
        """64 hexadecimal digits that tell this text from every other."""
        text = json.dumps(asdict(self), ensure_ascii=False, sort_keys=True)
        return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()


def consent_words(definition: StudyDefinition, words: Catalogue) -> ConsentWords:
    """Return the texts of a study's consent; ``words`` speaks the participant's language."""
    consent, text = definition.consent, words.text
    health = consent.health
    return ConsentWords(
        title=consent.title,
        motion_warning=consent.motion_warning or text("consent.motion"),
        paragraphs=tuple((p.heading, p.text) for p in consent.paragraphs),
        parameters=_parameters(definition, words),
        withdrawal=_withdrawal(definition, words),
        statements=_statements(definition, words),
        health="" if health is None else health.text or text("consent.health"),
        health_statement=""
        if health is None
        else health.statement or text("consent.health_statement"),
    )


def _parameters(definition: StudyDefinition, words: Catalogue) -> str:
    """Say what the addresses of those who invite people bring; nothing where they bring nothing."""
    names = ", ".join(one.name for one in definition.entrance.parameters)
    return words.text("consent.parameters", names=names) if names else ""


def _withdrawal(definition: StudyDefinition, words: Catalogue) -> tuple[str, ...]:
    """Say what withdrawing removes, and what it cannot reach: backups and published archives."""
    consent, text = definition.consent, words.text
    if consent.withdrawal is not None:
        return (consent.withdrawal,)
    place = "consent.place_shared" if definition.entrance.shared_computers else "consent.place"
    backups = (
        text("consent.backups")
        if consent.backup_days is None
        else text("consent.backup_days", count=consent.backup_days)
    )
    return text("consent.withdrawal"), text(place), backups, text("consent.archives")


def _statements(definition: StudyDefinition, words: Catalogue) -> tuple[str, ...]:
    """Return the sentences to tick; at least one, because agreement has to be explicit."""
    consent = definition.consent
    age = consent.minimum_age
    confirmed = () if age is None else (words.text("consent.age", count=age),)
    return (*confirmed, *consent.statements) or (words.text("consent.statement"),)
