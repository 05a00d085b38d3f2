// What to expect of the mission before take-off, asked of the planner.
import { effect, signal } from "@preact/signals";
import { asProblem } from "../commands/send";
import * as api from "../sources/api";
import type { MissionSpec, PlanChosen, Preview, Problem } from "../wire";
import { type Draft, draft } from "./draft";

export interface PreviewState {
  running: boolean;
  found: Preview | null;
  problem: Problem | null;
}

export const preview = signal<PreviewState | null>(null);

let asking: AbortController | null = null;
let asked = "";

const unnamed = (spec: MissionSpec): string => JSON.stringify({ ...spec, name: "" });

/** What was said of a mission holds for that one only. */
export function forgetPreviewOfOthers(): () => void {
  return effect(() => {
    const now = draft.value;
    if (preview.peek() && (!now || unnamed(now.spec) !== asked)) clearPreview();
  });
}

export function clearPreview(): void {
  asking?.abort();
  preview.value = null;
}

/** null: it was left before it could be asked of. */
export async function askPreview(settling: Promise<Draft | null>): Promise<void> {
  asking?.abort();
  asking = new AbortController();
  const { signal: aborted } = asking;
  try {
    const spec = (await settling)?.spec;
    if (!spec || aborted.aborted) return;
    asked = unnamed(spec);
    preview.value = { running: true, found: null, problem: null };
    const found = await api.preview(spec, aborted);
    if (!aborted.aborted) preview.value = { running: false, found, problem: null };
  } catch (error) {
    if (!aborted.aborted) preview.value = { running: false, found: null, problem: asProblem(error) };
  }
}

/** As the event would be; no craft has it yet. */
export const firstPlan = ({ first_place, start: _start, times_s: _times, ...found }: Preview): PlanChosen => ({
  ...found,
  kind: "plan_chosen",
  craft_id: "",
  emitter_id: null,
  place_number: 1,
  place: first_place,
  source: "planner",
  by: null,
  altitude_amsl_m: null,
  forecasts: [],
  first: [],
  set_back: [],
});

/** Counts of `times` in equal classes from the least to the largest. */
export function histogram(times: readonly number[], classes: number): { fromS: number; toS: number; counts: number[] } {
  const [low, high] = [Math.min(...times), Math.max(...times)];
  const width = Math.max(1e-9, (high - low) / classes);
  const counts = new Array<number>(classes).fill(0);
  for (const time of times) counts[Math.min(classes - 1, Math.floor((time - low) / width))]! += 1;
  return { fromS: low, toS: high, counts };
}
