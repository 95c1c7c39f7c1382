// Requests that do not give up: no connection, a server that starts, one that has too much to do, and
// a network's sign-in page are all waited for.

const PAUSES_MS = [500, 1000, 2000, 4000, 8000];
const TIMEOUT_MS = 30000;
const LONGEST_WAIT_MS = 60000;

/** @typedef {{status: number, ok: boolean, redirected: boolean, url: string, text: string,
 *             wait_ms: number}} Answer */

/**
 * Fetch until the site itself gives an answer that is not "later"; the whole answer has come then.
 * @param {{onWaiting?: () => void, isOurs: (text: string) => boolean}} options
 *   isOurs: whether a text can be this site's, asked of answers that say "ok"
 * @returns {Promise<Answer>}
 */
export async function fetchPatiently(url, request, { onWaiting = () => {}, isOurs }) {
  for (let attempt = 0; ; attempt += 1) {
    const answer = await fetchOnce(url, request);
    if (answer && !isLater(answer) && (!answer.ok || isOurs(answer.text))) return answer;
    onWaiting();
    const pause_ms = PAUSES_MS[Math.min(attempt, PAUSES_MS.length - 1)];
    await pause(Math.max(answer?.wait_ms ?? 0, pause_ms * (0.75 + Math.random() / 2)));
  }
}

/** After a redirect the post itself was taken: whatever page follows is to be shown. */
function isLater({ status, redirected }) {
  return !redirected && (status >= 500 || status === 429);
}

async function fetchOnce(url, request) {
  const controller = new AbortController();
  const timer = setTimeout(() => controller.abort(), TIMEOUT_MS);
  try {
    const answer = await fetch(url, { ...request, signal: controller.signal });
    const { status, ok, redirected, url: place } = answer;
    const wait_ms = waitOf(answer);
    return { status, ok, redirected, url: place, wait_ms, text: await answer.text() };
  } catch {
    return null; // no connection, or it was cut in the middle
  } finally {
    clearTimeout(timer);
  }
}

/** For how long an answer asks to be left alone, in ms. */
export function waitOf(answer) {
  const seconds = Number(answer.headers.get("Retry-After"));
  return seconds > 0 ? Math.min(1000 * seconds, LONGEST_WAIT_MS) : 0;
}

function pause(delay_ms) {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, delay_ms);
    addEventListener("online", () => (clearTimeout(timer), resolve()), { once: true });
  });
}
