// The record of one play: what this browser can tell of its frames, its time, its window.
//
// It judges nothing: the site does, by the study's rule (study/design/certificate.py). Frames are
// counted by requestVideoFrameCallback, whose presentedFrames goes on where callbacks were missed;
// in Firefox, where it goes on with every frame that was decoded, by the callbacks themselves; where
// there are none by the differences of the playback quality, which is cumulative.

import { clockStep_ms } from "./clock.js";
import { Intervals } from "./intervals.js";
import { isFirefox } from "./measures.js";
import { isWindowed, screenFacts } from "./screen.js";

const isOnGrid = (edge_px) => Math.abs(edge_px - Math.round(edge_px)) < 0.05;

/** How much of a box lies inside the window, from 0 to 1. */
function visibleShare(box) {
  const width = Math.min(box.right, innerWidth) - Math.max(box.left, 0);
  const height = Math.min(box.bottom, innerHeight) - Math.max(box.top, 0);
  return (Math.max(0, width) * Math.max(0, height)) / (box.width * box.height);
}

const round = (value, digits = 1) => Math.round(value * 10 ** digits) / 10 ** digits;

/**
 * What counts the frames of a video here: "frames", "callbacks", "quality", or nothing. Firefox (from
 * 132) numbers frames in presentedFrames whether they reached the screen or not: drawing ten times a
 * second it told of every frame of a clip of thirty.
 */
function counter(video) {
  if (video.requestVideoFrameCallback) return isFirefox() ? "callbacks" : "frames";
  return video.getVideoPlaybackQuality ? "quality" : "";
}

export class PlayRecord {
  /**
   * @param {HTMLVideoElement} video  at its first frame, not yet playing
   * @param {{frames: number, decoded: number, onFirstFrame: (shown_ms: number) => void}} options
   *   decoded: the element's totalVideoFrames before any frame of this play was decoded
   */
  constructor(video, options) {
    this.video = video;
    this.options = options;
    this.stop = new AbortController();
    this.started_at = new Date().toISOString();
    this.begun_ms = performance.now();
    this.quality = video.getVideoPlaybackQuality?.();
    this.counted_by = counter(video);
    this.first = null;
    this.last = null;
    this.callbacks = 0;
    this.max_gap_ms = 0;
    this.counts = { stalls: 0, seeks: 0, pauses: 0, resizes: 0 };
    this.stalled = new Intervals(false);
    this.hidden = new Intervals(document.hidden);
    this.unfocused = new Intervals(!document.hasFocus());
    this.windowed = new Intervals(isWindowed());
    this.visible_share = 1;
    this.rates = [video.playbackRate];
    this.shown = this.seen = this.shownSize();
    this.listen();
    if (video.requestVideoFrameCallback) this.countFrames();
    else video.addEventListener("timeupdate", () => this.begin(performance.now()), this.once());
  }

  get elapsed_ms() {
    return performance.now() - this.begun_ms;
  }

  once() {
    return { once: true, signal: this.stop.signal };
  }

  listen() {
    const on = (target, name, act) => target.addEventListener(name, act, { signal: this.stop.signal });
    const { video, counts } = this;
    on(document, "visibilitychange", () => this.hidden.set(document.hidden, this.elapsed_ms));
    on(window, "blur", () => this.unfocused.set(!document.hasFocus(), this.elapsed_ms));
    on(window, "focus", () => this.unfocused.set(false, this.elapsed_ms));
    on(document, "fullscreenchange", () => this.windowed.set(isWindowed(), this.elapsed_ms));
    on(window, "resize", () => {
      this.windowed.set(isWindowed(), this.elapsed_ms);
      this.checkSize();
    });
    on(video, "waiting", () => {
      if (this.first === null) return; // before the first frame nothing stands still
      counts.stalls += 1;
      this.stalled.set(true, this.elapsed_ms);
    });
    for (const name of ["playing", "timeupdate", "ended"]) {
      on(video, name, () => this.stalled.set(false, this.elapsed_ms));
    }
    on(video, "seeking", () => (counts.seeks += 1));
    on(video, "pause", () => (counts.pauses += video.ended ? 0 : 1));
    on(video, "ratechange", () => this.rates.push(video.playbackRate));
  }

  // The clip's first frame is presented when it is loaded or wound back, under the curtain and long
  // before the others: it says nothing of the play. The rule allows for it.
  countFrames() {
    this.video.requestVideoFrameCallback((now, frame) => {
      if (this.stop.signal.aborted) return;
      this.countFrames();
      if (frame.mediaTime < this.video.duration / this.options.frames / 2) return;
      if (frame.mediaTime !== this.last?.mediaTime) this.callbacks += 1;
      this.checkSize();
      if (this.last) {
        const gap_ms = frame.presentationTime - this.last.presentationTime;
        this.max_gap_ms = Math.max(this.max_gap_ms, gap_ms);
      } else {
        this.first = frame;
        this.begin(frame.presentationTime);
      }
      this.last = frame;
    });
  }

  begin(shown_ms) {
    this.first ??= { presentationTime: shown_ms, mediaTime: this.video.currentTime };
    if (this.hasBegun) return;
    this.hasBegun = true;
    this.options.onFirstFrame(shown_ms);
  }

  /** Count every change of the shown size, whatever made it, and see what the window cuts off. */
  checkSize() {
    const now = this.shownSize();
    const by_px = (name) => Math.abs(now[name] - this.seen[name]);
    if (by_px("width_px") + by_px("height_px") > 0.5) this.counts.resizes += 1;
    this.seen = now;
    this.visible_share = Math.min(this.visible_share, visibleShare(now.box));
  }

  /** The video's size in device pixels. */
  shownSize() {
    const box = this.video.getBoundingClientRect();
    return { width_px: box.width * devicePixelRatio, height_px: box.height * devicePixelRatio, box };
  }

  /** End the record; `endedBy` is "end" for a play to the end. Call it once. */
  finish(endedBy) {
    this.stop.abort();
    this.checkSize();
    const { video, first, last } = this;
    const now_ms = this.elapsed_ms;
    const after = this.quality && video.getVideoPlaybackQuality();
    const dropped = after ? after.droppedVideoFrames - this.quality.droppedVideoFrames : null;
    const total = after ? after.totalVideoFrames - this.options.decoded : null;
    const { box, width_px, height_px } = this.shown;
    const ratio = devicePixelRatio;
    return {
      record_version: 3,
      is_complete: endedBy === "end",
      ended_by: endedBy,
      was_hidden: endedBy === "hidden" || this.hidden.total_ms > 0,
      started_at: this.started_at,
      counted_by: this.counted_by,
      expected_frames: this.options.frames,
      presented_frames: this.presented(total, dropped),
      dropped_frames: dropped,
      callbacks: this.callbacks,
      max_gap_ms: last ? round(this.max_gap_ms) : null,
      wall_ms: last ? round(last.presentationTime - first.presentationTime) : null,
      media_ms: last ? round((last.mediaTime - first.mediaTime) * 1000) : null,
      ...this.counts,
      ...this.stalled.facts("stalled", now_ms),
      ...this.hidden.facts("hidden", now_ms),
      ...this.unfocused.facts("unfocused", now_ms),
      ...this.windowed.facts("windowed", now_ms),
      min_rate: Math.min(...this.rates, video.playbackRate),
      max_rate: Math.max(...this.rates, video.playbackRate),
      shown_width_px: round(width_px, 2),
      shown_height_px: round(height_px, 2),
      shown_scale: round(width_px / video.videoWidth, 4),
      visible_share: round(this.visible_share, 4),
      is_on_grid: isOnGrid(box.left * ratio) && isOnGrid(box.top * ratio),
      is_ratio_whole: Number.isInteger(ratio),
      clock_ms: clockStep_ms(),
      is_secure: isSecureContext,
      ...screenFacts(),
    };
  }

  presented(total, dropped) {
    if (this.counted_by === "quality") return Math.min(total - dropped, this.options.frames);
    if (this.counted_by === "callbacks") return this.last && this.callbacks;
    return this.last ? this.last.presentedFrames - this.first.presentedFrames + 1 : null;
  }
}
