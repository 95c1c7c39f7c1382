// The questions below a clip: every answer goes to the outbox the moment it is given.

const TYPING_PAUSE_MS = 700;

export class Questionnaire {
  /**
   * @param {HTMLFormElement} form
   * @param {{save: (question: string, value: string) => void}} options
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
  }

  /** Open the questions; they are locked until the clip was watched to its end. */
  unlock() {
    this.form.querySelector("fieldset.all").disabled = false;
    this.form.closest("section").querySelector("[data-locked-note]").textContent = "";
    this.applyRules();
  }

  changed(field) {
    if (!field.name || field.type === "hidden") return;
    this.applyRules();
    clearTimeout(this.typing.get(field.name));
    this.typing.delete(field.name);
    this.save(field.name, field.value);
  }

  /** Text is saved while it is typed, a moment after the last key. */
  typed(field) {
    if (field.type !== "text" && field.type !== "number" && field.tagName !== "TEXTAREA") return;
    clearTimeout(this.typing.get(field.name));
    this.typing.set(
      field.name,
      setTimeout(() => this.changed(field), TYPING_PAUSE_MS),
    );
  }

  /** Show a question only after the answers that call for it; what it holds stays. */
  applyRules() {
    const given = new FormData(this.form);
    for (const part of this.form.querySelectorAll("[data-shown-by]")) {
      const { shownBy, shownFor } = part.dataset;
      part.hidden = !shownFor.split("|").includes(given.get(shownBy) ?? "");
    }
  }

  clear(name) {
    for (const field of this.form.elements) {
      if (field.name === name) field.checked = false;
    }
    this.form.querySelector(`input[name="${name}"]`)?.focus();
    this.applyRules();
    this.save(name, "");
  }

  /** Save text whose pause has not passed yet. */
  flush() {
    for (const name of [...this.typing.keys()]) this.changed(this.form.elements.namedItem(name));
  }

  /** Questions without an answer, by their number of fields; text may stay empty silently. */
  open() {
    const given = new FormData(this.form);
    const names = new Set(
      Array.from(
        this.form.querySelectorAll("[data-expected]:not([hidden])"),
        (field) => field.dataset.expected,
      ),
    );
    return [...names].filter((name) => !given.get(name));
  }
}
