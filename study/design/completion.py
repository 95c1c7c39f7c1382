"""How taking part may end: completed, screened out, or with failed checks; its code and its page.

Declared before anybody takes part, in the study file. Pure: it knows no page and no answer.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from string import Formatter
from typing import Annotated, Final, Literal
from urllib.parse import quote

from pydantic import AfterValidator, Field

from study.design.faults import Fault, refuse, unknown
from study.design.parts import Part, Text, Whole
from study.design.raw import Data, rows_of, table_of
from study.design.texts import Paragraph

Outcome = Literal["completed", "screened_out", "failed_checks"]
OUTCOMES: Final[tuple[Outcome, ...]] = ("completed", "screened_out", "failed_checks")
GENERATED: Final = "generated"
NO_CODE: Final = "none"


def _check_code(code: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9-]{1,40}", code):
        raise refuse(
            f'"{code}" is no code; use 1 to 40 letters, digits and "-", or write "{GENERATED}" for '
            f'one of their own for everybody, "{NO_CODE}" for none'
        )
    return code


def _check_redirect(template: str) -> str:
    if not re.match(r"https?://[^\s/{}]+", template):
        raise refuse(f'"{template}" is no address; begin it with https:// and the name of the site')
    try:
        names_in(template)
    except ValueError as error:
        raise refuse(f'"{template}": {error}; write a place as {{code}}') from None
    return template


def names_in(template: str) -> set[str]:
    """Return the places of an address: ``{"code"}`` of ``https://example.org/?cc={code}``."""
    return {name for _, name, _, _ in Formatter().parse(template) if name is not None}


class Ending(Part):
    """The page and the code of one outcome.

    ``redirect`` leads back to where people were recruited; ``{code}`` and the names of parameters
    that are stored plain are filled in. Words left out are the program's own, in the participant's
    language; those of a completed session stand in ``[thanks]``.
    """

    code: Annotated[str, AfterValidator(_check_code)] | None = None
    redirect: Annotated[str, AfterValidator(_check_redirect)] | None = None
    redirect_label: Text | None = None
    title: Text | None = None
    paragraphs: tuple[Paragraph, ...] = ()


class CheckRule(Part):
    """How many failed checks of a kind, or more, make a session end with ``failed_checks``.

    Practice clips and questions about the instructions never count: who misunderstood has not been
    careless.
    """

    failed_attention: Annotated[Whole, Field(ge=1)] | None = None
    failed_gold: Annotated[Whole, Field(ge=1)] | None = None

    def is_failed(self, *, attention: int, gold: int) -> bool:
        """Say whether so many failed checks are too many."""
        pairs = ((attention, self.failed_attention), (gold, self.failed_gold))
        return any(limit is not None and failed >= limit for failed, limit in pairs)


class Completion(Part):
    """What each outcome leads to, and the rule that tells failed checks."""

    completed: Ending = Ending()
    screened_out: Ending = Ending()
    failed_checks: Ending = Ending()
    rule: CheckRule = CheckRule()

    def ending(self, outcome: str) -> Ending:
        """Return what an outcome leads to; raises KeyError for another word."""
        return {
            "completed": self.completed,
            "screened_out": self.screened_out,
            "failed_checks": self.failed_checks,
        }[outcome]

    def code_of(self, outcome: str) -> str:
        """Return an outcome's code, GENERATED or NO_CODE.

        Left out, who took part gets a code of their own and who could not gets none.
        """
        return self.ending(outcome).code or (NO_CODE if outcome == "screened_out" else GENERATED)


def filled(template: str, values: Mapping[str, str]) -> str:
    """Fill an address; every value is quoted, so that it can be nothing but a value."""
    return template.format(**{name: quote(value, safe="") for name, value in values.items()})


def check_completion(data: Data) -> Iterator[Fault]:
    """Yield addresses with a place that nothing fills."""
    recruiting = table_of(data, "recruiting")
    plain = [
        str(row.get("name"))
        for _, row in rows_of(recruiting, "parameters")
        if row.get("store") == "plain"
    ]
    for outcome, ending in table_of(data, "completion").items():
        template = ending.get("redirect") if isinstance(ending, Mapping) else None
        if not isinstance(template, str):
            continue
        has_code = ending.get("code", NO_CODE if outcome == "screened_out" else "") != NO_CODE
        accepted = [*(["code"] if has_code else []), *plain]
        try:
            names = names_in(template)
        except ValueError:  # reported with the address itself
            continue
        for name in sorted(names - set(accepted)):
            words = unknown("place", name, accepted)
            yield Fault(
                f"completion.{outcome}.redirect",
                f"{words}; a parameter can be filled in only where it is stored plain",
            )
