// What is filled in on one page and not yet sent: written down with every key, so that it survives a
// reload and a crash, and put back when the page opens again.

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
      this.keep.set(target.name, target.type === "checkbox" ? target.checked : target.value);
    };
    for (const name of ["input", "change"]) form.addEventListener(name, note);
  }

  /** Note an answer that no event tells: one that was cleared. */
  note(name, value) {
    this.keep.set(name, value);
  }

  /** Put what was written down back into a form; returns the names of the questions that changed. */
  restore(form) {
    return this.keep.names().filter((name) => putBack(form, name, this.keep.get(name)));
  }

  /** The form was stored: nothing needs to be kept. */
  clear() {
    this.keep.clear();
  }
}

function putBack(form, name, value) {
  const field = form.elements.namedItem(name);
  if (!field || value === null) return false;
  if (field instanceof HTMLInputElement && field.type === "checkbox") {
    const isNew = field.checked !== value;
    field.checked = value;
    return isNew;
  }
  if (field.value === value) return false;
  field.value = value; // a list of radio buttons checks the one of this value
  if (value === "" && field instanceof RadioNodeList) for (const one of field) one.checked = false;
  return field.value === value;
}
