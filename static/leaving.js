// Leaving: a browser lets go of its participant only once nothing of theirs waits in it.

/** Start the page of a shared computer; returns the function that ends it. */
export function startNext(main, { outbox }) {
  const form = main.querySelector("form");
  const say = (state) => {
    for (const part of main.querySelectorAll("[data-when]")) {
      part.hidden = part.dataset.when !== state;
    }
    form.querySelector("button").disabled = state !== "safe";
  };
  const settle = async () => {
    if (outbox?.entries().length) say("waiting");
    await outbox?.settled();
    say("safe");
  };
  form.addEventListener("submit", () => sessionStorage.clear());
  settle();
  return () => {};
}

/** Start the page on which people stop; returns the function that ends it. */
export function startStop(main, { outbox }) {
  for (const form of main.querySelectorAll("form")) {
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      if (form.dataset.sending) return;
      form.dataset.sending = "yes";
      await outbox?.settled();
      form.submit();
    });
  }
  return () => {};
}
