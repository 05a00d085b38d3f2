// The address says which mission is shown, hence which source speaks: one place decides, whatever page comes or goes.
import { computed, effect } from "@preact/signals";
import { replays } from "../sources/replays";
import { live, source } from "../state/connection";
import { followed, isGone, noteGone } from "../state/gone";
import { open } from "../state/open";
import { route } from "../state/route";
import { entered, refreshSession } from "../state/session";
import { sourceFor } from "./sourceFor";

/** The mission that flies, where a recording of it is shown: it is shown as it is now, not as it was. */
const hidden = computed<string | null>(() => {
  const flies = live.value.status?.value.mission_id;
  return flies && flies === source.value?.missionId && !source.value.takesCommands ? flies : null;
});

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
    if (hidden.value !== null) replays.delete(hidden.value);
    else if (now?.missionId === wanted) return;
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
