// One entry to the server, and what its answer means.

import { waitOf } from "./patience.js";

const TIMEOUT_MS = 20000;
const KEEPALIVE_BYTES = 16000; // browsers allow 64 KiB over all requests that outlive a page
// Answers of the site's after which trying again is pointless: malformed, out of step, too long, or
// the person withdrew. All others may pass: no connection, too many requests, a server that starts, a
// cookie that a personal link brings back.
const NEVER = new Set([400, 404, 409, 410, 413, 422]);

/**
 * Post an entry; never rejects. `owner` is the proof that a page gave to its outbox.
 * @returns {Promise<{isDone: boolean, status: number, told: object | null, wait_ms: number}>}
 *   isDone: the site has it, then `told` is its answer; or it will never take it, then `told` is null
 */
export async function deliver({ url, csrf, owner }, entry) {
  const body = JSON.stringify(entry);
  const controller = new AbortController();
  const timer = setTimeout(() => controller.abort(), TIMEOUT_MS);
  try {
    const answer = await fetch(url, {
      method: "POST",
      headers: {
        "Content-Type": "application/json",
        "X-CSRF-Token": csrf,
        // Whose entry it is, even if somebody else has begun in this browser since.
        ...(owner && { "X-Ocularist-Outbox": owner }),
      },
      body,
      keepalive: body.length < KEEPALIVE_BYTES,
      signal: controller.signal,
    });
    // The whole answer, or else it did not arrive. A network's sign-in page also says "200".
    const told = await answer.json();
    const isStored = answer.ok && told.key === entry.key;
    const isRefused = NEVER.has(answer.status) && typeof told.code === "string";
    return {
      isDone: isStored || isRefused,
      status: answer.status,
      told: isStored ? told : null,
      wait_ms: waitOf(answer),
    };
  } catch {
    return { isDone: false, status: 0, told: null, wait_ms: 0 };
  } finally {
    clearTimeout(timer);
  }
}
