// From page to page without leaving the document, so that full screen and loaded clips stay.
//
// The server sends whole pages in every case; here the new page's strip and main take the old one's
// place. Without this module every link and form works as it always did.

import { fetchPatiently } from "./patience.js";

/** Post a form until the server has it, then show the page that follows. */
export async function submitPatiently(form, start, { extra = [], onWaiting, onLeave } = {}) {
  const body = new URLSearchParams(new FormData(form));
  for (const [name, value] of extra) body.set(name, value);
  const post = { method: "POST", body };
  const answer = await fetchPatiently(form.action, post, { onWaiting, isOurs: isPage });
  const page = pageOf(answer.text);
  if (!isWhole(page)) return location.reload(); // refused without a page of ours: ask where we are
  onLeave?.();
  showPage(page, answer.url, start);
}

const pageOf = (text) => new DOMParser().parseFromString(text, "text/html");
const isWhole = (page) => ["header", "main", "#texts"].every((part) => page.querySelector(part));
const isPage = (text) => isWhole(pageOf(text));

/** Put a fetched page in the place of the present one and start its script. */
function showPage(page, url, start) {
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
  history.replaceState(null, "", url);
  scrollTo(0, 0);
  document.querySelector("main h1")?.focus({ preventScroll: true });
  start();
}
