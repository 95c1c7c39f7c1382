// Calibration: the card, then the blind spot. Every stage can be left out, with a reason.
//
// Measures go to the server as they are; what is worked out here only steers the page.

import { BlindSpot } from "./blind_spot.js";
import { submitPatiently } from "./navigate.js";
import { screenFacts } from "./screen.js";
import { text } from "./texts.js";

const STARTS_PX = [200, 420]; // CSS pixels: once from too small, once from too large
const GUESS_MM_PER_PX = 0.25;
const PERSON_SHARE = 0.074; // how much the blind spot's place differs between people

/** Start the page; returns the function that ends it. */
export function startCalibration(main, { start }) {
  const data = main.dataset;
  const number = (name) => Number(data[name]);
  const find = (what) => main.querySelector(what);
  const slider = find("#card-width");
  const report = {};
  let spot = null;
  for (const button of main.querySelectorAll("[data-to]")) {
    button.addEventListener("click", () => show(button.dataset.to));
  }
  for (const button of main.querySelectorAll("[data-step]")) {
    button.addEventListener("click", () => step(Number(button.dataset.step)));
  }
  for (const button of main.querySelectorAll("[data-spot]")) {
    button.addEventListener("click", () => measureDistance(button.dataset.spot));
  }
  slider.addEventListener("input", drawCard);
  find("[data-card-fits]").addEventListener("click", cardFits);
  find("[data-stage='diagonal']").addEventListener("submit", takeDiagonal);
  find("[data-stage='skip-card']").addEventListener("submit", skipCard);
  find("[data-stage='skip-distance']").addEventListener("submit", skipDistance);
  find("[data-send]").addEventListener("submit", send);
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) offerStillness();
  begin();
  return () => spot?.close();

  /** Whoever wants less motion is offered first to move the dot by key. */
  function offerStillness() {
    const [moving, byKey] = main.querySelectorAll("[data-spot]");
    moving.before(byKey);
    byKey.classList.remove("quiet");
    moving.classList.add("quiet");
  }

  function show(stage) {
    if (stage === "card") begin();
    for (const part of main.querySelectorAll("[data-stage]")) {
      part.hidden = part.dataset.stage !== stage;
    }
    const shown = find(`[data-stage="${stage}"]`);
    (shown.querySelector("h2") ?? shown.querySelector("input"))?.focus({ preventScroll: true });
    scrollTo(0, 0);
  }

  function begin() {
    for (const name of Object.keys(report)) delete report[name];
    Object.assign(report, { card_widths_px: [], places_px: [] });
    nextCard();
  }

  function nextCard() {
    const done = report.card_widths_px.length;
    find("[data-card-number]").textContent = text("calibration.card_number", {
      number: done + 1,
      total: STARTS_PX.length,
    });
    find("[data-card-again]").hidden = done === 0;
    find("[data-card-lead]").hidden = done > 0;
    slider.value = STARTS_PX[done];
    drawCard();
  }

  function drawCard() {
    const card = find("[data-card]");
    const width = Number(slider.value);
    card.style.width = `${width}px`;
    card.style.height = `${(width * number("card_height_mm")) / number("card_width_mm")}px`;
  }

  function step(way) {
    slider.value = Number(slider.value) + way;
    drawCard();
  }

  function cardFits() {
    report.card_widths_px.push(Number(slider.value) * devicePixelRatio);
    if (report.card_widths_px.length < STARTS_PX.length) {
      nextCard();
      slider.focus({ preventScroll: true });
      return;
    }
    report.scale_method = "card";
    toDistance();
  }

  function takeDiagonal(event) {
    event.preventDefault();
    const inches = Number(find("#diagonal").value);
    const isGood = inches >= 5 && inches <= 120;
    find("[data-diagonal-fault]").hidden = isGood;
    if (!isGood) return find("#diagonal").focus();
    Object.assign(report, { scale_method: "diagonal", diagonal_inch: inches, card_widths_px: [] });
    toDistance();
  }

  function skipCard(event) {
    event.preventDefault();
    const why = new FormData(event.target).get("why-card");
    Object.assign(report, { scale_method: "skipped", scale_skipped: why, card_widths_px: [] });
    Object.assign(report, { distance_method: data.distance === "yes" ? "skipped" : "not_asked" });
    report.distance_skipped = data.distance === "yes" ? why : null;
    finish();
  }

  function toDistance() {
    if (data.distance === "yes") return show("distance");
    report.distance_method = "not_asked";
    finish();
  }

  function skipDistance(event) {
    event.preventDefault();
    report.distance_method = "skipped";
    report.distance_skipped = new FormData(event.target).get("why-distance");
    report.places_px = [];
    finish();
  }

  /** Millimetres of a CSS pixel, as far as they are known. */
  function millimetres() {
    const { card_widths_px: widths, diagonal_inch: inches } = report;
    if (widths?.length) {
      const mean = widths.reduce((sum, width) => sum + width, 0) / widths.length;
      return (devicePixelRatio * number("card_width_mm")) / mean;
    }
    return inches ? (25.4 * inches) / Math.hypot(screen.width, screen.height) : GUESS_MM_PER_PX;
  }

  function measureDistance(moved) {
    report.moved = moved;
    find("[data-frame]").hidden = true;
    scrollTo(0, 0);
    spot = new BlindSpot(find("[data-spot-stage]"), {
      moved,
      repetitions: number("repetitions"),
      angle_deg: number("blind_spot_deg"),
      eye_mm: number("eye_mm"),
      mm_per_px: millimetres(),
      onEnd: (found) => {
        spot = null;
        find("[data-frame]").hidden = false;
        if (!found) return show("skip-distance");
        report.distance_method = "blind_spot";
        report.places_px = found.places_px;
        finish(found.distance_mm);
      },
    });
  }

  function finish(distance_mm = null) {
    const facts = screenFacts();
    report.screen_width_px = facts.screen_width_px;
    report.screen_height_px = facts.screen_height_px;
    report.pixel_ratio = facts.device_pixel_ratio;
    const width = Math.round((millimetres() * screen.width) / 10);
    const line = find("[data-result]");
    if (report.scale_method === "skipped") line.textContent = text("calibration.result_none");
    else if (distance_mm === null) line.textContent = text("calibration.result_screen", { width });
    else {
      const distance = Math.round(distance_mm / 10);
      const error = Math.max(1, Math.round((PERSON_SHARE * distance_mm) / 10));
      line.textContent = text("calibration.result", { distance, width, error });
    }
    show("result");
  }

  async function send(event) {
    event.preventDefault();
    if (event.target.dataset.sending) return;
    event.target.dataset.sending = "yes";
    await submitPatiently(event.target, start, { extra: [["report", JSON.stringify(report)]] });
  }
}
