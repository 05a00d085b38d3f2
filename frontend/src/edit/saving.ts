// A draft on its way to the server: saved once however often its answer is lost, and never over another's unseen.
import * as api from "../sources/api";
import { isRefusal, type RequestFailed } from "../sources/problem";
import { drop, kept } from "../state/kept";
import type { Mission, MissionSpec } from "../wire";

const storageKey = (key: string) => `crossfix.saving.${key}`;

/** Of this specification, over a reload too: what was changed since is another mission, and so is another tab's. */
function missionIdFor(key: string, spec: MissionSpec): string {
  const [id, sent] = JSON.parse(kept(storageKey(key), "sessionStorage") ?? "[]") as string[];
  if (id && sent === JSON.stringify(spec)) return id;
  const fresh = api.newCommandId();
  try {
    sessionStorage.setItem(storageKey(key), JSON.stringify([fresh, JSON.stringify(spec)]));
  } catch {
    // full, or kept from it: pressed again, it drafts another
  }
  return fresh;
}

/** The next save drafts another mission. */
export const forgetSaving = (key: string): void => drop(storageKey(key), "sessionStorage");

/** Who saved another specification meanwhile: the number to save over, null when that is not what is wrong. */
export const savedMeanwhile = ({ problem: { reason } }: RequestFailed): number | null =>
  reason?.code === "edited_meanwhile" ? reason.seq : null;

/** Sent again after its answer was lost, the same specification is drafted once. */
export async function draftOnce(key: string, spec: MissionSpec): Promise<Mission> {
  const id = missionIdFor(key, spec);
  try {
    return await api.draftMission(spec, id);
  } catch (error) {
    if (!isRefusal(error) || error.problem.reason?.code !== "drafted_before") throw error;
    const before = await api.mission(id);
    if (before.editable && before.deleted_at_utc === null) return before;
    forgetSaving(key); // flown or deleted since: the same again is another mission
    return draftOnce(key, spec);
  }
}
