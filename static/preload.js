// Clips in memory: the one that is shown and the next few, as typed blobs under object URLs.
//
// At most three downloads run at once; each is tried again with growing pauses; progress is counted in
// bytes. Nothing here waits for ever without saying so: after the last try the caller hears of it.

import { download } from "./download.js";

export const AHEAD = 3; // so many clips are held beside the one that is shown
const AT_ONCE = 3;
const PAUSES_MS = [500, 1500, 4000]; // then it is given up

/** @typedef {{url: string, bytes: number}} Clip */
/** @typedef {{address: string, sha256: string, codec: string}} Held  address: of the blob */

export class ClipStore {
  /** @param {{stall_ms?: number, pauses_ms?: number[]}} times */
  constructor({ stall_ms, pauses_ms = PAUSES_MS } = {}) {
    this.stall_ms = stall_ms;
    this.pauses_ms = pauses_ms;
    this.held = new Map(); // url -> {held: Promise<Held>, stop: AbortController}
    this.loaded = new Map(); // url -> bytes so far
    this.queue = [];
    this.running = 0;
    this.quiet = Promise.resolve();
    this.onProgress = () => {};
  }

  /** Load a clip, or return the load that already runs. Rejects after the last try. */
  load(clip) {
    const { url } = clip;
    if (!this.held.has(url)) {
      const stop = new AbortController();
      const held = new Promise((resolve, reject) =>
        this.queue.push({ clip, signal: stop.signal, resolve, reject }),
      );
      const entry = { held, stop };
      // A failed load may be asked for again.
      held.catch(() => this.held.get(url) === entry && this.held.delete(url));
      this.held.set(url, entry);
      this.next();
    }
    return this.held.get(url).held;
  }

  /** Load a clip before all others that still wait in line. */
  loadFirst(clip) {
    const place = this.queue.findIndex((waiting) => waiting.clip.url === clip.url);
    if (place > 0) this.queue.unshift(...this.queue.splice(place, 1));
    return this.load(clip);
  }

  /** Hold these clips and no others: the memory of the rest is given back. */
  keepOnly(clips) {
    const wanted = new Set(clips.map((clip) => clip.url));
    for (const url of [...this.held.keys()]) if (!wanted.has(url)) this.forget(url);
  }

  /** Give the memory of a clip back, or stop its download. */
  forget(url) {
    const entry = this.held.get(url);
    if (!entry) return;
    this.held.delete(url);
    this.loaded.delete(url);
    this.queue = this.queue.filter((job) => job.signal !== entry.stop.signal);
    entry.stop.abort();
    entry.held.then(
      ({ address }) => URL.revokeObjectURL(address),
      () => {},
    );
  }

  /** Read nothing more until the returned function is called: a clip is on the screen. */
  hush() {
    let release;
    this.quiet = new Promise((resolve) => (release = resolve));
    return release;
  }

  /** Bytes received so far of these clips. */
  bytesOf(clips) {
    return clips.reduce((sum, clip) => sum + (this.loaded.get(clip.url) ?? 0), 0);
  }

  next() {
    while (this.running < AT_ONCE && this.queue.length) {
      const job = this.queue.shift();
      this.running += 1;
      this.fetchPatiently(job)
        .then(job.resolve, job.reject)
        .finally(() => {
          this.running -= 1;
          this.next();
        });
    }
  }

  async fetchPatiently({ clip, signal }) {
    for (let attempt = 1; ; attempt += 1) {
      try {
        const { blob, ...facts } = await download(clip, {
          isAgain: attempt > 1,
          isQuiet: () => this.quiet,
          onBytes: (count) => signal.aborted || this.progress(clip.url, count),
          signal,
          stall_ms: this.stall_ms,
        });
        return { ...facts, address: URL.createObjectURL(blob) };
      } catch (error) {
        if (signal.aborted) throw error;
        this.progress(clip.url, 0);
        if (attempt > this.pauses_ms.length || error.isFinal) throw error;
        // Not all browsers of a room at the same moment.
        const pause_ms = this.pauses_ms[attempt - 1] * (0.75 + Math.random() / 2);
        await new Promise((resolve) => setTimeout(resolve, pause_ms));
      }
    }
  }

  progress(url, count) {
    this.loaded.set(url, count);
    this.onProgress();
  }
}
