// The researcher's pages: parts marked data-refresh are fetched again while the page is looked at.
// Polling is enough here: a few researchers, one small page every few seconds, no open sockets.

const PERIOD_MS = 4000;

const wait = (delay_ms) => new Promise((resolve) => setTimeout(resolve, delay_ms));

async function keepFresh() {
  const stamp = document.querySelector("[data-stamp]");
  while (document.querySelector("[data-refresh]")) {
    await wait(PERIOD_MS);
    if (document.hidden) continue;
    try {
      const answer = await fetch(location.href, { redirect: "manual" });
      if (answer.type === "opaqueredirect") return location.reload(); // signed out: show the door
      if (!answer.ok) throw new Error(String(answer.status));
      replaceParts(new DOMParser().parseFromString(await answer.text(), "text/html"));
      if (stamp) stamp.textContent = `As of ${new Date().toLocaleTimeString()}`;
    } catch {
      if (stamp) stamp.textContent = "Not up to date: the site does not answer. Trying again.";
    }
  }
}

/** Replace changed parts only, and never one that holds the keyboard's focus. */
function replaceParts(page) {
  for (const part of document.querySelectorAll("[data-refresh]")) {
    const fresh = page.getElementById(part.id);
    if (!fresh || fresh.innerHTML === part.innerHTML) continue;
    if (part.contains(document.activeElement)) continue;
    part.innerHTML = fresh.innerHTML;
  }
}

/** In the gallery a clip runs while it is pointed at or focused, and rests otherwise. */
function playOnPointing() {
  for (const video of document.querySelectorAll(".gallery video")) {
    const card = video.closest("li");
    const play = () => video.play().catch(() => {});
    for (const name of ["pointerenter", "focusin"]) card.addEventListener(name, play);
    for (const name of ["pointerleave", "focusout"]) {
      card.addEventListener(name, () => video.pause());
    }
  }
}

playOnPointing();
keepFresh();
