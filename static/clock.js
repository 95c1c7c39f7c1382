// Time since a trial's first presented frame, and how finely this browser tells time.

let step_ms = null;

/** The coarseness of performance.now() in ms: browsers round it, some to 100 ms. Measured once. */
export function clockStep_ms() {
  step_ms ??= measureStep();
  return step_ms;
}

function measureStep() {
  const start = performance.now();
  let last = start;
  let least = 100; // the coarsest clock in use; a coarser one is told as this
  for (let changes = 0; changes < 8 && last - start < 20; ) {
    const now = performance.now();
    if (now === last) continue;
    least = Math.min(least, now - last);
    last = now;
    changes += 1;
  }
  return Math.round(least * 1e4) / 1e4;
}

/** Milliseconds since 1970 on a clock that is never set back within one document. */
export function now_ms() {
  return performance.timeOrigin + performance.now();
}

/**
 * The clock of one trial. It starts once, at the first frame, and goes on over a reload.
 * @param {string} trial  a name that no other trial in this browser has
 */
export function firstFrameClock(trial) {
  const name = `ocularist.first-frame.${trial}`;
  return {
    /** @param {number} shown_ms  when the frame was presented, in the time of performance.now() */
    start(shown_ms) {
      if (sessionStorage.getItem(name)) return;
      sessionStorage.setItem(name, String(performance.timeOrigin + shown_ms));
    },
    /** Whole milliseconds since the first frame as text, "" before it. */
    read() {
      const first = Number(sessionStorage.getItem(name));
      return first ? String(Math.max(1, Math.round(now_ms() - first))) : "";
    },
    clear() {
      sessionStorage.removeItem(name);
    },
  };
}
