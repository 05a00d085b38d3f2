// The address says which mission is shown, hence which source speaks: one place decides, whatever page comes or goes.
import { effect } from "@preact/signals";
import { live, source } from "../state/connection";
import { followed, isGone, noteGone } from "../state/gone";
import { open } from "../state/open";
import { route } from "../state/route";
import { entered, refreshSession } from "../state/session";
import { sourceFor } from "./sourceFor";

export function followRoute(): () => void {
  return effect(() => {
    if (entered.value !== "in") {
      source.peek()?.stop();
      source.value = null;
      return;
    }
    const shown = followed(route.value);
    const wanted = isGone(shown) ? null : shown;
    const now = source.peek();
    if (shown === wanted) noteGone(null);
    if (now?.missionId === wanted) return;
    open(sourceFor(wanted));
  });
}

/** A link that broke may be a session that was ended elsewhere. */
export function followSession(): () => void {
  void refreshSession();
  return effect(() => {
    if (live.value.link.state === "closed") void refreshSession();
  });
}
