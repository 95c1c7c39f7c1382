// Clips into memory: fetch -> length check -> typed Blob -> object URL.
//
// At most three downloads run at once; each is tried again with growing pauses; progress is reported
// in bytes. Nothing here can wait for ever without saying so: a download that brings no byte for
// STALL_MS is cut and tried again, and after the last try the caller hears of it.

const AT_ONCE = 3;
const TRIES = 4;
const STALL_MS = 20000;
const PAUSES_MS = [500, 1500, 4000];

export class ClipStore {
  constructor() {
    this.clips = new Map(); // url -> Promise<string> (object URL)
    this.loaded = new Map(); // url -> bytes so far
    this.queue = [];
    this.running = 0;
    this.onProgress = () => {};
  }

  /** Load a clip, or return the load that already runs. Rejects after the last try. */
  load({ url, bytes }) {
    if (!this.clips.has(url)) {
      const load = new Promise((resolve, reject) => this.queue.push({ url, bytes, resolve, reject }));
      load.catch(() => this.clips.delete(url)); // a failed load may be asked for again
      this.clips.set(url, load);
      this.next();
    }
    return this.clips.get(url);
  }

  /** Load a clip before all others that still wait in line. */
  loadFirst(clip) {
    const place = this.queue.findIndex((waiting) => waiting.url === clip.url);
    if (place > 0) this.queue.unshift(...this.queue.splice(place, 1));
    return this.load(clip);
  }

  /** Give the memory of a clip back. */
  forget(url) {
    this.clips.get(url)?.then(URL.revokeObjectURL, () => {});
    this.clips.delete(url);
    this.loaded.delete(url);
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

  async fetchPatiently(job) {
    for (let attempt = 1; ; attempt += 1) {
      try {
        return await this.fetchOnce(job);
      } catch (error) {
        this.progress(job.url, 0);
        if (attempt === TRIES || error.isFinal) throw error;
        await new Promise((resolve) => setTimeout(resolve, PAUSES_MS[attempt - 1]));
      }
    }
  }

  async fetchOnce({ url, bytes }) {
    const controller = new AbortController();
    let timer = setTimeout(() => controller.abort(), STALL_MS);
    try {
      const answer = await fetch(url, { signal: controller.signal });
      if (!answer.ok) {
        // "Not there" does not change within seconds: let the participant decide when to try again.
        const isFinal = answer.status >= 400 && answer.status < 500;
        throw Object.assign(new Error(`HTTP-${answer.status}`), { isFinal });
      }
      const parts = [];
      let count = 0;
      for (const reader = answer.body.getReader(); ; ) {
        const { done, value } = await reader.read();
        if (done) break;
        clearTimeout(timer);
        timer = setTimeout(() => controller.abort(), STALL_MS);
        parts.push(value);
        count += value.byteLength;
        this.progress(url, count);
      }
      if (count !== bytes) throw new Error(`LENGTH-${count}`);
      // The type matters: Safari does not play an untyped blob.
      return URL.createObjectURL(new Blob(parts, { type: "video/mp4" }));
    } finally {
      clearTimeout(timer);
    }
  }

  progress(url, count) {
    this.loaded.set(url, count);
    this.onProgress();
  }
}
