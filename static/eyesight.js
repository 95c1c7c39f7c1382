// Eyesight: rings with a gap, then plates. Answers go to the server, which alone knows the plates.

import { submitPatiently } from "./navigate.js";
import { drawRing, LARGEST_PX, Staircase } from "./rings.js";
import { text } from "./texts.js";

const KEYS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const PAD = { 6: 0, 3: 1, 2: 2, 1: 3, 4: 4, 7: 5, 8: 6, 9: 7 };
const PAIR_MS = 90; // two arrow keys within this time are one diagonal

/** Start the page; returns the function that ends it. */
export function startEyesight(main, { start }) {
  const data = main.dataset;
  const find = (what) => main.querySelector(what);
  const report = { rings: [], rings_skipped: false, digits: [], plates_skipped: false };
  const stop = new AbortController();
  const staircase = new Staircase({
    directions: Number(data.directions),
    least_px: Number(data.least_gap_px),
    needed: Number(data.needed),
  });
  const presses = new Set();
  let stage = "glasses";
  let ring = null;
  find("[data-begin]").addEventListener("click", () => toRings());
  for (const button of main.querySelectorAll("[data-start]")) {
    button.addEventListener("click", () => (button.dataset.start === "rings" ? rings() : plates()));
  }
  for (const button of main.querySelectorAll("[data-skip]")) {
    button.addEventListener("click", () => skip(button.dataset.skip));
  }
  for (const button of main.querySelectorAll("[data-direction]")) {
    const { direction } = button.dataset;
    button.addEventListener("click", () => told(direction === "" ? null : Number(direction)));
  }
  for (const button of main.querySelectorAll("[data-digit]")) {
    const { digit } = button.dataset;
    button.addEventListener("click", () => read(digit === "" ? null : Number(digit)));
  }
  document.addEventListener("keydown", key, { signal: stop.signal });
  return () => stop.abort();

  function show(name) {
    stage = name;
    for (const part of main.querySelectorAll("[data-stage]")) part.hidden = part.dataset.stage !== name;
    find(`[data-stage="${name}"] h1`)?.focus({ preventScroll: true });
    scrollTo(0, 0);
  }

  function toRings() {
    report.glasses = find("[name=glasses]:checked")?.value ?? null;
    if (data.rings === "yes") show("rings-intro");
    else toPlates();
  }

  function toPlates() {
    if (!Number(data.plates)) return send();
    load(1);
    show("plates-intro");
  }

  function skip(part) {
    report[`${part}_skipped`] = true;
    if (part === "rings") toPlates();
    else send();
  }

  function rings() {
    find(".ring-answers").style.setProperty("--largest", `${LARGEST_PX / devicePixelRatio}px`);
    show("rings");
    nextRing();
  }

  function nextRing() {
    ring = staircase.next();
    if (ring === null) return toPlates();
    drawRing(find("[data-ring]"), ring);
    find("[data-ring-number]").textContent = text("eyesight.ring_number", {
      number: report.rings.length + 1,
    });
  }

  function told(direction) {
    if (stage !== "rings" || ring === null) return;
    report.rings.push({ gap_px: ring.gap_px, shown: ring.direction, said: direction });
    staircase.answer(direction === ring.direction);
    nextRing();
  }

  function plates() {
    show("plates");
    nextPlate();
  }

  function nextPlate() {
    const number = report.digits.length + 1;
    const total = Number(data.plates);
    if (number > total) return send();
    find("[data-plate]").src = address(number);
    find("[data-plate-number]").textContent = text("eyesight.plate_number", { number, total });
    if (number < total) load(number + 1);
  }

  /** Browsers may keep a plate for a while: the next person's has another address. */
  function address(number) {
    return `/eyesight/plates/${number}.svg?${document.body.dataset.session}`;
  }

  /** Have a plate drawn and sent before it is wanted. */
  function load(number) {
    new Image().src = address(number);
  }

  function read(digit) {
    if (stage !== "plates") return;
    report.digits.push(digit);
    nextPlate();
  }

  function key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey || event.repeat) return;
    if (stage === "plates" && /^[1-9]$/.test(event.key)) read(Number(event.key));
    if (stage !== "rings") return;
    if (event.key in PAD) told(allowed(PAD[event.key]));
    if (event.key in KEYS) {
      event.preventDefault();
      if (!presses.size) setTimeout(arrows, PAIR_MS);
      presses.add(event.key);
    }
  }

  /** One arrow key is a straight direction, two at once a diagonal one. */
  function arrows() {
    const [x, y] = [...presses].map((name) => KEYS[name]).reduce(([a, b], [c, d]) => [a + c, b + d]);
    presses.clear();
    if (x || y) told(allowed((Math.round((Math.atan2(y, x) * 4) / Math.PI) + 8) % 8));
  }

  function allowed(direction) {
    return data.directions === "4" && direction % 2 ? null : direction;
  }

  async function send() {
    const form = find("[data-send]");
    if (form.dataset.sending) return;
    form.dataset.sending = "yes";
    stage = "sent";
    if (report.plates_skipped) report.digits = [];
    await submitPatiently(form, start, { extra: [["report", JSON.stringify(report)]] });
  }
}
