// The stage of a trial: its clip comes, is played, and played again where it must or may be.

import { amountText } from "./amount.js";
import { restAgain, stayAwake, wakeState } from "./awake.js";
import { decodingFacts } from "./codec.js";
import { Player } from "./player.js";
import { AHEAD } from "./preload.js";

const VERDICT_MS = 1500; // so long the page waits for the site to say whether a play counts

/**
 * Start the stage of a trial's page.
 * @param {HTMLElement} main
 * @param {{clips: ClipStore, onFirstFrame: (shown_ms: number) => void,
 *          onPlay: (play: object) => Promise<object | null>, onWatched: () => void,
 *          onBroken: (code: string) => void}} options
 *   onPlay: stores a record, and resolves with the site's verdict on it, which may never come
 * @returns {{play: () => void, close: () => void, isWatched: boolean}}
 */
export function startWatching(main, options) {
  const { clips } = options;
  const stage = main.querySelector(".stage");
  const number = (name) => Number(main.dataset[name]);
  const clip = { url: main.dataset.clip, bytes: number("bytes") };
  const next = main.dataset.next.split(",").filter(Boolean).slice(0, AHEAD).map(clipOf);
  let viewsLeft = number("views_left"); // until the questions open
  let viewsAllowed = main.dataset.views_allowed ? number("views_allowed") : Infinity;
  let retries = number("retries");
  let speakUp = () => {};
  let isOpen = true;

  const player = new Player(stage, {
    width: number("width"),
    height: number("height"),
    frames: number("frames"),
    onStart: () => (speakUp = clips.hush()),
    onFirstFrame: options.onFirstFrame,
    onPlay: played,
    onBroken: broken,
    onTooSmall: () => offer("small"),
  });
  player.isWatched = viewsLeft === 0;
  stage.querySelector("[data-reload]").addEventListener("click", load);
  allowAgain();
  stayAwake();
  load();
  return {
    play: () => player.play(),
    close: () => {
      isOpen = false;
      player.close();
      restAgain();
    },
    isWatched: player.isWatched,
  };

  async function load() {
    player.state = "loading";
    const meter = stage.querySelector("[data-when='loading'] progress");
    const amount = stage.querySelector("[data-amount]");
    clips.keepOnly([clip, ...next]);
    clips.onProgress = () => {
      const bytes = clips.bytesOf([clip]);
      meter.value = bytes / clip.bytes;
      amount.textContent = amountText(bytes, clip.bytes);
    };
    clips.onProgress();
    try {
      const held = await clips.loadFirst(clip);
      if (!isOpen) return;
      await openEitherWay(held);
      // What comes next is fetched while this clip is looked at; its own page tells of failures.
      for (const one of next) clips.load(one).catch(() => {});
    } catch (error) {
      if (isOpen) broken(error?.message?.split(" ")[0] || "DECODE");
    }
  }

  /** Some browsers play a file of the server's and not the same bytes from memory (iPads had that). */
  async function openEitherWay({ address, sha256, codec }) {
    const [width, height, frames] = ["width", "height", "frames"].map(number);
    const facts = { clip_sha256: sha256, codec };
    try {
      await player.open(address, { ...facts, source: "memory" });
    } catch {
      await player.open(clip.url, { ...facts, source: "server" });
    }
    const { duration } = player.video;
    const kind = { codec, width, height, fps: frames / duration, bitrate: (8 * clip.bytes) / duration };
    Object.assign(player.facts, await decodingFacts(kind));
  }

  function broken(code) {
    speakUp();
    clips.forget(clip.url);
    stage.querySelector("[data-code]").textContent = `${main.dataset.code}-${code}`;
    offer("broken");
    options.onBroken(code);
  }

  async function played(play) {
    speakUp();
    const verdict = options.onPlay({ ...play, wake_lock: wakeState() });
    if (!play.is_complete) return offer(player.state);
    viewsLeft = Math.max(0, viewsLeft - 1);
    viewsAllowed -= 1;
    player.isWatched = viewsLeft === 0;
    if (player.isWatched) options.onWatched();
    player.state = "judging";
    const asksAgain = retries > 0 && (await withinTime(verdict))?.certified === false;
    if (player.state !== "judging") return; // played again in the meantime
    if (asksAgain) retries -= 1;
    allowAgain();
    offer(!player.isWatched ? "ready" : asksAgain ? "again" : "watched");
  }

  /** Show what can be done now, under the fingers of those who use the keyboard. */
  function offer(state) {
    player.state = state;
    if (main.querySelector(".questions").contains(document.activeElement)) return;
    stage.querySelector(`[data-when='${state}'] button`).focus({ preventScroll: true });
  }

  /** Take the buttons away that play once more, where the study file says how often at most. */
  function allowAgain() {
    const isOver = viewsAllowed <= 0 && player.isWatched;
    for (const button of main.querySelectorAll("[data-when='watched'] [data-play], [data-again]")) {
      button.hidden = isOver;
    }
  }
}

function clipOf(text) {
  const [url, bytes] = text.split(" ");
  return { url, bytes: Number(bytes) };
}

function withinTime(verdict) {
  return Promise.race([verdict, new Promise((resolve) => setTimeout(resolve, VERDICT_MS))]);
}
