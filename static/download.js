// One clip's bytes from the server: cut when nothing comes, checked by length and SHA-256.
//
// It knows nothing of memory, queues or pages.

import { codecOf } from "./codec.js";
import { Sha256 } from "./sha256.js";

export const STALL_MS = 20000; // without a byte for so long a download is cut

/**
 * Fetch a clip; its address ends in the SHA-256 of its file.
 * @param {{url: string, bytes: number}} clip
 * @param {{isAgain: boolean, isQuiet: () => Promise<void>, onBytes: (count: number) => void,
 *          signal: AbortSignal, stall_ms?: number}} options  `isQuiet` resolves whenever reading may
 *   go on: nothing is read while another clip is on the screen
 * @returns {Promise<{blob: Blob, sha256: string, codec: string}>}
 */
export async function download({ url, bytes }, options) {
  const watch = new StallWatch(options.stall_ms ?? STALL_MS, options.signal);
  try {
    // What a cache holds may be what was wrong: ask the server itself the second time.
    const cache = options.isAgain ? "reload" : "default";
    const answer = await fetch(url, { signal: watch.signal, cache });
    if (!answer.ok) throw refusal(answer.status);
    const parts = [];
    const hash = new Sha256();
    let count = 0;
    for (const reader = answer.body.getReader(); ; ) {
      watch.rest();
      await options.isQuiet();
      watch.wake();
      const { done, value } = await reader.read();
      if (done) break;
      parts.push(value);
      hash.update(value);
      count += value.byteLength;
      if (count > bytes) throw new Error(`LENGTH-${count}`);
      options.onBytes(count);
    }
    if (count !== bytes) throw new Error(`LENGTH-${count}`);
    const sha256 = hash.hex();
    if (!url.includes(sha256)) throw new Error("HASH");
    // The type matters: Safari does not play an untyped blob.
    const blob = new Blob(parts, { type: "video/mp4" });
    return { blob, sha256, codec: await codecOf(blob) };
  } catch (error) {
    throw watch.hasStalled ? new Error("STALL") : error;
  } finally {
    watch.rest();
  }
}

/** "Not there" does not change within seconds: let the participant decide when to try again. */
function refusal(status) {
  const isFinal = status >= 400 && status < 500 && status !== 408 && status !== 429;
  return Object.assign(new Error(`HTTP-${status}`), { isFinal });
}

/** Aborts when `wake` was called and nothing happened for a while. */
class StallWatch {
  constructor(stall_ms, outer) {
    this.stall_ms = stall_ms;
    this.controller = new AbortController();
    this.signal = this.controller.signal;
    this.hasStalled = false;
    if (outer.aborted) this.controller.abort();
    outer.addEventListener("abort", () => this.controller.abort(), { signal: this.signal });
    this.wake();
  }

  wake() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.hasStalled = true;
      this.controller.abort();
    }, this.stall_ms);
  }

  rest() {
    clearTimeout(this.timer);
  }
}
