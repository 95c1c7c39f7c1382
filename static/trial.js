// The page of one trial: a clip, then its questions.

import { fetchPatiently, showPage } from "./navigate.js";
import { Player } from "./player.js";
import { Questionnaire } from "./questionnaire.js";

/** Start the page; returns the function that ends it. */
export function startTrial(main, { outbox, clips, start }) {
  const stage = main.querySelector(".stage");
  const form = main.querySelector(".questions form");
  const { trial, clip: url } = main.dataset;
  const number = (name) => Number(main.dataset[name]);
  const clip = { url, bytes: number("bytes") };
  const record = (kind, values, about) => outbox.add({ kind, trial, ...values }, about);
  const clock = firstFrameClock(trial);

  const player = new Player(stage, {
    width: number("width"),
    height: number("height"),
    frames: number("frames"),
    onFirstFrame: clock.start,
    onPlay: played,
    onBroken: broken,
    onTooSmall: tooSmall,
  });
  player.isWatched = main.dataset.watched === "yes";
  const questions = new Questionnaire(form, {
    save: (question, value) => record("answer", { question, value }, `${trial}/${question}`),
  });
  if (player.isWatched) questions.unlock();
  stage.querySelector("[data-reload]").addEventListener("click", load);
  stage.querySelector("[data-to-questions]").addEventListener("click", toQuestions);
  form.querySelector("[data-again]")?.addEventListener("click", () => player.play());
  form.addEventListener("submit", submit);
  load();

  async function load() {
    player.state = "loading";
    const meter = stage.querySelector("[data-when='loading'] progress");
    clips.onProgress = () => (meter.value = clips.bytesOf([clip]) / clip.bytes);
    try {
      await player.open(await clips.loadFirst(clip));
    } catch (error) {
      broken(error?.message?.split(" ")[0] || "DECODE");
    }
  }

  function broken(code) {
    clips.forget(url);
    stage.querySelector("[data-code]").textContent = `${main.dataset.code}-${code}`;
    player.state = "broken";
    record("problem", { code: `CLIP-${code}` }, `${trial}/problem`);
  }

  function tooSmall() {
    player.state = "small";
  }

  function played(play) {
    record("play", { play });
    if (!play.is_complete) return;
    questions.unlock();
    stage.querySelector("[data-to-questions]").focus({ preventScroll: true });
  }

  function toQuestions() {
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
      note.querySelector("[data-count]").textContent =
        open.length === 1 ? "One question is" : `${open.length} questions are`;
      note.focus();
      return;
    }
    form.dataset.sending = "yes";
    const button = form.querySelector("[type=submit]");
    button.setAttribute("aria-disabled", "true");
    await outbox.settled();
    const body = new URLSearchParams(new FormData(form));
    body.set("response_ms", clock.read());
    const answer = await fetchPatiently(form.action, { method: "POST", body }, () =>
      button.setAttribute("data-waiting", "yes"),
    );
    clock.clear();
    clips.forget(url);
    await showPage(answer, start);
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
