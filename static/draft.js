// What is filled in on one page and not yet sent: written down with every key, so that it survives a
// reload and a crash, and put back when the page opens again.

import { setValue, valueOf } from "./fields.js";
import { Keep } from "./keep.js";

export class Draft {
  /**
   * @param {string} session
   * @param {string} page  a name such as "trial-3"
   */
  constructor(session, page) {
    this.keep = new Keep(`ocularist.draft.${session}.${page}.`);
  }

  /** Write down every change in a form from now on. */
  follow(form) {
    const note = ({ target }) => {
      if (!target.name || target.type === "hidden") return;
      this.keep.set(target.name, valueOf(form, target.name));
    };
    for (const name of ["input", "change"]) form.addEventListener(name, note);
  }

  /** Note an answer that no event tells: one that was cleared. */
  note(name, value) {
    this.keep.set(name, value);
  }

  /** Put what was written down back into a form; returns the names of the questions that changed. */
  restore(form) {
    return this.keep.names().filter((name) => setValue(form, name, this.keep.get(name)));
  }

  /** The form was stored: nothing needs to be kept. */
  clear() {
    this.keep.clear();
  }
}
