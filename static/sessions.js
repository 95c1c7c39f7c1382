// One outbox and one lease for every session that this document has shown pages of; and what people
// who used this browser before have left in it.

import { Keep } from "./keep.js";
import { Outbox } from "./outbox.js";
import { Tab } from "./tab.js";
import { text } from "./texts.js";

const sessions = new Map(); // name -> {outbox, tab}
const owners = new Keep("ocularist.owner."); // session -> what proves to the site whose entries wait

/**
 * Return the session of the present page with its outbox and tab, or null where nobody takes part.
 * @param {{onLost: () => void, isElsewhere: () => boolean}} options  lost: another tab goes on
 */
export function currentSession({ onLost, isElsewhere }) {
  const { session, csrf, events, outbox: owner } = document.body.dataset;
  if (!session) return null;
  if (!sessions.has(session)) {
    if (owner) owners.set(session, owner);
    const onFree = () => isElsewhere() && location.reload();
    const tab = new Tab(session, { onLost, onFree });
    const outbox = new Outbox(session, {
      url: events,
      csrf,
      owner,
      mayWrite: () => tab.isHolder || (!isElsewhere() && tab.claim()),
      onChange: showSaved,
      onRefused: (entry, status) => refused(outbox, entry, status),
    });
    addEventListener("beforeunload", (event) => outbox.isAtRisk && event.preventDefault());
    sessions.set(session, { outbox, tab });
    deliverForOthers(session, events);
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

/**
 * Send what waits here from people before, and forget their drafts: those are among their entries.
 * Two tabs may do so at once; the site stores each entry once.
 */
export function deliverForOthers(present, events) {
  // Without a proof the site would take an entry for one of the person who is here now.
  for (const session of owners.names()) {
    if (session === present) continue;
    for (const kind of ["draft", "running"]) new Keep(`ocularist.${kind}.${session}.`).clear();
    const options = { url: events, csrf: "", owner: owners.get(session), onChange() {}, onRefused() {} };
    const outbox = new Outbox(session, options);
    outbox.settled().then(() => owners.remove(session));
  }
}
