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

const LEAVING = "ocularist.leaving"; // whose traces go once the site says that they have withdrawn

/** Start the page on which people stop; returns the function that ends it. */
export function startStop(main, { outbox }) {
  for (const form of main.querySelectorAll("form")) {
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      if (form.dataset.sending) return;
      form.dataset.sending = "yes";
      if (form.elements.choice?.value === "remove") markLeaving();
      else await outbox?.settled(); // what is to be removed need not arrive first
      form.submit();
    });
  }
  return () => {};
}

function markLeaving() {
  try {
    sessionStorage.setItem(LEAVING, document.body.dataset.session);
  } catch {
    // Storage forbidden: then nothing was kept here either.
  }
}

/** Start the page after a withdrawal: this browser, too, forgets what it kept of the person. */
export function startWithdrawn() {
  try {
    const session = sessionStorage.getItem(LEAVING);
    for (const name of session ? Object.keys(localStorage) : []) {
      if (name.startsWith("ocularist.") && name.includes(session)) localStorage.removeItem(name);
    }
    sessionStorage.clear();
  } catch {
    // As above.
  }
  return () => {};
}
