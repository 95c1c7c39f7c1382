// A shared computer: the next person may begin once nothing of the last one waits in this browser.

/** Start the page; returns the function that ends it. */
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
