// One tab at a time: a lease in localStorage says which tab of this browser takes part.
//
// Web Locks are not there on plain http under a host name. The tab that holds the lease renews it; a
// tab that crashed loses it within LEASE_MS; a reload keeps it, because the tab's name goes along.

import { newKey } from "./key.js";

const LEASE_MS = 5000;
const RENEW_MS = 1000;
const RELOAD_MS = 4000; // so long a tab that is left may take to come back
const TAB = "ocularist.tab";

export class Tab {
  /**
   * @param {string} session
   * @param {{onLost: () => void, onFree: () => void}} options  lost: another tab took the lease;
   *   free: the tab that held it is gone
   */
  constructor(session, options) {
    this.key = `ocularist.lease.${session}`;
    this.options = options;
    this.isHolder = false;
    this.name = ownName();
    setInterval(() => this.look(), RENEW_MS);
    addEventListener("storage", (event) => event.key === this.key && this.look());
    addEventListener("pagehide", () => this.leave());
  }

  /** Take the lease if no other tab holds it; returns whether this tab holds it now. */
  claim() {
    const isFree = !this.isOthers(this.read());
    if (isFree) this.take();
    return isFree;
  }

  /** Take the lease, whoever holds it. */
  take() {
    this.isHolder = true;
    this.write(LEASE_MS);
  }

  isOthers(held) {
    if (!held || held.name === this.name) return false;
    const left_ms = held.until - Date.now();
    return left_ms >= 0 && left_ms <= LEASE_MS; // more than a whole lease: the clock was set back
  }

  look() {
    const isOther = this.isOthers(this.read());
    if (this.isHolder && isOther) {
      this.isHolder = false;
      this.options.onLost();
    } else if (this.isHolder) {
      this.write(LEASE_MS);
    } else if (!isOther) {
      this.options.onFree();
    }
  }

  leave() {
    if (!this.isHolder) return;
    this.write(RELOAD_MS);
    try {
      sessionStorage.setItem(TAB, this.name);
    } catch {
      // Forbidden: the lease runs out by itself.
    }
  }

  read() {
    try {
      return JSON.parse(localStorage.getItem(this.key));
    } catch {
      return null; // no storage, so no other tab can be known
    }
  }

  write(for_ms) {
    try {
      localStorage.setItem(this.key, JSON.stringify({ name: this.name, until: Date.now() + for_ms }));
    } catch {
      // No storage: every tab works for itself; the server stores each entry once all the same.
    }
  }
}

/** The name that this tab had before a reload. A duplicated tab copies no name: it was taken out. */
function ownName() {
  try {
    const name = sessionStorage.getItem(TAB);
    sessionStorage.removeItem(TAB);
    return name ?? newKey();
  } catch {
    return newKey();
  }
}
