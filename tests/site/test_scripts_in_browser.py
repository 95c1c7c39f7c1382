"""The scripts behind the pages, one by one, in a real Chromium and with a network of straw."""

from __future__ import annotations

import functools
import hashlib
import threading
from collections.abc import Iterator
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from study.site.resources import resource_folder

# What a test's script may use: modules of the site, a fetch that the test answers itself.
PRELUDE = """
    const load = (name) => import(`${location.origin}/${name}.js`);
    const rest = (delay_ms) => new Promise((resolve) => setTimeout(resolve, delay_ms));
    const until = async (holds) => { while (!holds()) await rest(5); };
    const bytesOf = (text) => new TextEncoder().encode(text);
    const named = async (body) => {
        const { Sha256 } = await load("sha256");
        const sha256 = new Sha256().update(body).hex();
        return { url: `/clips/${sha256}.mp4`, bytes: body.length };
    };
"""


class Quiet(SimpleHTTPRequestHandler):
    """Serves the scripts, and a page of their names to run them in."""

    def log_message(self, *_: Any) -> None:
        """Say nothing."""


@pytest.fixture(scope="module")
def blank(chromium: Browser) -> Iterator[Page]:
    """A page beside the scripts, of no site."""
    handler = functools.partial(Quiet, directory=str(resource_folder("static")))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = chromium.new_page()
        page.goto(f"http://127.0.0.1:{server.server_port}/")
        yield page
        page.close()
        server.shutdown()


@pytest.fixture
def run(blank: Page) -> Any:
    """Return what runs a script in an empty page, with PRELUDE before it."""
    blank.evaluate("localStorage.clear()")
    blank.reload()

    def run_script(script: str, given: Any = None) -> Any:
        return blank.evaluate(f"async (given) => {{ {PRELUDE} {script} }}", given)

    return run_script


def test_sha256_agrees_with_the_browsers_and_with_pythons(run: Any) -> None:
    # Every length around the ends of one and two blocks, in pieces of odd sizes.
    lengths = [*range(130), 1000, 4096, 100_003]
    script = """
        const { Sha256 } = await load("sha256");
        const told = [];
        for (const length of given) {
            const bytes = Uint8Array.from({ length }, (_, place) => (place * 7 + length) % 256);
            const hash = new Sha256();
            for (let at = 0; at < length; at += 37) hash.update(bytes.subarray(at, at + 37));
            const theirs = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
            const digits = Array.from(theirs, (byte) => byte.toString(16).padStart(2, "0"));
            told.push([hash.hex(), digits.join("")]);
        }
        return told;
    """
    ours_and_theirs = run(script, lengths)
    for length, (ours, theirs) in zip(lengths, ours_and_theirs, strict=True):
        data = bytes((place * 7 + length) % 256 for place in range(length))
        assert ours == theirs == hashlib.sha256(data).hexdigest()


def test_three_downloads_at_most_run_at_once_and_the_wanted_one_goes_first(run: Any) -> None:
    script = """
        const { ClipStore } = await load("preload");
        let running = 0, most = 0;
        const order = [], gates = [], realFetch = window.fetch;
        window.fetch = async (url) => {
            most = Math.max(most, ++running);
            order.push(url);
            await new Promise((resolve) => gates.push(resolve));
            running -= 1;
            return new Response(bodies.get(url));
        };
        const bodies = new Map(), clips = [];
        for (let n = 0; n < 6; n += 1) {
            const body = bytesOf(`clip ${n}`);
            clips.push(await named(body));
            bodies.set(clips[n].url, body);
        }
        const store = new ClipStore();
        const loads = clips.slice(0, 5).map((clip) => store.load(clip));
        loads.push(store.loadFirst(clips[4]), store.load(clips[5]));
        for (let n = 0; n < 6; n += 1) { await until(() => gates.length > n); gates[n](); }
        const held = await Promise.all(loads);
        const real = await realFetch(held[0].address);
        const { type } = await real.blob();
        return { most, order: order.map((url) => clips.findIndex((clip) => clip.url === url)), type,
                 hash: held[2].sha256 === clips[2].url.slice(7, -4), bytes: store.bytesOf(clips) };
    """
    found = run(script)
    assert found["most"] == 3
    assert found["order"] == [0, 1, 2, 4, 3, 5]
    assert found["hash"] is True
    assert found["bytes"] == 6 * len("clip 0")
    assert found["type"] == "video/mp4"


@pytest.mark.parametrize(
    ("answer", "fault", "tries"),
    [
        ("new Promise(() => {})", "STALL", 3),
        ("new Response(new ReadableStream({ start(c) { c.enqueue(bytesOf('cl')) } }))", "STALL", 3),
        ("new Response('clip')", "LENGTH-4", 3),
        ("new Response('clip one and more')", "LENGTH-17", 3),
        ("new Response('CLIP ONE')", "HASH", 3),
        ("new Response('', { status: 503 })", "HTTP-503", 3),
        ("new Response('', { status: 404 })", "HTTP-404", 1),
        ("Promise.reject(new TypeError('no connection'))", "no connection", 3),
    ],
)
def test_a_clip_that_does_not_come_right_is_tried_again_and_then_told(
    run: Any, answer: str, fault: str, tries: int
) -> None:
    script = f"""
        const {{ ClipStore }} = await load("preload");
        const caches = [];
        window.fetch = (url, {{ signal, cache }}) => {{
            caches.push(cache);
            const stopped = new Promise((_, reject) =>
                signal.addEventListener("abort", () => reject(new DOMException("", "AbortError"))));
            return Promise.race([stopped, {answer}]).then((told) => cutBy(told, signal));
        }};
        // A stream of straw has to be told that its request was cut.
        const cutBy = (told, signal) => {{
            const {{ body }} = told;
            const getReader = body?.getReader.bind(body);
            if (body) body.getReader = () => {{
                const reader = getReader();
                signal.addEventListener("abort", () => reader.cancel());
                const read = reader.read.bind(reader);
                reader.read = async () => {{
                    const found = await read();
                    if (signal.aborted) throw new DOMException("", "AbortError");
                    return found;
                }};
                return reader;
            }};
            return told;
        }};
        const store = new ClipStore({{ stall_ms: 60, pauses_ms: [1, 1] }});
        const clip = await named(bytesOf("clip one"));
        const fault = await store.load(clip).then(() => "", (error) => error.message);
        const more = await store.load(clip).then(() => "", (error) => error.message);
        return {{ fault, more, caches }};
    """
    found = run(script)
    assert (found["fault"], found["more"]) == (fault, fault)
    # The second time around the cache is not asked; and a retry button starts anew.
    assert found["caches"] == (["default", *["reload"] * (tries - 1)] * 2)


def test_a_clip_that_comes_right_the_second_time_is_held(run: Any) -> None:
    script = """
        const { ClipStore } = await load("preload");
        let tries = 0;
        window.fetch = async () => new Response(tries++ ? "clip one" : "clip");
        const seen = [];
        const store = new ClipStore({ pauses_ms: [1] });
        const clip = await named(bytesOf("clip one"));
        store.onProgress = () => seen.push(store.bytesOf([clip]));
        const held = await store.load(clip);
        return { seen, codec: held.codec, address: held.address.slice(0, 5) };
    """
    assert run(script) == {"seen": [4, 0, 8], "codec": "", "address": "blob:"}


def test_only_the_wanted_clips_stay_in_memory(run: Any) -> None:
    script = """
        const { ClipStore } = await load("preload");
        const live = new Set(), make = URL.createObjectURL, revoke = URL.revokeObjectURL;
        URL.createObjectURL = (blob) => { const url = make(blob); live.add(url); return url; };
        URL.revokeObjectURL = (url) => { live.delete(url); revoke(url); };
        const bodies = new Map(), aborted = [];
        window.fetch = async (url, { signal }) => {
            signal.addEventListener("abort", () => aborted.push(url));
            if (url === slow.url) await new Promise(() => {});
            return new Response(bodies.get(url));
        };
        const clips = [];
        for (const word of ["one", "two", "three"]) {
            clips.push(await named(bytesOf(word)));
            bodies.set(clips.at(-1).url, bytesOf(word));
        }
        const slow = await named(bytesOf("slow"));
        const store = new ClipStore();
        const held = await Promise.all(clips.map((clip) => store.load(clip)));
        store.load(slow).catch(() => {});
        await rest(5);
        store.keepOnly(clips.slice(1, 2));
        await rest(5);
        return { live: [...live].map((url) => held.findIndex((one) => one.address === url)),
                 aborted: aborted.includes(slow.url), bytes: store.bytesOf(clips) };
    """
    assert run(script) == {"live": [1], "aborted": True, "bytes": 3}


def test_nothing_is_read_while_a_clip_is_on_the_screen(run: Any) -> None:
    script = """
        const { ClipStore } = await load("preload");
        window.fetch = async () => new Response("clip one");
        const store = new ClipStore({ stall_ms: 20, pauses_ms: [] });
        const speakUp = store.hush();
        const clip = await named(bytesOf("clip one"));
        const held = store.load(clip);
        await rest(80); // four times the stall: waiting for the clip is no stall
        const before = store.bytesOf([clip]);
        speakUp();
        await held;
        return [before, store.bytesOf([clip])];
    """
    assert run(script) == [0, 8]


OUTBOX = """
    const { Outbox } = await load("outbox");
    const sent = [], told = [], states = [];
    let answers = given.answers ?? [];
    window.fetch = async (url, { body, headers }) => {
        const entry = JSON.parse(body);
        sent.push([entry.question, entry.value]);
        const [status, text, more] = answers.shift() ?? [200];
        const said = text ?? JSON.stringify({ ok: true, key: entry.key });
        if (status === 0) throw new TypeError("no connection");
        return new Response(said, { status, headers: more });
    };
    const options = { url: "/events", csrf: "c", onChange: (state) => states.push(state),
                      onRefused: (entry, status) => told.push([entry.value, status]) };
    const make = () => {
        const outbox = new Outbox("P-1", options);
        outbox.pause = () => rest(1);
        return outbox;
    };
    const outbox = make();
    const answer = (question, value) => outbox.add({ kind: "answer", question, value }, question);
"""


def test_answers_are_sent_in_order_and_only_a_stored_one_is_forgotten(run: Any) -> None:
    script = """
        answer("a", "1"); answer("b", "2"); answer("a", "3");
        await outbox.settled();
        return { sent, left: outbox.entries().length, last: states.at(-1) };
    """
    later = [
        [0],
        [429, '{"code": "SLOW-DOWN"}'],
        [500, '{"code": "SITE-1"}'],
        [503, "<html>"],
        [401, '{"code": "NOT-SIGNED-IN"}'],
        [404, "a proxy's page"],
        [200, "<html>Please sign in to this network</html>"],
        [200, '{"ok": true, "key": "another"}'],
    ]
    found = run(OUTBOX + script, {"answers": later})
    # The first was on its way when it was given anew: it is sent as often as it takes.
    assert found["sent"] == [["a", "1"]] * 9 + [["b", "2"], ["a", "3"]]
    assert found["left"] == 0
    assert found["last"] == {"waiting": 0, "failed": False, "unkept": False}


def test_what_the_site_never_takes_is_told_and_holds_up_nothing(run: Any) -> None:
    script = """
        answer("a", "1"); answer("b", "2");
        await outbox.settled();
        return { sent, told };
    """
    found = run(OUTBOX + script, {"answers": [[422, '{"code": "NOT-READABLE"}']]})
    assert found == {"sent": [["a", "1"], ["b", "2"]], "told": [["1", 422]]}


def test_a_pause_that_the_site_asks_for_is_kept(run: Any) -> None:
    script = """
        const pauses = [];
        outbox.pause = async (delay_ms) => pauses.push(delay_ms);
        answer("a", "1");
        await outbox.settled();
        return pauses;
    """
    slow = [
        [429, '{"code": "SLOW-DOWN"}', {"Retry-After": "7"}],
        [429, "{}", {"Retry-After": "9e9"}],
    ]
    assert run(OUTBOX + script, {"answers": slow}) == [7000, 60000]


def test_entries_survive_the_page_and_another_clock(run: Any) -> None:
    script = """
        options.mayWrite = () => false; // as if another tab sent
        const clock = Date.now;
        answer("a", "1");
        Date.now = () => clock() - 3600_000; // set back by an hour
        answer("b", "2"); answer("c", "3");
        const again = new Outbox("P-1", { ...options, mayWrite: () => true });
        Date.now = () => clock() - 7200_000;
        again.add({ kind: "answer", question: "d", value: "4" }, "d");
        await again.settled();
        return sent;
    """
    assert run(OUTBOX + script, {}) == [["a", "1"], ["b", "2"], ["c", "3"], ["d", "4"]]


def test_a_full_browser_keeps_answers_in_the_page_and_says_so(run: Any) -> None:
    script = """
        options.mayWrite = () => isFree;
        let isFree = false;
        answer("a", "1");
        Storage.prototype.setItem = () => { throw new DOMException("", "QuotaExceededError"); };
        answer("b", "2"); answer("b", "3");
        const full = states.at(-1), atRisk = outbox.isAtRisk;
        isFree = true;
        await outbox.settled();
        return { full, atRisk, sent, last: states.at(-1) };
    """
    found = run(OUTBOX + script, {})
    assert found["full"] == {"waiting": 2, "failed": False, "unkept": True}
    assert found["atRisk"] is True
    assert found["sent"] == [["a", "1"], ["b", "3"]]
    assert found["last"] == {"waiting": 0, "failed": False, "unkept": False}


def test_plays_without_a_connection_are_bounded_and_answers_are_not(run: Any) -> None:
    script = """
        options.mayWrite = () => false;
        for (let n = 0; n < 310; n += 1) outbox.add({ kind: "play", position: 1, play: {} });
        answer("a", "1");
        return [outbox.entries().length, outbox.entries().at(-1).value];
    """
    assert run(OUTBOX + script, {}) == [301, "1"]


def test_intervals_are_summed_and_listed(run: Any) -> None:
    script = """
        const { Intervals } = await load("intervals");
        const hidden = new Intervals(true);
        hidden.set(true, 5); hidden.set(false, 10); hidden.set(false, 12); hidden.set(true, 30.2);
        return [hidden.facts("hidden", 40.9), new Intervals(false).facts("x", 9)];
    """
    assert run(script) == [
        {"hidden_ms": 21, "hidden_intervals": [[0, 10], [30, 41]]},
        {"x_ms": 0, "x_intervals": []},
    ]


def test_a_form_waits_for_the_site_itself_and_shows_what_follows(run: Any) -> None:
    script = """
        const { submitPatiently } = await load("navigate");
        const page = (heading) => `<body data-csrf="2"><header></header><main><h1 tabindex="-1">` +
            `${heading}</h1></main><script type="application/json" id="texts">{}</` + `script>`;
        document.body.innerHTML = page("First") + '<form action="/form"><input name="a" value="1">';
        const pause = window.setTimeout;
        window.setTimeout = (act, delay_ms) => pause(act, delay_ms > 20000 ? delay_ms : 1);
        const answers = [
            () => Promise.reject(new TypeError("no connection")),
            () => new Response("starting", { status: 503 }),
            () => new Response(page("Slow down"), { status: 429, headers: { "Retry-After": "1" } }),
            () => new Response("<html><form>Sign in to this network</form>"),
            () => new Response(new ReadableStream({ pull() { throw new TypeError("cut"); } })),
            () => new Response(page("Second")),
        ];
        const sent = [], waited = [];
        window.fetch = async (url, { body }) => {
            sent.push(String(body));
            return answers.shift()();
        };
        history.replaceState = () => {};
        let left = 0, started = 0;
        await submitPatiently(document.querySelector("form"), () => (started += 1), {
            extra: [["b", "2"]],
            onWaiting: () => waited.push(document.querySelector("h1").textContent),
            onLeave: () => (left += 1),
        });
        return { sent, waited, left, started, heading: document.activeElement.textContent,
                 csrf: document.body.dataset.csrf };
    """
    assert run(script) == {
        "sent": ["a=1&b=2"] * 6,
        "waited": ["First"] * 5,
        "left": 1,
        "started": 1,
        "heading": "Second",
        "csrf": "2",
    }
