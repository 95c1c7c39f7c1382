// A shared computer lets go of a participant who has done nothing for half an hour: the first page is
// shown, for the next person. What waits in the outbox is sent from there, as the last one's.

const LOOK_MS = 5000;
const SIGNS = ["pointerdown", "pointermove", "keydown", "wheel", "input"];

let last = performance.now();
let watch = null;

/** Watch for signs of life while the present page asks for it. */
export function watchForSigns() {
  clearInterval(watch);
  const release_s = Number(document.body.dataset.release_s);
  if (!release_s) return;
  sign();
  for (const name of SIGNS) addEventListener(name, sign, { passive: true });
  watch = setInterval(() => {
    const isPlaying = [...document.querySelectorAll("video")].some((video) => !video.paused);
    if (isPlaying) sign();
    if (performance.now() - last > 1000 * release_s) release();
  }, LOOK_MS);
}

function sign() {
  last = performance.now();
}

/** Without a connection it is tried again a little later; the site has forgotten them by then too. */
async function release() {
  try {
    const body = new URLSearchParams({ csrf: document.body.dataset.csrf });
    await fetch("/next", { method: "POST", body });
    clearInterval(watch);
    sessionStorage.clear();
    location.replace("/");
  } catch {
    // Offline.
  }
}
