"""The same form posts at the same durability: this site beside oTree 6, one after the other.

Not a test: ``python tests/bench_load.py`` makes oTree an environment of its own (out/otree), gives
it a page with the thesis's questions, and lets the same crowd post it. SQLite waits for the disk in
both (oTree's file with SQLite's defaults: journal DELETE, synchronous FULL).
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import re
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import venv
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from study.design.definition import read_definition
from study.load.crowd import Timings
from study.load.person import _answers
from study.load.report import machine
from study.load.runs import SQLITE, Run, measure
from study.load.wire import Wire

OTREE = "otree>=6,<7"
ROOM = Path(__file__).parent.parent / "out" / "otree"
SETTINGS = """
SESSION_CONFIGS = [dict(name="eyes", app_sequence=["eyes"], num_demo_participants=1)]
SESSION_CONFIG_DEFAULTS = dict(real_world_currency_per_point=1, participation_fee=0)
LANGUAGE_CODE = "en"
REAL_WORLD_CURRENCY_CODE = "EUR"
USE_POINTS = True
ADMIN_USERNAME = "admin"
ADMIN_PASSWORD = "admin"
SECRET_KEY = "for a benchmark"
DEMO_PAGE_INTRO_HTML = ""
"""
APP = """
from otree.api import *


class C(BaseConstants):
    NAME_IN_URL = "eyes"
    PLAYERS_PER_GROUP = None
    NUM_ROUNDS = {rounds}


class Subsession(BaseSubsession):
    pass


class Group(BaseGroup):
    pass


class Player(BasePlayer):
    comparison = models.IntegerField(choices=[-1, 0, 1], widget=widgets.RadioSelect, blank=True)
    noticed = models.StringField(choices=["yes", "no", "unsure"], blank=True)
    what_differed = models.LongStringField(blank=True)
    rating_left = models.IntegerField(choices=[1, 2, 3, 4, 5], blank=True)
    rating_right = models.IntegerField(choices=[1, 2, 3, 4, 5], blank=True)
    comments = models.LongStringField(blank=True)


class Page1(Page):
    form_model = "player"
    form_fields = [
        "comparison", "noticed", "what_differed", "rating_left", "rating_right", "comments",
    ]


page_sequence = [Page1]
"""
PAGE = """
{{ block title }}Clip{{ endblock }}
{{ block content }}{{ formfields }}{{ next_button }}{{ endblock }}
"""


def install() -> Path:
    """Return the programs' folder of oTree's own environment."""
    programs = ROOM / "bin"
    if not (programs / "otree").exists():
        venv.create(ROOM, with_pip=True)
        subprocess.run([programs / "pip", "install", "--quiet", OTREE], check=True)
    return programs


def free_port() -> int:
    """Return a port that nobody listens at."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        return int(free.getsockname()[1])


@contextlib.contextmanager
def otree(people: int, rounds: int) -> Iterator[tuple[str, list[str]]]:
    """Run oTree with one session; gives its address and the participants' codes."""
    programs = install()
    with tempfile.TemporaryDirectory(prefix="otree-") as name:
        folder = Path(name)
        for inner in ("eyes", "_static", "_templates"):
            (folder / inner).mkdir()
        (folder / "settings.py").write_text(SETTINGS)
        (folder / "eyes" / "__init__.py").write_text(APP.format(rounds=rounds))
        (folder / "eyes" / "Page1.html").write_text(PAGE)
        environment = {
            **{key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "OTREE_PRODUCTION": "1",
            "OTREE_AUTH_LEVEL": "STUDY",
        }
        quiet = {"cwd": folder, "env": environment, "stdout": subprocess.DEVNULL}
        for command in (["resetdb", "--noinput"], ["create_session", "eyes", str(people)]):
            subprocess.run([programs / "otree", *command], check=True, **quiet)
        with contextlib.closing(sqlite3.connect(folder / "db.sqlite3")) as file:
            codes = [row[0] for row in file.execute("SELECT code FROM otree_participant")]
        port = free_port()
        server = subprocess.Popen(
            [programs / "otree", "prodserver1of2", str(port)],
            start_new_session=True,
            stderr=subprocess.DEVNULL,
            **quiet,
        )
        try:
            wait_for(port)
            yield f"http://127.0.0.1:{port}", codes
        finally:
            os.killpg(server.pid, signal.SIGKILL)
            server.wait()


def wait_for(port: int) -> None:
    """Wait until somebody listens."""
    for _ in range(600):
        with contextlib.suppress(OSError):
            socket.create_connection(("127.0.0.1", port), timeout=1).close()
            return
        time.sleep(0.1)
    raise SystemExit("oTree did not start")


async def crowd_at_otree(url: str, codes: list[str], people: int, seconds: float) -> Timings:
    """Let people fill in page after page for a while."""
    timings = Timings()
    questions = read_definition("thesis").questions
    left = iter(codes)

    async def place(number: int) -> None:
        rng = np.random.default_rng(number)
        for code in left:
            wire = Wire(url)
            path = f"/InitializeParticipant/{code}"
            while True:
                answered = await wire.get(path)
                while answered.status in (302, 303, 307):
                    path = re.sub(r"^https?://[^/]+", "", answered.headers["location"])
                    answered = await wire.get(path)
                if "<form" not in answered.text or "rating_left" not in answered.text:
                    break
                fields = _answers(questions, rng)
                started = time.perf_counter()
                posted = await wire.post_form(path, fields)
                timings.note("questionnaire", time.perf_counter() - started, posted.status)
                if posted.status not in (302, 303):
                    raise SystemExit(f"oTree answered {posted.status} to a form")
                path = re.sub(r"^https?://[^/]+", "", posted.headers["location"])
            wire.close()

    places = [asyncio.create_task(place(number)) for number in range(people)]
    await asyncio.sleep(5)  # everybody has come to the first page
    timings.began = time.perf_counter()
    timings.ended = timings.began + seconds
    done, _ = await asyncio.wait(places, timeout=seconds)
    for task in places:
        task.cancel()
    await asyncio.gather(*places, return_exceptions=True)
    for task in done:
        if not task.cancelled() and task.exception() is not None:
            raise task.exception() or SystemExit(1)
    if len(done) == people:
        raise SystemExit("oTree's session ran out of participants; shorten --seconds")
    return timings


def main() -> None:
    """Measure both and print how they compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--people", type=int, default=50)
    parser.add_argument("--seconds", type=int, default=15)
    options = parser.parse_args()
    print(machine())
    run = Run(SQLITE, 1, options.people, options.seconds, uses_outbox=False)
    rounds = 30
    with otree(4 * options.people, rounds) as (url, codes):
        theirs = asyncio.run(crowd_at_otree(url, codes, options.people, options.seconds))
    ours = asyncio.run(measure(run))
    rates = ours.questionnaires_per_s, theirs.rate("questionnaire")
    print(f"ocularist  {rates[0]:7.1f} forms/s on SQLite, and as many reports of plays")
    p95 = theirs.quantile_ms(0.95)
    print(f"oTree 6    {rates[1]:7.1f} forms/s on SQLite, p95 {p95:.0f} ms")
    print(f"ratio      {rates[0] / rates[1]:7.2f}")


if __name__ == "__main__":
    sys.exit(main())
