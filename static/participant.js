// The participant's pages: one store of clips for as long as the document lives, one tab at a time.

import { ClipStore } from "./preload.js";
import { startAbout } from "./about.js";
import { startCalibration } from "./calibration.js";
import { startDeviceCheck } from "./device_check.js";
import { startEyesight } from "./eyesight.js";
import { startNext, startStop, startWithdrawn } from "./leaving.js";
import { startPause } from "./pause.js";
import { startPreparing } from "./preparing.js";
import { watchForSigns } from "./release.js";
import { currentSession, deliverForOthers } from "./sessions.js";
import { startTrial } from "./trial.js";

const PAGES = {
  about: startAbout,
  device_check: startDeviceCheck,
  calibration: startCalibration,
  eyesight: startEyesight,
  pause: startPause,
  preparing: startPreparing,
  trial: startTrial,
  next: startNext,
  stop: startStop,
  withdrawn: startWithdrawn,
};
const FREE = new Set(["next", "stop", "withdrawn"]); // pages that any tab may show
const clips = new ClipStore();
let close = () => {};
let isElsewhere = false;

start();
addEventListener("pageshow", (event) => event.persisted && location.reload());

function start() {
  close();
  close = () => {};
  const main = document.querySelector("main");
  const { page } = main.dataset;
  watchForSigns();
  const session = currentSession({ onLost: goElsewhere, isElsewhere: () => isElsewhere });
  if (session && PAGES[page] && !FREE.has(page) && !session.tab.claim()) return goElsewhere();
  close = PAGES[page]?.(main, { outbox: session?.outbox ?? null, clips, start }) ?? close;
  if (session) session.outbox.send();
  else deliverForOthers(null, document.body.dataset.events);
}

/** Another tab takes part: this one says so, keeps still, and takes over when asked or when it may. */
function goElsewhere() {
  if (isElsewhere) return;
  isElsewhere = true;
  close();
  close = () => {};
  const notice = document.querySelector("[data-elsewhere]");
  document.querySelector("main").hidden = true; // the strip stays: one can stop from any tab
  notice.hidden = false;
  notice.querySelector("[data-here]").addEventListener("click", () => {
    currentSession({}).tab.take();
    location.reload();
  });
  notice.querySelector("h1").focus();
}
