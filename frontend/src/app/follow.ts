// The address says which mission is shown, hence which source speaks: one place decides, whatever page comes or goes.
import { effect } from "@preact/signals";
import { source } from "../state/connection";
import { open } from "../state/open";
import { route } from "../state/route";
import { sourceFor } from "./sourceFor";

export function followRoute(): () => void {
  return effect(() => {
    const { value } = route;
    const wanted = value.page === "mission" || value.page === "area" ? value.missionId : null;
    const now = source.peek();
    if (now === null || now.missionId !== wanted) open(sourceFor(wanted));
  });
}
