// The outbox: what a participant did, kept in this browser until the server says it is stored.
//
// It survives reload, crash and hours without a connection (localStorage), sends in order, one at a
// time, and each entry carries a key that lets the server store it once however often it arrives.
// It knows nothing of pages or questions.

const RETRY_MS = [500, 1000, 2000, 4000, 8000];
// Answers after which trying again is pointless: malformed, out of step, or the person withdrew. All
// others may pass: no connection, a server that starts, a cookie that a personal link brings back.
const NEVER = new Set([400, 409, 410, 422]);

/** A random name of 32 hexadecimal digits; randomUUID is absent on plain http under a host name. */
export function newKey() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

export class Outbox {
  /**
   * @param {string} session  public name of the session; one browser may hold several
   * @param {{url: string, csrf: string, onChange: (state: {waiting: number, failed: boolean}) => void,
   *          onRefused: (entry: object, answer: Response) => void}} options
   */
  constructor(session, options) {
    this.name = `ocularist.outbox.${session}`;
    this.options = options;
    this.failed = false;
    this.sending = null;
    this.waiters = [];
    addEventListener("online", () => this.send());
  }

  /** Entries not yet acknowledged, oldest first. */
  entries() {
    try {
      return JSON.parse(localStorage.getItem(this.name)) ?? [];
    } catch {
      return this.memory ?? [];
    }
  }

  write(entries) {
    this.memory = entries;
    try {
      if (entries.length) localStorage.setItem(this.name, JSON.stringify(entries));
      else localStorage.removeItem(this.name);
    } catch {
      // Storage forbidden or full: the entries live in memory, and the page still says "not saved".
    }
    this.options.onChange({ waiting: entries.length, failed: this.failed });
  }

  /** Keep an entry and start sending. An unsent entry about the same thing is replaced. */
  add(entry, about = null) {
    const kept = this.entries().filter(
      (other) => about === null || other.about !== about || other.key === this.inFlight,
    );
    kept.push({ ...entry, key: newKey(), about, at: new Date().toISOString() });
    this.write(kept);
    this.send();
  }

  /** Resolve once nothing waits; never rejects: without a connection it simply takes longer. */
  async settled() {
    if (!this.entries().length) return;
    const done = new Promise((resolve) => this.waiters.push(resolve));
    this.send();
    await done;
  }

  send() {
    this.wake?.();
    this.sending ??= this.drain().finally(() => {
      this.sending = null;
    });
    return this.sending;
  }

  async drain() {
    let tries = 0;
    for (let entry = this.entries()[0]; entry; entry = this.entries()[0]) {
      if (await this.deliver(entry)) {
        tries = 0;
        this.failed = false;
        this.write(this.entries().filter((other) => other.key !== entry.key));
      } else {
        this.failed = true;
        this.options.onChange({ waiting: this.entries().length, failed: true });
        await this.pause(RETRY_MS[Math.min(tries++, RETRY_MS.length - 1)]);
      }
    }
    this.options.onChange({ waiting: 0, failed: false });
    for (const resolve of this.waiters.splice(0)) resolve();
  }

  /** True when the server has the entry or will never take it; false to try again. */
  async deliver(entry) {
    this.inFlight = entry.key;
    try {
      const { about, ...body } = entry;
      const answer = await fetch(this.options.url, {
        method: "POST",
        headers: { "Content-Type": "application/json", "X-CSRF-Token": this.options.csrf },
        body: JSON.stringify(body),
        keepalive: true,
      });
      await answer.arrayBuffer(); // the whole answer, or else it did not arrive
      if (answer.ok && !answer.redirected) return true;
      if (!NEVER.has(answer.status)) return false;
      this.options.onRefused(entry, answer);
      return true;
    } catch {
      return false;
    } finally {
      this.inFlight = null;
    }
  }

  pause(delay_ms) {
    return new Promise((resolve) => {
      const timer = setTimeout(resolve, delay_ms);
      this.wake = () => {
        clearTimeout(timer);
        resolve();
      };
    });
  }
}
