// A pause between clips: its form is sent without leaving the document, so that loaded clips stay.

import { submitPatiently } from "./navigate.js";
import { Questionnaire } from "./questionnaire.js";

export function startPause(main, { start }) {
  const form = main.querySelector("form");
  new Questionnaire(form, { save: () => {} }); // one answer, sent with the form
  let isSent = false;
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    if (isSent) return;
    isSent = true;
    form.querySelector("[type=submit]").setAttribute("aria-disabled", "true");
    await submitPatiently(form, start);
  });
}
