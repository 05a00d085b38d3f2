// What can be gone along and what cannot be crossed, of the mission that is shown.
import { computed, effect, signal } from "@preact/signals";
import { type MissionWays, missionWays } from "../sources/waysApi";
import { advice } from "./advice";
import { source } from "./connection";
import { mission } from "./shown";

export type WayKind = "road" | "path" | "barrier";

export interface Drawn {
  kind: WayKind;
  /** Closed rings, else lines. */
  area: boolean;
  lines: [number, number][][];
}

/** null: not read yet, or not to be had. */
export const ways = signal<MissionWays | null>(null);

const kept = computed(() => (source.value?.keptByServer ? mission.value.missionId : null));

/** What was advised before stood on other ways. */
async function readWays(missionId: string): Promise<void> {
  const found = await missionWays(missionId).catch(() => null);
  if (kept.peek() === missionId) ways.value = found;
}

export async function waysChanged(missionId: string): Promise<void> {
  advice.value = null;
  await readWays(missionId);
}

effect(() => {
  const missionId = kept.value;
  ways.value = null;
  if (missionId) void readWays(missionId);
});

export function drawnOf(found: MissionWays | null): Drawn[] {
  return (found?.features ?? []).map(({ geometry, properties }) => {
    const area = geometry.type === "MultiPolygon";
    const { coordinates } = geometry as { coordinates: [number, number][][] | [number, number][][][] };
    return { kind: properties.kind, area, lines: (area ? coordinates.flat() : coordinates) as [number, number][][] };
  });
}

export const drawnWays = computed(() => drawnOf(ways.value));
