// The page of one trial: a clip, then its questions.

import { submitPatiently } from "./navigate.js";
import { Player } from "./player.js";
import { Questionnaire } from "./questionnaire.js";
import { text } from "./texts.js";

/** Start the page; returns the function that ends it. */
export function startTrial(main, { outbox, clips, start }) {
  const stage = main.querySelector(".stage");
  const form = main.querySelector(".questions form");
  const { clip: url } = main.dataset;
  const number = (name) => Number(main.dataset[name]);
  const position = number("position");
  const clip = { url, bytes: number("bytes") };
  const record = (kind, values, about) => outbox.add({ kind, position, ...values }, about);
  const clock = firstFrameClock(`${document.body.dataset.session}.${position}`);
  let viewsLeft = number("views_left");

  const player = new Player(stage, {
    width: number("width"),
    height: number("height"),
    frames: number("frames"),
    onFirstFrame: clock.start,
    onPlay: played,
    onBroken: broken,
    onTooSmall: tooSmall,
  });
  player.isWatched = viewsLeft === 0;
  const questions = new Questionnaire(form, {
    save: (question, value) => record("answer", { question, value }, `${position}/${question}`),
  });
  if (player.isWatched) questions.unlock();
  stage.querySelector("[data-reload]").addEventListener("click", load);
  stage.querySelector("[data-to-questions]").addEventListener("click", toQuestions);
  form.querySelector("[data-again]")?.addEventListener("click", () => player.play());
  form.addEventListener("submit", submit);
  if (main.dataset.open === "questions") toQuestions();
  load();

  async function load() {
    player.state = "loading";
    const meter = stage.querySelector("[data-when='loading'] progress");
    clips.onProgress = () => (meter.value = clips.bytesOf([clip]) / clip.bytes);
    try {
      await openEitherWay(await clips.loadFirst(clip));
      loadTheRest();
    } catch (error) {
      broken(error?.message?.split(" ")[0] || "DECODE");
    }
  }

  /** Some browsers play a file of the server's and not the same bytes from memory (iPads had that). */
  async function openEitherWay(blob) {
    try {
      await player.open(blob, "memory");
    } catch {
      await player.open(url, "server");
    }
  }

  /** After a reload nothing is in memory: fetch what comes next while this clip is looked at. */
  function loadTheRest() {
    for (const part of main.dataset.next.split(",").filter(Boolean)) {
      const [next, bytes] = part.split(" ");
      clips.load({ url: next, bytes: Number(bytes) }).catch(() => {}); // its own page tells
    }
  }

  function broken(code) {
    clips.forget(url);
    stage.querySelector("[data-code]").textContent = `${main.dataset.code}-${code}`;
    player.state = "broken";
    record("problem", { code: `CLIP-${code}` }, `${position}/problem`);
  }

  function tooSmall() {
    player.state = "small";
  }

  function played(play) {
    record("play", { play });
    if (!play.is_complete) return;
    viewsLeft = Math.max(0, viewsLeft - 1);
    player.isWatched = viewsLeft === 0;
    player.state = player.isWatched ? "watched" : "ready";
    if (!player.isWatched) return;
    questions.unlock();
    stage.querySelector("[data-to-questions]").focus({ preventScroll: true });
  }

  function toQuestions() {
    document.documentElement.dataset.view = "questions";
    main.querySelector(".questions").scrollIntoView();
    main.querySelector(".questions h2").focus({ preventScroll: true });
  }

  let mayStayOpen = false;
  async function submit(event) {
    event.preventDefault();
    if (form.dataset.sending) return; // a double click sends once
    questions.flush();
    const open = questions.open();
    const note = form.querySelector("[data-open-note]");
    if (open.length && !mayStayOpen) {
      mayStayOpen = true;
      note.hidden = false;
      note.querySelector("[data-count]").textContent = text("trial.open_questions", {
        count: open.length,
      });
      note.focus();
      return;
    }
    form.dataset.sending = "yes";
    form.querySelector("[type=submit]").setAttribute("aria-disabled", "true");
    form.elements.namedItem("response_ms").value = clock.read();
    await outbox.settled();
    clock.clear();
    await submitPatiently(form, start, {
      onWaiting: () => outbox.options.onChange({ waiting: 1, failed: true }),
      onLeave: () => clips.forget(url),
    });
  }

  return () => player.close();
}

/** Time since the trial's first presented frame; it goes on over a reload. */
function firstFrameClock(trial) {
  const name = `ocularist.first-frame.${trial}`;
  return {
    start() {
      if (!sessionStorage.getItem(name)) sessionStorage.setItem(name, String(Date.now()));
    },
    read() {
      const first = Number(sessionStorage.getItem(name));
      return first ? String(Date.now() - first) : "";
    },
    clear() {
      sessionStorage.removeItem(name);
    },
  };
}
