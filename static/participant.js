// The participant's pages: one outbox and one store of clips for as long as the document lives.

import { Outbox } from "./outbox.js";
import { ClipStore } from "./preload.js";
import { startAbout } from "./about.js";
import { startNext, startStop } from "./leaving.js";
import { startPause } from "./pause.js";
import { startPreparing } from "./preparing.js";
import { text } from "./texts.js";
import { startTrial } from "./trial.js";

const PAGES = {
  about: startAbout,
  pause: startPause,
  preparing: startPreparing,
  trial: startTrial,
  next: startNext,
  stop: startStop,
};
const clips = new ClipStore();
const outboxes = new Map(); // session -> Outbox
let close = () => {};

start();
addEventListener("pageshow", (event) => event.persisted && location.reload());

function start() {
  close();
  const main = document.querySelector("main");
  const outbox = currentOutbox();
  close = PAGES[main.dataset.page]?.(main, { outbox, clips, start }) ?? (() => {});
  outbox?.send();
}

function currentOutbox() {
  const { session, csrf, events } = document.body.dataset;
  if (!session) return null;
  if (!outboxes.has(session)) {
    outboxes.set(
      session,
      new Outbox(session, { url: events, csrf, onChange: showSaved, onRefused: refused }),
    );
  }
  return outboxes.get(session);
}

/** Say in the strip whether everything is stored. */
function showSaved({ waiting, failed }) {
  const line = document.querySelector(".saved");
  if (!line) return;
  const state = !waiting ? "saved" : failed ? "waiting" : "saving";
  if (line.dataset.state === state) return;
  line.dataset.state = state;
  line.querySelector("[role=status]").textContent = {
    saved: text("all.saved"),
    saving: text("all.saving"),
    waiting: text("all.not_saved"),
  }[state];
}

/** The server will never take this entry: it belongs to a trial that is over. Show where we are. */
function refused(entry, answer) {
  if (answer.status === 409) location.reload();
}
