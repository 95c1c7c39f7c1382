// The outbox: what a participant did, kept in this browser until the server says it is stored.
//
// It survives reload, crash and hours without a connection (localStorage), sends in order, one at a
// time and from one tab, and each entry carries a key that lets the server store it once however
// often it arrives. It knows nothing of pages or questions.

import { deliver } from "./delivery.js";
import { Keep } from "./keep.js";
import { newKey } from "./key.js";

const RETRY_MS = [500, 1000, 2000, 4000, 8000, 15000, 30000];
// Answers replace each other and are always kept; plays and problems are bounded, should somebody
// watch a clip over and over without a connection.
const MOST_NEWS = 300;

export class Outbox {
  /**
   * @param {string} session  public name of the session; one browser may hold several
   * @param {{url: string, csrf: string, owner?: string, mayWrite?: () => boolean,
   *          onChange: (state: {waiting: number, failed: boolean, unkept: boolean}) => void,
   *          onRefused: (entry: object, status: number) => void}} options
   *   mayWrite: whether this tab is the one that sends
   */
  constructor(session, options) {
    this.options = options;
    this.keep = new Keep(`ocularist.outbox.${session}.`);
    this.last = 0;
    this.failed = false;
    this.sending = null;
    this.waiters = [];
    this.onStored = () => {};
    addEventListener("online", () => this.send());
  }

  /** Entries not yet acknowledged, oldest first. */
  entries() {
    return this.keep.names().map((name) => this.keep.get(name)).filter(Boolean);
  }

  /** Keep an entry and start sending; returns its key. It replaces unsent ones about the same thing. */
  add(entry, about = null) {
    const key = newKey();
    const waiting = this.keep.names();
    if (entry.kind !== "answer" && waiting.length >= MOST_NEWS) return key;
    const older = about === null ? [] : waiting.filter((name) => this.isAbout(name, about));
    const kept = { ...entry, key, about, at: new Date().toISOString() };
    // First the new, then away with the old: a crash in between costs nothing.
    this.keep.set(this.nameFor(waiting, key), kept);
    for (const name of older) this.keep.remove(name);
    this.tell();
    this.send();
    return key;
  }

  isAbout(name, about) {
    const entry = this.keep.get(name);
    return entry !== null && entry.about === about && entry.key !== this.inFlight;
  }

  /** Names sort in the order in which entries were added, whatever the clock does. */
  nameFor(waiting, key) {
    const newest = Number(waiting.at(-1)?.split("-")[0] ?? 0);
    this.last = Math.max(Date.now(), this.last + 1, newest + 1);
    return `${String(this.last).padStart(15, "0")}-${key}`;
  }

  /** Resolve once nothing waits; never rejects: without a connection it simply takes longer. */
  async settled() {
    if (!this.keep.names().length) return;
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
    for (let [name] = this.keep.names(); name; [name] = this.keep.names()) {
      const wait_ms = await this.sendOne(name);
      this.failed = wait_ms !== null;
      this.tell();
      if (wait_ms === null) {
        tries = 0;
        continue;
      }
      const pause_ms = RETRY_MS[Math.min(tries++, RETRY_MS.length - 1)];
      // Not all browsers of a room at the same moment.
      await this.pause(Math.max(wait_ms, pause_ms * (0.75 + Math.random() / 2)));
    }
    this.failed = false;
    this.tell();
    for (const resolve of this.waiters.splice(0)) resolve();
  }

  /** Returns null once an entry is done with, else for how long to wait at least. */
  async sendOne(name) {
    if (this.options.mayWrite?.() === false) return 1000; // another tab sends
    const entry = this.keep.get(name);
    if (!entry?.key) {
      this.keep.remove(name); // nothing that this program wrote
      return null;
    }
    this.inFlight = entry.key;
    const { about, ...body } = entry;
    const { isDone, status, told, wait_ms } = await deliver(this.options, body);
    this.inFlight = null;
    if (!isDone) return wait_ms;
    this.keep.remove(name);
    if (told) this.onStored(entry, told);
    else this.options.onRefused(entry, status);
    return null;
  }

  /** True while something would be lost with the page. */
  get isAtRisk() {
    return this.keep.memory.size > 0;
  }

  tell() {
    const waiting = this.keep.names().length;
    this.options.onChange({ waiting, failed: this.failed, unkept: this.isAtRisk });
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
