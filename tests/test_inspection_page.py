"""The page that looks into the scene: what it asks for, and in Chromium what keys and mouse do."""

from __future__ import annotations

import argparse
import json
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from html import unescape
from socket import socket
from typing import Any

import httpx
import numpy as np
import pytest
import uvicorn
from playwright.sync_api import Page, expect, sync_playwright

from renderer.clip import ClipSpec
from renderer.detail import EFFECTS, Detail
from renderer.lod.policy import default_policy
from study.cli import main
from study.commands import inspect
from study.commands.errors import CommandError
from study.commands.eye_options import spec_of
from study.inspection.app import create_inspection
from study.inspection.look import Look, code_of, detail_of

LOW, ULTRA = Detail.uniform("low"), Detail.uniform("ultra")
POLICY = default_policy()
FIRST = Look(left="l" * 7, right="u" * 7)
BASE = ClipSpec(left=LOW, right=ULTRA, distance="near", width=320, height=180, iris_colour="brown")
WAIT_MS = 30_000


@dataclass
class Drawn:
    pixels: Any
    facts: dict[str, object]


@dataclass
class Board:
    """Stands in for GL: grey pictures, and a note of what was asked for and by which thread."""

    asked: list[tuple[str, ClipSpec, Look]] = field(default_factory=list)
    threads: set[int] = field(default_factory=set)
    closed: int = 0
    may_draw: threading.Event = field(default_factory=threading.Event)
    gl_renderer: str = "a board"

    def shot(self, spec: ClipSpec, look: Look) -> Drawn:
        return self._draw("shot", spec, look)

    def overhead(self, spec: ClipSpec, look: Look) -> Drawn:
        return self._draw("overhead", spec, look)

    def close(self) -> None:
        self.closed += 1
        self.threads.add(threading.get_ident())

    def _draw(self, what: str, spec: ClipSpec, look: Look) -> Drawn:
        self.asked.append((what, spec, look))
        self.threads.add(threading.get_ident())
        if look.time == 7.0:
            self.may_draw.wait(30)
        if look.time == 13.0:
            raise RuntimeError("no more paper")
        facts: dict[str, object] = {
            "ms": 12.5,
            "triangles": 123456,
            "iris_px": [100.0, 101.0],
            "visible_px": [1000, 1001],
            "lods": ["low", "ultra"],
            "marks": {
                "camera": [0.5 + look.azimuth / 360.0, 0.5],
                "eyes": [0.5, 0.4],
                "reach_mm": 1300.0 if look.distance > 100.0 else 2600.0,
            },
        }
        return Drawn(np.full((spec.height, spec.width, 3), 90, np.uint8), facts)


@pytest.fixture
def board() -> Board:
    return Board()


@contextmanager
def served(
    board: Board,
    *,
    log_level: str = "critical",
    until: threading.Event | None = None,
    first: Look = FIRST,
) -> Iterator[str]:
    """The page on a free port; its address. Afterwards it has ended.

    Nothing that the board still draws is done before ``until`` is set.
    """
    app = create_inspection(BASE, lambda: board, policy=POLICY, first=first, hosts=("127.0.0.1",))
    with socket() as listening:
        listening.bind(("127.0.0.1", 0))
        config = uvicorn.Config(
            app, log_level=log_level, access_log=False, timeout_graceful_shutdown=1
        )
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]}, daemon=True)
        thread.start()
        try:
            yield f"http://127.0.0.1:{listening.getsockname()[1]}"
        finally:
            server.should_exit = True
            if until is not None:
                until.wait(30)
            board.may_draw.set()
            thread.join(10)


@pytest.fixture
def client(board: Board) -> Iterator[httpx.Client]:
    with served(board) as address, httpx.Client(base_url=address, timeout=30) as one:
        yield one


def test_a_look_becomes_a_clip_of_the_command_with_these_levels() -> None:
    look = Look(left="olmhulu", right="u" * 7, eyes="halves", divide=2)
    spec = look.spec(BASE, POLICY)
    assert list(spec.left.levels().values()) == [
        *("off", "low", "medium", "high", "ultra", "low", "ultra")
    ]
    assert (spec.right, spec.distance, spec.iris_colour) == (ULTRA, "macroscopic", "brown")
    assert (spec.width, spec.height) == (160, 90)
    assert detail_of(code_of(LOW.with_levels(sclera="off"))) == LOW.with_levels(sclera="off")


def test_an_eye_that_switches_takes_its_lod_from_the_policy() -> None:
    spec = Look(left="l" * 7, right="m" * 7, right_switching="blended").spec(BASE, POLICY)
    assert (spec.left, spec.right, spec.lod_policy) == (LOW, POLICY.finest, POLICY)
    assert (spec.left_switching, spec.right_switching) == ("fixed", "blended")
    assert Look(left="l" * 7).spec(BASE, POLICY).lod_policy is None


def test_pictures_come_with_their_facts_from_one_thread(client: httpx.Client, board: Board) -> None:
    answers = [client.get("/frame?azimuth=30&left=ooooooo"), client.get("/overhead")]
    assert [answer.headers["content-type"] for answer in answers] == ["image/jpeg"] * 2
    assert json.loads(answers[0].headers["x-inspect"])["triangles"] == 123456
    assert [what for what, _, _ in board.asked] == ["shot", "overhead"]
    assert board.asked[0][2].azimuth == 30.0
    assert len(board.threads) == 1
    assert threading.get_ident() not in board.threads


def test_the_renderer_is_closed_in_its_own_thread(board: Board) -> None:
    with served(board) as address:
        httpx.get(f"{address}/frame", timeout=30)
    assert board.closed == 1
    assert len(board.threads) == 1


def test_a_picture_that_is_not_drawn_in_time_is_given_up_without_a_trace(
    board: Board, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = threading.Event()

    def ask(address: str) -> None:
        with suppress(httpx.HTTPError):
            answers.append(httpx.get(f"{address}/frame?time=7", timeout=30).status_code)
        asked.set()

    answers: list[int] = []
    with served(board, log_level="error", until=asked) as address:
        threading.Thread(target=ask, args=(address,), daemon=True).start()
        while not board.asked:
            time.sleep(0.01)
    assert asked.is_set()
    assert answers in ([], [503])
    assert "Traceback" not in capsys.readouterr().err
    assert board.closed == 1


@pytest.mark.parametrize(
    ("query", "told"),
    [
        ("left=uuux", "left"),
        ("elevation=95", "less than or equal to 80"),
        ("eyes=third", "'both', 'halves', 'left' or 'right'"),
        ("zoom=2", "Extra inputs are not permitted"),
    ],
)
def test_a_wrong_look_is_told(client: httpx.Client, board: Board, query: str, told: str) -> None:
    answer = client.get(f"/frame?{query}")
    assert answer.status_code == 422
    assert told in answer.text
    assert board.asked == []


def test_what_went_wrong_is_told_and_the_next_picture_comes(client: httpx.Client) -> None:
    answer = client.get("/frame?time=13")
    assert (answer.status_code, answer.text) == (500, "RuntimeError: no more paper")
    assert client.get("/frame").status_code == 200


def test_other_sites_names_do_not_reach_in(client: httpx.Client) -> None:
    assert client.get("/", headers={"host": "elsewhere.example"}).status_code == 400


@pytest.fixture
def page(board: Board) -> Iterator[Page]:
    errors: list[str] = []
    with served(board) as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path="/usr/bin/chromium", args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        one = browser.new_page(viewport={"width": 1200, "height": 800})
        one.set_default_timeout(WAIT_MS)
        one.on("pageerror", lambda error: errors.append(str(error)))
        one.goto(f"{address}/")
        yield one
        browser.close()
    assert errors == []


def settled(board: Board, *, more_than: int) -> Look:
    """Wait until a fine picture was asked for after so many; return what it asked."""
    for _ in range(600):
        asked = [look for what, _, look in list(board.asked)[more_than:] if what == "shot"]
        if asked and asked[-1].divide == 1:
            return asked[-1]
        time.sleep(0.05)
    raise AssertionError("the page never asked for a fine picture")


def test_mouse_and_keys_move_the_camera_and_change_levels(page: Page, board: Board) -> None:
    expect(page.locator("#picture[data-width='320']")).to_be_visible(timeout=WAIT_MS)
    expect(page.locator("#above[data-drawn]")).to_be_visible(timeout=WAIT_MS)
    first = settled(board, more_than=0)
    assert (first.left, first.right, first.distance) == ("l" * 7, "u" * 7, 160.0)
    expect(page.locator("#triangles")).to_have_text("123,456")
    expect(page.locator("#rate")).to_have_text("80")

    box = page.locator("#picture").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    before = len(board.asked)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - 80, y + 40, steps=4)
    page.mouse.up()
    turned = settled(board, more_than=before)
    assert (turned.azimuth, turned.elevation) == (20.0, 10.0)
    assert any(look.divide == 2 for _, _, look in board.asked[before:])

    before = len(board.asked)
    page.mouse.wheel(0, -500)
    assert settled(board, more_than=before).distance > 200.0

    before = len(board.asked)
    page.keyboard.press("e")  # the left eye
    page.keyboard.press("5")
    page.keyboard.press("w")
    page.keyboard.press("v")
    changed = settled(board, more_than=before)
    assert changed.left == "llll" + "m" + "ll"
    assert changed.right == "u" * 7
    assert changed.wireframe
    assert changed.eyes == "halves"
    select = page.get_by_label(f"{EFFECTS[4]}, left eye")
    expect(select).to_have_value("m")

    before = len(board.asked)
    select.select_option("off")
    page.locator("#picture").focus()
    page.keyboard.press("r")
    assert settled(board, more_than=before) == first


def test_d_goes_through_the_four_distances_from_near_to_far_and_round(
    page: Page, board: Board
) -> None:
    settled(board, more_than=0)

    def after(key: str) -> tuple[float, str]:
        before = len(board.asked)
        page.keyboard.press(key)
        seen = settled(board, more_than=before)
        return seen.distance, seen.eyes

    assert [after("d")[0] for _ in range(4)] == [40.0, 12.0, 350.0, 160.0]
    # From afar the other eye would be in an eye's half, too.
    after("d")
    assert after("v") == (350.0, "halves")
    assert after("d") == (160.0, "halves")
    assert after("d") == (40.0, "both")


def test_keys_work_after_a_click_on_a_button_or_a_choice_in_a_list(
    page: Page, board: Board
) -> None:
    settled(board, more_than=0)
    page.get_by_role("button", name="Wire frame").click()
    before = len(board.asked)
    page.keyboard.press("2")
    changed = settled(board, more_than=before)
    assert (changed.wireframe, changed.right) == (True, "uouuuuu")
    select = page.get_by_label(f"{EFFECTS[2]}, right eye")
    select.select_option("high")
    select.focus()
    before = len(board.asked)
    page.keyboard.press("w")
    page.keyboard.press("o")  # the list's own: it finds "off" by its letter
    changed = settled(board, more_than=before)
    assert (changed.wireframe, changed.left, changed.right) == (False, "lmlllll", "uoouuuu")
    before = len(board.asked)
    page.keyboard.press("b")
    assert settled(board, more_than=before).left_switching == "blended"
    before = len(board.asked)
    page.get_by_role("button", name="all medium M").click()
    changed = settled(board, more_than=before)
    assert (changed.left, changed.left_switching) == ("m" * 7, "fixed")


def test_the_camera_on_the_scene_from_above_follows_every_move(page: Page) -> None:
    above = page.locator("#above")
    expect(above).to_have_attribute("data-camera", "0.500 0.500")
    expect(above).to_have_attribute("data-drawn", "1")
    page.keyboard.press("ArrowRight")
    expect(above).to_have_attribute("data-camera", "0.514 0.500")
    expect(above).to_have_attribute("data-drawn", "1")  # the same picture with another mark
    page.keyboard.press("d")  # beyond what it shows
    expect(above).to_have_attribute("data-drawn", "2")


def test_the_page_starts_where_the_command_says(board: Board) -> None:
    first = Look(left="h" * 7, azimuth=20.0, elevation=-5.0, time=1.5, eyes="halves")
    with served(board, first=first) as address:
        told = json.loads(
            unescape(httpx.get(address, timeout=30).text.split('data-start="')[1].split('">')[0])
        )
    assert Look(**told["first"]) == first


def options_of(*arguments: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    inspect.add_arguments(parser)
    return parser.parse_args(arguments)


def test_the_command_says_where_the_page_starts() -> None:
    options = options_of("--azimuth", "200", "--elevation", "10", "--left", "low")
    first = inspect.first_look(options, spec_of(options))
    assert (first.azimuth, first.elevation, first.left, first.right) == (
        *(-160.0, 10.0),
        *("l" * 7, "u" * 7),
    )
    assert (first.eyes, first.distance, first.time) == ("halves", 350.0, 0.0)
    options = options_of("--frame", "150", "--distance", "medium")
    first = inspect.first_look(options, spec_of(options))
    assert (first.azimuth, first.eyes, first.distance) == (60.0, "both", 40.0)
    assert first.time == pytest.approx(149 / 30)
    options = options_of("--elevation", "85")
    with pytest.raises(CommandError, match=r"--elevation 85: .* up and down to 80 degrees"):
        inspect.first_look(options, spec_of(options))


def test_a_machine_without_gl_is_told_before_a_page_is_served(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(**_settings: object) -> None:
        raise ValueError("found 0 devices")

    monkeypatch.setattr("moderngl.create_context", refuse)
    monkeypatch.setattr("uvicorn.run", lambda *_, **__: pytest.fail("a page was served"))
    monkeypatch.setattr("study.commands.listening.check_port", lambda _settings: None)
    assert main(["inspect"]) == 1
    told = capsys.readouterr().err.strip()
    assert told.startswith("ocularist inspect: no OpenGL 4.3 context through EGL (found 0 devices)")
    assert "\n" not in told


def test_a_picture_that_fails_is_told_on_the_page(page: Page, board: Board) -> None:
    settled(board, more_than=0)
    address = page.url
    assert httpx.get(f"{address}frame?time=13").status_code == 500
    page.route("**/frame*", lambda route: route.fulfill(status=500, body="RuntimeError: gone"))
    page.locator("#picture").focus()
    page.keyboard.press("ArrowLeft")
    expect(page.locator("#waiting")).to_have_text("No picture: 500: RuntimeError: gone")
    page.route("**/overhead*", lambda route: route.abort())
    page.keyboard.press("a")
    expect(page.locator("#above-fault")).to_have_text(
        "No picture: the command does not answer; start ocularist inspect again"
    )
