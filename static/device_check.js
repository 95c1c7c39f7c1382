// The check of screen, browser and connection: measures one thing after the other and shows each.
//
// What is found good or bad here is only shown; the server judges the report again.

import { connectionRate, frameTimes, isPhone, screenZoom, zoomOf } from "./measures.js";
import { submitPatiently } from "./navigate.js";
import { selfTest } from "./self_test.js";
import { screenFacts } from "./screen.js";
import { text } from "./texts.js";

const REMOTE_REFRESH_HZ = 40;
const REMOTE_JITTER_MS = 6;
const SHORTEST_MS = 250; // so that the eye can follow what appears

/** Start the page; returns the function that ends it. */
export function startDeviceCheck(main, { start }) {
  const form = main.querySelector("form[action='/device-check']");
  const items = new Map(
    Array.from(main.querySelectorAll("[data-item]"), (part) => [part.dataset.item, part]),
  );
  let report = {};
  let run = 0;
  main.querySelector("[data-again]").addEventListener("click", () => check());
  form.addEventListener("submit", submit);
  form.addEventListener("change", () => takeAnswers());
  main.querySelector("[data-stopped]")?.focus({ preventScroll: true });
  check();
  return () => {
    run += 1;
  };

  async function check() {
    const mine = (run += 1);
    report = {};
    main.querySelector("[data-actions]").hidden = true;
    for (const [name, measure] of Object.entries(MEASURES)) {
      const part = items.get(name);
      if (!part) continue;
      part.hidden = false;
      part.dataset.verdict = "asking";
      say(text("device_check.checking", { name: part.querySelector("h2").firstChild.data }));
      const [found] = await Promise.all([
        measure(main, report).catch(() => null),
        new Promise((resolve) => setTimeout(resolve, SHORTEST_MS)),
      ]);
      if (mine !== run) return;
      show(part, found ?? { verdict: "unknown", words: text("device_check.unknown") });
    }
    for (const name of ["contrast", "light"]) {
      items.get(name).hidden = false;
      items.get(name).querySelector("[data-found]").hidden = true;
    }
    if (report.dynamic_range === "high") hint(items.get("light"));
    takeAnswers();
    main.querySelector("[data-actions]").hidden = false;
    say(text("device_check.all_checked"));
  }

  function show(part, { verdict, value, words }) {
    const { least, most } = part.dataset;
    const isGood = (!least || value >= Number(least)) && (!most || value <= Number(most));
    part.dataset.verdict = verdict ?? (isGood ? "good" : "bad");
    part.querySelector("[data-found]").textContent = words;
    part.querySelector("[data-remedy]").hidden = part.dataset.verdict !== "bad";
  }

  function hint(part) {
    const found = part.querySelector("[data-found]");
    found.hidden = false;
    found.textContent = text("device_check.hdr_hint");
  }

  /** Questions have no verdict until the server has judged; an "on" shows its remedy at once. */
  function takeAnswers() {
    const given = new FormData(form);
    for (const name of ["dark_counted", "light_counted"]) {
      const typed = String(given.get(name) ?? "").trim();
      report[name] = /^\d{1,2}$/.test(typed) ? Math.min(20, Number(typed)) : null;
    }
    for (const name of ["night_light", "hdr"]) report[name] = given.get(name);
    const light = items.get("light");
    const isOn = report.night_light === "on" || report.hdr === "on";
    const isGiven = report.night_light && report.hdr;
    light.dataset.verdict = isOn ? "bad" : isGiven ? "good" : "waiting";
    light.querySelector("[data-remedy]").hidden = !isOn;
    const contrast = items.get("contrast");
    if (contrast.dataset.verdict === "bad") contrast.querySelector("[data-remedy]").hidden = false;
  }

  function say(words) {
    main.querySelector("[data-status]").textContent = words;
  }

  async function submit(event) {
    event.preventDefault();
    if (form.dataset.sending) return;
    form.dataset.sending = "yes";
    takeAnswers();
    await submitPatiently(form, start, { extra: [["report", JSON.stringify(report)]] });
  }
}

// Each measures one item, notes it in the report, and returns what to show of it.
const MEASURES = {
  async device(main, report) {
    report.is_phone = isPhone();
    report.reduced_motion = matchMedia("(prefers-reduced-motion: reduce)").matches;
    report.colour_depth = screen.colorDepth;
    report.dynamic_range = matchMedia("(dynamic-range: high)").matches ? "high" : "standard";
    report.colour_gamut =
      ["rec2020", "p3", "srgb"].find((one) => matchMedia(`(color-gamut: ${one})`).matches) ?? null;
    const kind = report.is_phone ? "phone" : "computer";
    const isRefused = report.is_phone && main.dataset.phones === "no";
    return { verdict: isRefused ? "bad" : "good", words: text(`device_check.${kind}`) };
  },

  async screen(main, report) {
    const facts = screenFacts();
    const enlarged = screenZoom();
    report.screen_width_px = Math.round(facts.screen_width_px / enlarged);
    report.screen_height_px = Math.round(facts.screen_height_px / enlarged);
    report.window_width_px = facts.viewport_width_px;
    report.window_height_px = facts.viewport_height_px;
    report.pixel_ratio = facts.device_pixel_ratio;
    const size = { width: report.screen_width_px, height: report.screen_height_px };
    const fitting = main.dataset.sizes
      .split(" ")
      .map((one) => one.split("x").map(Number))
      .filter(([width, height]) => width <= size.width && height <= size.height);
    if (!fitting.length) return { verdict: "bad", words: text("device_check.screen", size) };
    const fits = `\u2066${fitting.at(-1).join(" × ")}\u2069`; // left to right in every language
    return { verdict: "good", words: text("device_check.screen_fits", { ...size, fits }) };
  },

  async window(main, report) {
    report.zoom = zoomOf();
    if (report.zoom === null) return null;
    const ratio = Math.round(100 * devicePixelRatio) / 100;
    const percent = Math.round(100 * report.zoom);
    return { value: report.zoom, words: text("device_check.zoom", { percent, ratio }) };
  },

  async refresh(main, report) {
    const { hertz, jitter_ms } = await frameTimes();
    report.refresh_hz = hertz;
    report.refresh_jitter_ms = jitter_ms;
    return { value: hertz, words: text("device_check.refresh", { hertz: Math.round(hertz) }) };
  },

  async decoder(main, report) {
    const { self_test, patches, patch_px, columns } = main.dataset;
    const wanted = JSON.parse(patches);
    const layout = { count: wanted.length, patch_px: Number(patch_px), columns: Number(columns) };
    const found = await selfTest(self_test, layout, main.dataset.sizes.split(" ").at(-1));
    Object.assign(report, found);
    const error = Math.max(...wanted.flat().map((one, i) => Math.abs(one - found.patches.flat()[i])));
    const shown = Math.round(10 * error) / 10;
    return { value: error, words: text("device_check.decoder", { error: shown }) };
  },

  async bandwidth(main, report) {
    report.mbit_s = await connectionRate(main.dataset.clips.split(" ").filter(Boolean));
    if (report.mbit_s === null) return null;
    const rate = report.mbit_s < 10 ? report.mbit_s.toFixed(1) : Math.round(report.mbit_s);
    return { value: report.mbit_s, words: text("device_check.bandwidth", { rate }) };
  },

  async remote(main, report) {
    const hints = [
      report.colour_depth < 24,
      report.refresh_hz < REMOTE_REFRESH_HZ,
      report.refresh_jitter_ms > REMOTE_JITTER_MS,
    ].filter(Boolean).length;
    const view = hints > 1 ? "remote" : "direct";
    return { verdict: hints > 1 ? "bad" : "good", words: text(`device_check.${view}`) };
  },
};
