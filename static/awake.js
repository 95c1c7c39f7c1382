// Keeps the screen from going dark while clips are watched, where the browser can.

let lock = null;
let wanted = false;

document.addEventListener("visibilitychange", () => wanted && !document.hidden && request());

/** Ask for the lock; browsers take it away whenever the page is hidden, and it is asked for again. */
export function stayAwake() {
  wanted = true;
  return request();
}

/** Let the screen go dark again. */
export function restAgain() {
  wanted = false;
  lock?.release().catch(() => {});
  lock = null;
}

/** "held", "refused", or "absent" where there is none: on plain http under a host name, for example. */
export function wakeState() {
  if (!("wakeLock" in navigator)) return "absent";
  return lock && !lock.released ? "held" : "refused";
}

async function request() {
  if (!("wakeLock" in navigator) || (lock && !lock.released)) return;
  try {
    lock = await navigator.wakeLock.request("screen");
  } catch {
    lock = null; // low battery, or a policy: the play says so
  }
}
