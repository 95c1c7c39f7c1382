// Small things that this browser keeps under one prefix, one key each: adding or removing one is a
// single step, so two tabs cannot overwrite each other. Where storage is forbidden or full they live
// in memory for as long as the page does, and whoever keeps them is told.

export class Keep {
  /** @param {string} prefix  such as "ocularist.outbox.P-1234." */
  constructor(prefix) {
    this.prefix = prefix;
    this.memory = new Map();
  }

  /** Keep a value under a name; true if it will survive this page. */
  set(name, value) {
    try {
      localStorage.setItem(this.prefix + name, JSON.stringify(value));
      this.memory.delete(name);
      return true;
    } catch {
      this.memory.set(name, value);
      return false;
    }
  }

  /** Return what was kept, or null. */
  get(name) {
    if (this.memory.has(name)) return this.memory.get(name);
    try {
      return JSON.parse(localStorage.getItem(this.prefix + name));
    } catch {
      return null;
    }
  }

  remove(name) {
    this.memory.delete(name);
    try {
      localStorage.removeItem(this.prefix + name);
    } catch {
      // Forbidden: then nothing was written either.
    }
  }

  /** All names, in order. */
  names() {
    const found = new Set(this.memory.keys());
    try {
      for (const key of Object.keys(localStorage)) {
        if (key.startsWith(this.prefix)) found.add(key.slice(this.prefix.length));
      }
    } catch {
      // Forbidden: what is kept is in memory.
    }
    return [...found].sort();
  }

  clear() {
    for (const name of this.names()) this.remove(name);
  }
}
