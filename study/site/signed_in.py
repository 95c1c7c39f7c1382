"""Which researcher is asking: by the signed cookie that signing in has left.

Their posts must carry the token of their cookie, as participants' do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final

from fastapi import Depends, Request

from study.data import researchers
from study.site.access import ElsewhereError, check_csrf
from study.site.forms import first, read_form
from study.site.place import Here
from study.site.signatures import csrf_token, read_researcher

RESEARCHER_COOKIE: Final = "ocularist_researcher"


@dataclass(frozen=True)
class SignedIn:
    """A researcher as a page sees them."""

    researcher: researchers.Researcher
    csrf: str
    cookie: str

    @property
    def name(self) -> str:
        """The name that they sign in with."""
        return self.researcher.name


def signed_in(request: Request, here: Here) -> SignedIn:
    """Return the researcher whose cookie the request carries; others are led to the door."""
    cookie = request.cookies.get(RESEARCHER_COOKIE, "")
    found = read_researcher(here.secret, cookie)
    researcher = None if found is None else researchers.by_id(here.db, found)
    if researcher is None:
        raise ElsewhereError("/researcher/sign-in")
    return SignedIn(researcher, csrf_token(here.secret, cookie), cookie)


ResearcherHere = Annotated[SignedIn, Depends(signed_in)]


async def researchers_form(
    request: Request, here: Here, researcher: ResearcherHere
) -> dict[str, list[str]]:
    """Return a researcher's posted form if it is truly theirs."""
    fields = await read_form(request)
    check_csrf(here.secret, researcher.cookie, first(fields, "csrf"))
    return fields


ResearchersForm = Annotated[dict[str, list[str]], Depends(researchers_form)]
