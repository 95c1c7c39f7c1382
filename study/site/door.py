"""The dashboard's door: sign in, sign out."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Request
from fastapi.responses import HTMLResponse, Response

from study.data import researchers
from study.data.researchers import MustWaitError
from study.site.access import (
    redirect,
    remember,
)
from study.site.forms import first, read_form
from study.site.place import Here
from study.site.signatures import SIGN_IN_S, sign_researcher
from study.site.signed_in import RESEARCHER_COOKIE, ResearchersForm

router = APIRouter(default_response_class=HTMLResponse)


@router.get("/researcher/sign-in")
def door(here: Here) -> Response:
    """Ask for name and password."""
    return _page(here)


def _page(here: Here, *, name: str = "", fault: str = "", status: int = 200) -> Response:
    return here.page(
        "researcher/sign_in.html",
        status=status,
        heading="Sign in",
        study_title=here.study().title,
        researcher=None,
        section="",
        name=name,
        fault=fault,
    )


@router.post("/researcher/sign-in")
def sign_in(
    request: Request, here: Here, fields: Annotated[dict[str, list[str]], Depends(read_form)]
) -> Response:
    """Let a researcher in; guessers wait longer and longer."""
    name = first(fields, "name").strip()
    address = request.client.host if request.client else ""
    try:
        found = researchers.sign_in(here.db, name, first(fields, "password"), address=address)
    except MustWaitError as error:
        page = _page(here, name=name, fault=f"{str(error).capitalize()}.", status=429)
        page.headers["Retry-After"] = str(error.wait_s)
        return page
    if found is None:
        return _page(here, name=name, fault="Name or password is not right.", status=401)
    answer = redirect("/researcher")
    cookie = sign_researcher(here.secret, found.id)
    remember(request, answer, RESEARCHER_COOKIE, cookie, SIGN_IN_S)
    return answer


@router.post("/researcher/sign-out")
def sign_out(fields: ResearchersForm) -> Response:
    """Make this browser forget the researcher."""
    del fields  # the form carries only its proof
    answer = redirect("/researcher/sign-in")
    answer.delete_cookie(RESEARCHER_COOKIE)
    return answer
