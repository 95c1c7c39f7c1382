// One outbox and one lease for every session that this document has shown pages of.

import { Outbox } from "./outbox.js";
import { Tab } from "./tab.js";
import { text } from "./texts.js";

const sessions = new Map(); // name -> {outbox, tab}

/**
 * Return the session of the present page with its outbox and tab, or null where nobody takes part.
 * @param {{onLost: () => void, isElsewhere: () => boolean}} options  lost: another tab goes on
 */
export function currentSession({ onLost, isElsewhere }) {
  const { session, csrf, events } = document.body.dataset;
  if (!session) return null;
  if (!sessions.has(session)) {
    const onFree = () => isElsewhere() && location.reload();
    const tab = new Tab(session, { onLost, onFree });
    const outbox = new Outbox(session, {
      url: events,
      csrf,
      mayWrite: () => tab.isHolder || (!isElsewhere() && tab.claim()),
      onChange: showSaved,
      onRefused: (entry, status) => refused(outbox, entry, status),
    });
    addEventListener("beforeunload", (event) => outbox.isAtRisk && event.preventDefault());
    sessions.set(session, { outbox, tab });
  }
  return sessions.get(session);
}

/** Say in the strip whether everything is stored. */
function showSaved({ waiting, failed, unkept }) {
  const line = document.querySelector(".saved");
  if (!line) return;
  const state = !waiting ? "saved" : unkept ? "unkept" : failed ? "waiting" : "saving";
  if (line.dataset.state === state) return;
  line.dataset.state = state;
  line.querySelector("[role=status]").textContent = {
    saved: text("all.saved"),
    saving: text("all.saving"),
    waiting: text("all.not_saved"),
    unkept: text("all.not_kept"),
  }[state];
}

/** The server will never take this entry. Out of step: show where we are. Else the researcher hears. */
function refused(outbox, entry, status) {
  if (status === 409) location.reload();
  else if (entry.kind !== "problem" && status !== 410) {
    outbox.add({ kind: "problem", code: `REFUSED-${status} ${entry.kind}` }, "refused");
  }
}
