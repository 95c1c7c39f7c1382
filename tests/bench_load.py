"""The same form posts at the same durability: this site beside oTree 6, burst by burst in turn.

Not a test: ``python tests/bench_load.py`` makes oTree an environment of its own (out/otree), gives
it a page with the thesis's questions, and lets the same client post it: one form, then the page
that it leads to. SQLite waits for the disk in both before a form is answered (oTree's production
server writes its file with SQLite's defaults: journal DELETE, synchronous FULL). Visits are equally
long in both. Ours is measured twice: with forms alone, which is what oTree does, and with the
report of a play before each form.
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
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from importlib import resources
from pathlib import Path
from statistics import median

import numpy as np

from study.design.definition import read_definition
from study.load.crowd import Timings
from study.load.person import _answers
from study.load.processor import processor_s
from study.load.report import machine
from study.load.runs import SQLITE, Run, Running, running
from study.load.site import PROGRAM
from study.load.wire import Wire

OTREE = "otree>=6,<7"
FORM = "questionnaire"
TIMES = 4  # the thesis's clips, so many times over
ROUNDS = 7 * TIMES + 1  # its seven clips, and one for practice
ROOM = Path(__file__).parent.parent / "out" / "otree"
# The site takes no questionnaire before its clip was watched, and has no switch for it.
ALL_WATCHED = (
    "-c",
    "import sys; from study.cli import main; from study.data import trials; "
    "trials.complete_plays = lambda *_: [{}]; sys.exit(main(sys.argv[1:]))",
)
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
def otree(people: int, rounds: int) -> Iterator[tuple[str, list[str], int]]:
    """Run oTree with one session; gives its address, the participants' codes and its number."""
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
            yield f"http://127.0.0.1:{port}", codes, server.pid
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


async def crowd_at_otree(
    url: str, codes: Iterator[str], people: int, seconds: float, *, servers: tuple[int, ...]
) -> Timings:
    """Let people fill in page after page for a while."""
    timings = Timings()
    questions = read_definition("thesis").questions

    async def place(number: int) -> None:
        rng = np.random.default_rng(number)
        for code in codes:
            wire = Wire(url)
            path = f"/InitializeParticipant/{code}"
            while True:
                started = time.perf_counter()
                answered = await wire.get(path)
                while answered.status in (302, 303, 307):
                    path = re.sub(r"^https?://[^/]+", "", answered.headers["location"])
                    answered = await wire.get(path)
                timings.note("page", time.perf_counter() - started, answered.status)
                if "<form" not in answered.text or "rating_left" not in answered.text:
                    break
                fields = _answers(questions, rng)
                started = time.perf_counter()
                posted = await wire.post_form(path, fields)
                timings.note(FORM, time.perf_counter() - started, posted.status)
                if posted.status not in (302, 303):
                    raise SystemExit(f"oTree answered {posted.status} to a form")
                path = re.sub(r"^https?://[^/]+", "", posted.headers["location"])
            wire.close()

    places = [asyncio.create_task(place(number)) for number in range(people)]
    await asyncio.sleep(5)  # everybody has come to the first page
    timings.began = time.perf_counter()
    timings.ended = timings.began + seconds
    before = processor_s(*servers)
    done, _ = await asyncio.wait(places, timeout=seconds)
    timings.site_s = processor_s(*servers) - before
    for task in places:
        task.cancel()
    await asyncio.gather(*places, return_exceptions=True)
    for task in done:
        if not task.cancelled() and task.exception() is not None:
            raise task.exception() or SystemExit(1)
    if len(done) == people:
        raise SystemExit("oTree's session ran out of participants; shorten --seconds")
    return timings


def long_study(folder: Path) -> str:
    """Write the thesis's study with as many trials as oTree has rounds; returns its file's name."""
    text = (resources.files("study.design") / "definitions" / "thesis.toml").read_text()
    head, *clips = re.split(r"(?m)^(?=\[\[clips\]\])", text)
    clips[-1], rest = re.split(r"(?m)^(?=\[consent\])", clips[-1], maxsplit=1)
    more = [
        re.sub(r'(?m)^id = "(.*)"', rf'id = "\1-{n}"', clip) for n in range(TIMES) for clip in clips
    ]
    head = re.sub(r"(?m)^translations = .*$", "", head)
    path = folder / "long.toml"
    path.write_text(head + "".join(more) + rest)
    return str(path)


@dataclass
class Rival:
    """One of those who are compared: what it is called, how it is loaded, and what came of it."""

    name: str
    burst: Callable[[], Awaitable[Timings]]
    found: list[Timings] = field(default_factory=list)

    def row(self) -> str:
        """Say medians over the bursts."""
        forms = self.median(lambda one: one.rate(FORM))
        p95 = self.median(lambda one: one.quantile_ms(0.95, FORM))
        cost = self.median(lambda one: one.processor_ms(one.site_s, FORM))
        wrong = sum(sum(one.errors.values()) for one in self.found)
        plays = self.median(lambda one: one.rate("play"))
        return f"{self.name:24}{forms:9.1f}{plays:9.1f}{p95:10.0f}{cost:12.1f}{wrong:9}"

    def median(self, of: Callable[[Timings], float]) -> float:
        """Return the median of a figure over the bursts."""
        return median(of(one) for one in self.found)


async def compare(people: int, seconds: int, turns: int) -> list[Rival]:
    """Load all of them in turn, several times, while all of them run."""
    codes_wanted = (turns + 2) * people
    async with contextlib.AsyncExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="bench-")))
        rivals = []
        study = long_study(folder)
        for name, program in (("ocularist", ALL_WATCHED), ("ocularist, with plays", PROGRAM)):
            run = Run(SQLITE, 1, people, seconds, uses_outbox=False, study=study, program=program)
            place = await stack.enter_async_context(running(run))
            rivals.append(Rival(name, partial(_burst, place, run)))
        url, codes, server = stack.enter_context(otree(codes_wanted, ROUNDS))
        left = iter(codes)
        rivals.append(
            Rival(
                "oTree 6",
                lambda: crowd_at_otree(url, left, people, seconds, servers=(server,)),
            )
        )
        for turn in range(turns):
            for rival in rivals:
                rival.found.append(await rival.burst())
                print(f"turn {turn + 1}: {rival.row()}", file=sys.stderr, flush=True)
    return rivals


async def _burst(place: Running, run: Run) -> Timings:
    return await place.crowd(run).run()


def main() -> None:
    """Measure all and print how they compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--people", type=int, default=50)
    parser.add_argument("--seconds", type=int, default=10, help="per burst")
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    print(machine())
    rivals = asyncio.run(compare(options.people, options.seconds, options.turns))
    head = {"forms/s": 9, "plays/s": 9, "p95 ms": 10, "ms/form": 12, "errors": 9}
    print(f"{'medians':24}" + "".join(f"{name:>{width}}" for name, width in head.items()))
    for rival in rivals:
        print(rival.row())
    theirs = rivals[-1]
    for ours in rivals[:-1]:
        rates = [
            one.rate(FORM) / other.rate(FORM)
            for one, other in zip(ours.found, theirs.found, strict=True)
        ]
        cheaper = theirs.median(lambda one: one.processor_ms(one.site_s, FORM)) / ours.median(
            lambda one: one.processor_ms(one.site_s, FORM)
        )
        print(
            f"{ours.name}: {median(rates):.2f} times oTree's rate ({min(rates):.2f} to "
            f"{max(rates):.2f}), at 1/{cheaper:.1f} of its processor time per form"
        )


if __name__ == "__main__":
    main()
