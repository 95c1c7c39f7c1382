// What a browser can measure of its screen and connection. Knows no page.

const FRAMES = 90;
const LONGEST_MS = 4000;
const ZOOMS = [0.25, 0.33, 0.5, 0.67, 0.75, 0.8, 0.9, 1, 1.1, 1.25, 1.5, 1.75, 2, 2.5, 3, 4, 5];
const MOST_BYTES = 4e6;
const LEAST_BYTES = 2e5; // less says more about the server's answer than about the line
const DOWNLOAD_MS = 5000;

/** True on a telephone: no mouse or pen anywhere, and a small screen. */
export function isPhone() {
  if (navigator.userAgentData?.mobile) return true;
  const isFine = matchMedia("(any-pointer: fine)").matches;
  return !isFine && Math.min(screen.width, screen.height) < 600;
}

/** True in Firefox and what is built on it, whatever name it gives itself. */
export function isFirefox() {
  return CSS.supports("-moz-appearance", "none");
}

/** The page's zoom, 1 for none; null where window and page cannot be compared. */
export function zoomOf() {
  // Firefox measures the window in zoomed pixels too, and a full screen has no frame to compare.
  if (isFirefox() || !outerWidth || !innerWidth) return null;
  const found = outerWidth / innerWidth;
  return ZOOMS.find((zoom) => Math.abs(found / zoom - 1) < 0.03) ?? null;
}

/**
 * By how much zooming enlarges what a browser says of its screen in device pixels. Chromium counts
 * the zoom into the pixel ratio and not into the screen's size; Firefox counts it into both, Safari
 * into neither.
 */
export function screenZoom() {
  return "chrome" in window || navigator.userAgentData ? (zoomOf() ?? 1) : 1;
}

/** Frames per second and how irregularly they come (a robust standard deviation). */
export function frameTimes() {
  return new Promise((resolve, reject) => {
    const times = [];
    const began = performance.now();
    requestAnimationFrame(function tick(now) {
      times.push(now);
      const isOver = now - began > LONGEST_MS;
      if (document.hidden) reject(new Error("HIDDEN"));
      else if (times.length <= FRAMES && !isOver) requestAnimationFrame(tick);
      else resolve(summary(times));
    });
    setTimeout(() => reject(new Error("NO-FRAMES")), 2 * LONGEST_MS);
  });
}

function summary(times) {
  const gaps = times.slice(1).map((time, i) => time - times[i]);
  const middle = median(gaps);
  const spread = 1.4826 * median(gaps.map((gap) => Math.abs(gap - middle)));
  return { hertz: round(1000 / middle), jitter_ms: round(spread) };
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

function round(value) {
  return Math.round(value * 100) / 100;
}

/** Megabits per second while these files come; null where they are too small to tell. */
export async function connectionRate(urls) {
  const stop = new AbortController();
  const timer = setTimeout(() => stop.abort(), DOWNLOAD_MS);
  let bytes = 0;
  let busy_ms = 0;
  try {
    for (const url of urls) {
      const range = { Range: `bytes=0-${MOST_BYTES - 1}` };
      const answer = await fetch(url, { headers: range, cache: "no-store", signal: stop.signal });
      if (!answer.ok) break;
      const began = performance.now();
      for (const reader = answer.body.getReader(); ; ) {
        const { done, value } = await reader.read();
        if (done) break;
        bytes += value.byteLength;
      }
      busy_ms += performance.now() - began;
      if (bytes >= MOST_BYTES) break;
    }
  } catch {
    if (!stop.signal.aborted) throw new Error("NO-CONNECTION");
    busy_ms = DOWNLOAD_MS; // as far as it came within the time
  } finally {
    clearTimeout(timer);
  }
  return bytes < LEAST_BYTES || !busy_ms ? null : round((8 * bytes) / 1000 / busy_ms);
}
