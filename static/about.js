// The page about the participant: what is typed is kept at once, and sent as a whole at the end.

import { Draft } from "./draft.js";
import { submitPatiently } from "./navigate.js";
import { Questionnaire } from "./questionnaire.js";

/** Start the page; returns the function that ends it. */
export function startAbout(main, { outbox, start }) {
  const form = main.querySelector("form");
  const draft = new Draft(document.body.dataset.session, "about");
  const save = (question, value) => {
    draft.note(question, value);
    outbox.add({ kind: "answer", question, value }, `about/${question}`);
  };
  const questions = new Questionnaire(form, { save });
  draft.follow(form);
  for (const name of draft.restore(form)) save(name, questions.value(name));
  questions.applyRules();
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    if (form.dataset.sending) return;
    form.dataset.sending = "yes";
    questions.flush();
    await outbox.settled();
    await submitPatiently(form, start, {
      onWaiting: () => outbox.options.onChange({ waiting: 1, failed: true }),
      onLeave: () => draft.clear(),
    });
  });
  return () => {};
}
