// A draft on its way to the server: saved once however often its answer is lost, and never over another's unseen.
import * as api from "../sources/api";
import { isRefusal, type RequestFailed } from "../sources/problem";
import { drop, kept } from "../state/kept";
import type { Mission, MissionSpec } from "../wire";

const DRAFTED_SEQ = 1;

const storageKey = (key: string) => `crossfix.saving.${key}`;

/** Of this tab, over a reload too. Two tabs draft two missions. */
function missionIdFor(key: string): string {
  const known = kept(storageKey(key), "sessionStorage");
  if (known) return known;
  const id = api.newCommandId();
  try {
    sessionStorage.setItem(storageKey(key), id);
  } catch {
    // full, or kept from it: pressed again, it drafts another
  }
  return id;
}

/** The next save drafts another mission. */
export const forgetSaving = (key: string): void => drop(storageKey(key), "sessionStorage");

const hasCode = (error: unknown, code: string): error is RequestFailed => isRefusal(error) && error.problem.reason?.code === code;

/** Who saved another specification meanwhile: the number to save over, null when that is not what is wrong. */
export const savedMeanwhile = ({ problem: { reason } }: RequestFailed): number | null =>
  reason?.code === "edited_meanwhile" ? reason.seq : null;

/** What the answer was lost of is brought up to date, unless somebody else has it by now. */
export async function draftOnce(key: string, spec: MissionSpec): Promise<Mission> {
  const id = missionIdFor(key);
  try {
    return await api.draftMission(spec, id);
  } catch (error) {
    if (!hasCode(error, "drafted_before")) throw error;
  }
  try {
    return await api.editMission(id, spec, DRAFTED_SEQ);
  } catch (error) {
    if (!isRefusal(error) || error.problem.status !== 409) throw error;
    forgetSaving(key);
    return draftOnce(key, spec);
  }
}
