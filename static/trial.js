// The page of one trial: a clip, then its questions.

import { clockStep_ms, firstFrameClock } from "./clock.js";
import { Draft } from "./draft.js";
import { Keep } from "./keep.js";
import { submitPatiently } from "./navigate.js";
import { Questionnaire } from "./questionnaire.js";
import { text } from "./texts.js";
import { startWatching } from "./watching.js";

/** Start the page; returns the function that ends it. */
export function startTrial(main, { outbox, clips, start }) {
  const form = main.querySelector(".questions form");
  const { session } = document.body.dataset;
  const position = Number(main.dataset.position);
  const clock = firstFrameClock(`${session}.${position}`);
  const draft = new Draft(session, `trial-${position}`);
  const running = new Keep(`ocularist.running.${session}.`);
  const verdicts = new Map(); // key of a play -> who waits for what the site says of it
  const record = (kind, values, about) => outbox.add({ kind, position, ...values }, about);
  const stop = new AbortController();

  tellOfLostPlays();
  outbox.onStored = ({ key }, told) => verdicts.get(key)?.(told);
  const questions = new Questionnaire(form, { save });
  draft.follow(form);
  const watching = startWatching(main, {
    clips,
    onFirstFrame: began,
    onPlay: played,
    onWatched: () => questions.unlock(),
    onBroken: (code) => record("problem", { code: `CLIP-${code}` }, `${position}/problem`),
  });
  if (watching.isWatched) questions.unlock();
  for (const name of draft.restore(form)) save(name, questions.value(name));
  questions.applyRules();
  for (const button of main.querySelectorAll("[data-to-questions]")) {
    button.addEventListener("click", toQuestions);
  }
  form.querySelector("[data-again]")?.addEventListener("click", watching.play);
  form.addEventListener("submit", submit);
  addEventListener("pagehide", () => questions.flush(), { signal: stop.signal });
  if (main.dataset.open === "questions") toQuestions();

  function save(question, value) {
    draft.note(question, value);
    record("answer", { question, value }, `${position}/${question}`);
  }

  function began(shown_ms) {
    clock.start(shown_ms);
    running.set(String(position), new Date().toISOString());
  }

  /** Store the record of a play; resolves with what the site says of it, once it does. */
  function played(play) {
    running.remove(String(position));
    const key = record("play", { play });
    return new Promise((resolve) => verdicts.set(key, resolve));
  }

  /** A play that began and never ended: the browser crashed, or was killed. */
  function tellOfLostPlays() {
    for (const place of running.names()) {
      const play = { is_complete: false, ended_by: "lost", started_at: running.get(place) };
      outbox.add({ kind: "play", position: Number(place), play });
      running.remove(place);
    }
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
    if (open.length && !mayStayOpen) {
      mayStayOpen = true;
      tellOfOpen(open.length);
      return;
    }
    form.dataset.sending = "yes";
    form.querySelector("[type=submit]").setAttribute("aria-disabled", "true");
    const extra = [
      ["response_ms", clock.read()],
      ["clock_ms", clockStep_ms()],
    ];
    await outbox.settled();
    await submitPatiently(form, start, {
      extra,
      onWaiting: () => outbox.options.onChange({ waiting: 1, failed: true }),
      onLeave: () => {
        draft.clear();
        clock.clear();
      },
    });
  }

  function tellOfOpen(count) {
    const note = form.querySelector("[data-open-note]");
    note.hidden = false;
    note.querySelector("[data-count]").textContent = text("trial.open_questions", { count });
    note.focus();
  }

  return () => {
    stop.abort();
    watching.close();
    outbox.onStored = () => {};
  };
}
