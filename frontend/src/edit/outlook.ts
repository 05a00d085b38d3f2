// What to expect when a mission in flight searches elsewhere from now on, asked of the planner before the slide.
import { effect, signal } from "@preact/signals";
import { asProblem } from "../commands/send";
import * as api from "../sources/api";
import { RequestFailed } from "../sources/problem";
import type { AreaOutlook, MissionSpec, Problem, SearchArea } from "../wire";
import { draft } from "./draft";
import { tool } from "./drawing";

export interface OutlookState {
  search: SearchArea;
  /** Both null while it is asked. */
  found: AreaOutlook | null;
  problem: Problem | null;
  failed: RequestFailed | null;
}

export const outlook = signal<OutlookState | null>(null);

let asking: AbortController | null = null;

export function clearOutlook(): void {
  asking?.abort();
  outlook.value = null;
}

export const searchOf = ({ area, emitters, flight }: MissionSpec): SearchArea => ({
  area,
  priors: Object.fromEntries(emitters.map(({ emitter_id, prior }) => [emitter_id, prior])),
  fence: flight.fence,
  fence_margin_m: flight.fence_margin_m,
  no_fly: flight.no_fly,
});

export async function askOutlook(missionId: string, spec: MissionSpec): Promise<void> {
  asking?.abort();
  asking = new AbortController();
  const { signal: aborted } = asking;
  const search = searchOf(spec);
  const nothing: OutlookState = { search, found: null, problem: null, failed: null };
  outlook.value = nothing;
  try {
    const found = await api.areaOutlook(missionId, search, aborted);
    if (!aborted.aborted) outlook.value = { ...nothing, found };
  } catch (error) {
    if (!aborted.aborted) outlook.value = { ...nothing, problem: asProblem(error), failed: error instanceof RequestFailed ? error : null };
  }
}

/** What was said of an area holds for that area only, however often the same one is drawn or stored again, and until another
 * is begun. */
export function forgetOutlookOfOthers(): () => void {
  return effect(() => {
    const now = draft.value;
    const isDrawing = tool.value !== "none";
    const asked = outlook.peek();
    if (!asked) return;
    const isSame = now !== null && JSON.stringify(searchOf(now.spec)) === JSON.stringify(asked.search);
    if (!isSame || isDrawing || Object.keys(now.text).length > 0) clearOutlook();
  });
}
