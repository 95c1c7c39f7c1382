// Waiting for the clips: first for them to be rendered, then for them to reach this browser.

import { amountText } from "./amount.js";
import { submitPatiently } from "./navigate.js";
import { fetchPatiently } from "./patience.js";
import { AHEAD } from "./preload.js";
import { screenZoom } from "./measures.js";
import { enterFullscreen, screenFacts } from "./screen.js";

const POLL_MS = 2000;

/** Start the page; returns the function that ends it. */
export function startPreparing(main, { clips, start }) {
  const form = main.querySelector("form");
  const meter = main.querySelector("progress");
  const button = form.querySelector("button");
  let isOpen = true;
  let wanted = [];
  for (const part of main.querySelectorAll("[data-retry]")) part.addEventListener("click", load);
  form.addEventListener("submit", begin);
  wait();
  return () => {
    isOpen = false;
    clips.onProgress = () => {};
  };

  /** Show one of the page's states; every state has its words in the page. */
  function show(state) {
    if (main.dataset.state === state) return;
    main.dataset.state = state;
    for (const part of main.querySelectorAll("[data-when]")) {
      part.hidden = !part.dataset.when.split(" ").includes(state);
    }
  }

  function query() {
    const facts = screenFacts();
    const enlarged = screenZoom();
    return new URLSearchParams({
      screen_width_px: Math.round(facts.screen_width_px / enlarged),
      screen_height_px: Math.round(facts.screen_height_px / enlarged),
    });
  }

  /** Ask until the clips of a size that fits this screen are all rendered. */
  async function wait() {
    while (isOpen) {
      const answer = await fetchPatiently(`${main.dataset.state_url}?${query()}`, {}, {
        onWaiting: () => show("offline"),
        isOurs: (text) => text.startsWith("{"),
      });
      if (!answer.ok || answer.redirected || !isOpen) {
        if (isOpen) location.reload(); // the session ended or moved on: the server knows where to
        return;
      }
      const news = JSON.parse(answer.text);
      if (!news.fits) return show("small");
      if (news.is_ready) return load(news.clips);
      show("rendering");
      meter.value = news.progress;
      main.querySelector("[data-wait]").textContent = news.wait;
      await new Promise((resolve) => setTimeout(resolve, POLL_MS));
    }
  }

  async function load(list) {
    wanted = Array.isArray(list) ? list : wanted;
    show("loading");
    // The others follow while these are watched.
    const first = wanted.slice(0, 1 + AHEAD);
    const total = first.reduce((sum, clip) => sum + clip.bytes, 0);
    const amount = main.querySelector("[data-amount]");
    clips.keepOnly(first);
    clips.onProgress = () => {
      const bytes = clips.bytesOf(first);
      meter.value = Math.min(1, bytes / total);
      amount.textContent = amountText(bytes, total);
    };
    clips.onProgress();
    try {
      await Promise.all(first.map((clip) => clips.load(clip)));
      meter.value = 1;
      show("ready");
      button.focus({ preventScroll: true });
    } catch (error) {
      main.querySelector("[data-code]").textContent = `LOAD-${error.message}`;
      show("broken");
    }
  }

  /** Full screen is asked for in the click itself: browsers grant it for a gesture only. */
  async function begin(event) {
    event.preventDefault();
    if (form.dataset.sending) return;
    form.dataset.sending = "yes";
    await enterFullscreen();
    const extra = [...query(), ["pixel_ratio", devicePixelRatio]];
    await submitPatiently(form, start, { extra, onWaiting: () => show("offline") });
  }
}
