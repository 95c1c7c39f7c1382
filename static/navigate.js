// From page to page without leaving the document, so that full screen and loaded clips stay.
//
// The server sends whole pages in every case; here the new page's strip and main take the old one's
// place. Without this module every link and form works as it always did.

const PAUSES_MS = [500, 1000, 2000, 4000, 8000];

/** Fetch, and try again for as long as there is no connection or the server is starting. */
export async function fetchPatiently(url, options, onWaiting = () => {}) {
  for (let attempt = 0; ; attempt += 1) {
    try {
      const answer = await fetch(url, options);
      // After a redirect the post itself was taken: whatever page follows is to be shown.
      if (answer.status < 500 || answer.redirected) return answer;
    } catch {
      // No connection: wait, then try again.
    }
    onWaiting();
    await pause(PAUSES_MS[Math.min(attempt, PAUSES_MS.length - 1)]);
  }
}

function pause(delay_ms) {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, delay_ms);
    addEventListener("online", () => (clearTimeout(timer), resolve()), { once: true });
  });
}

/** Post a form until the server has it, then show the page that follows. */
export async function submitPatiently(form, start, { extra = [], onWaiting, onLeave } = {}) {
  const body = new URLSearchParams(new FormData(form));
  for (const [name, value] of extra) body.set(name, value);
  const answer = await fetchPatiently(form.action, { method: "POST", body }, onWaiting);
  onLeave?.();
  await showPage(answer, start);
}

/** Put a fetched page in the place of the present one and start its script. */
export async function showPage(answer, start) {
  const page = new DOMParser().parseFromString(await answer.text(), "text/html");
  document.title = page.title;
  document.querySelector("header").replaceWith(page.querySelector("header"));
  document.querySelector("main").replaceWith(page.querySelector("main"));
  document.getElementById("texts").replaceWith(page.getElementById("texts"));
  const { lang, dir } = page.documentElement;
  Object.assign(document.documentElement, { lang, dir });
  for (const name of ["session", "csrf", "outbox", "release_s"]) {
    if (page.body.dataset[name] === undefined) delete document.body.dataset[name];
    else document.body.dataset[name] = page.body.dataset[name];
  }
  document.body.className = page.body.className;
  history.replaceState(null, "", answer.url);
  scrollTo(0, 0);
  document.querySelector("h1")?.focus({ preventScroll: true });
  start();
}
