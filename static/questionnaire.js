// The questions of a form: every answer is handed on the moment it is given.

import { valueOf, clearField } from "./fields.js";

const TYPING_PAUSE_MS = 700;

export class Questionnaire {
  /**
   * @param {HTMLFormElement} form
   * @param {{save: (question: string, value: string | string[]) => void}} options
   */
  constructor(form, options) {
    this.form = form;
    this.save = options.save;
    this.typing = new Map();
    form.addEventListener("change", (event) => this.changed(event.target));
    form.addEventListener("input", (event) => this.typed(event.target));
    this.applyRules();
    for (const button of form.querySelectorAll("[data-clear]")) {
      button.addEventListener("click", () => this.clear(button.dataset.clear));
    }
    for (const line of form.querySelectorAll("[data-line]")) this.follow(line);
  }

  /** Open the questions; they are locked until the clip was watched to its end. */
  unlock() {
    this.form.querySelector("fieldset.all").disabled = false;
    this.form.closest("section").querySelector("[data-locked-note]").textContent = "";
    this.applyRules();
  }

  /** What a question is answered with now: a text, or a list of what is ticked. */
  value(name) {
    return valueOf(this.form, name);
  }

  changed(field) {
    if (!field.name || (field.type === "hidden" && !this.lineOf(field.name))) return;
    if (field.type === "checkbox") untickOthers(field);
    this.applyRules();
    clearTimeout(this.typing.get(field.name));
    this.typing.delete(field.name);
    this.save(field.name, this.value(field.name));
  }

  /** Text is saved while it is typed, a moment after the last key. */
  typed(field) {
    if (field.type !== "text" && field.tagName !== "TEXTAREA") return;
    clearTimeout(this.typing.get(field.name));
    this.typing.set(
      field.name,
      setTimeout(() => this.changed(field), TYPING_PAUSE_MS),
    );
  }

  /** A line to mark holds no answer until it is touched; Space marks it where it stands. */
  follow(line) {
    const mark = () => {
      this.form.elements.namedItem(line.dataset.line).value = line.value;
      showMark(line, line.value);
    };
    line.addEventListener("input", mark);
    line.addEventListener("pointerup", mark);
    line.addEventListener("keydown", (event) => {
      if (event.key !== " ") return;
      event.preventDefault();
      mark();
      line.dispatchEvent(new Event("change", { bubbles: true }));
    });
    line.addEventListener("change", () => this.changed(this.form.elements.namedItem(line.dataset.line)));
  }

  lineOf(name) {
    return this.form.querySelector(`[data-line="${name}"]`);
  }

  /** Show a question only after the answers that call for it; what it holds stays. */
  applyRules() {
    for (const part of this.form.querySelectorAll("[data-shown-by]")) {
      part.hidden = !isCalledFor(part.dataset, this.value(part.dataset.shownBy));
    }
    for (const line of this.form.querySelectorAll("[data-line]")) {
      showMark(line, this.form.elements.namedItem(line.dataset.line).value);
    }
  }

  clear(name) {
    clearField(this.form, name);
    (this.lineOf(name) ?? this.form.querySelector(`input[name="${name}"]`))?.focus();
    this.applyRules();
    this.save(name, this.value(name));
  }

  /** Save text whose pause has not passed yet. */
  flush() {
    for (const name of [...this.typing.keys()]) this.changed(this.form.elements.namedItem(name));
  }

  /** Questions without an answer, by their names; text may stay empty silently. */
  open() {
    const fields = this.form.querySelectorAll("[data-expected]");
    const seen = [...fields].filter((field) => !field.closest("[hidden]"));
    return seen.map((field) => field.dataset.expected).filter((name) => !this.value(name).length);
  }
}

/** Say whether a question is to be shown after this answer to the one that its rule names. */
function isCalledFor({ shownFor, shownFrom, shownTo }, answer) {
  const given = [answer].flat().filter(Boolean);
  if (shownFor !== undefined) {
    const values = JSON.parse(shownFor).map(String);
    return given.some((value) => values.includes(value));
  }
  const number = given.length ? Number(given[0].replace(",", ".")) : NaN;
  return number >= Number(shownFrom ?? -Infinity) && number <= Number(shownTo ?? Infinity);
}

/** "None of these" stands alone: it and the others untick each other. */
function untickOthers(field) {
  if (!field.checked) return;
  for (const other of field.form.elements) {
    if (other === field || other.name !== field.name || other.type !== "checkbox") continue;
    if ("alone" in field.dataset || "alone" in other.dataset) other.checked = false;
  }
}

/** Show a line with its mark at a value, or without one. */
function showMark(line, value) {
  line.classList.toggle("unmarked", value === "");
  if (value === "") line.setAttribute("aria-valuetext", line.dataset.unmarked);
  else {
    line.value = value;
    line.removeAttribute("aria-valuetext");
  }
}
