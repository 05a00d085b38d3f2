// What abort, hold, return, landing and resume act on, for buttons and keys alike.
import { computed, effect, signal } from "@preact/signals";
import type { CraftStatus, Phase } from "../wire";
import { live, source } from "./connection";
import type { CraftState } from "./craft";
import { craftShown } from "./heard";

/** A craft in the air and the mission that it flies for; null: for none, and yet it can be held, brought home and landed. */
export interface Flown {
  id: string | null;
  craftId: string;
  phase: Phase;
}

interface Picture {
  /** The mission shown as it stands now; null when there is none, or when it is a recording. */
  shown: { id: string; crafts: ReadonlyMap<string, Pick<CraftState, "engaged" | "phase">> } | null;
  /** What the server says of every craft there is. */
  served: readonly Pick<CraftStatus, "craft_id" | "mission_id" | "phase">[];
  /** By craft, what the vehicle tells; without an entry it is not known. */
  inAir: ReadonlyMap<string, boolean | null>;
  /** The craft to act on, where several fly for the mission. */
  preferred: string | null;
}

/**
 * The mission shown while a craft flies for it, else any other that has one in the air, over or not, else a craft in the
 * air without a mission; null: nothing of ours flies. A mission's own events are newer than the server's status, but what is not known to be down still counts.
 */
export function missionToCommand({ shown, served, inAir, preferred }: Picture): Flown | null {
  const engaged = [...(shown?.crafts ?? [])].filter(([, craft]) => craft.engaged);
  const own = engaged.map(([craftId, { phase }]): Flown => ({ id: shown!.id, craftId, phase }));
  const others = served.flatMap(({ craft_id: craftId, mission_id: id, phase }): Flown[] => {
    if (id === null || own.some((craft) => craft.craftId === craftId)) return [];
    const known = id === shown?.id ? shown.crafts.get(craftId) : undefined;
    const perhapsUp = inAir.get(craftId) !== false;
    return perhapsUp || (!known && phase !== "ground") ? [{ id, craftId, phase: known?.phase ?? phase }] : [];
  });
  const ofShown = [...own, ...others.filter(({ id }) => id === shown?.id)];
  const loose = served.flatMap(({ craft_id: craftId, mission_id: id, phase }): Flown[] =>
    id === null && phase !== "ground" && !own.some((craft) => craft.craftId === craftId) ? [{ id, craftId, phase }] : [],
  );
  const [flown] = [ofShown, others, loose].filter((crafts) => crafts.length > 0);
  return flown?.find(({ craftId }) => craftId === preferred) ?? flown?.[0] ?? null;
}

const served = computed(() => live.value.status?.value.crafts ?? []);
const mission = computed(() => live.value.mission);
const telemetry = computed(() => live.value.telemetry);

const now = computed<Flown | null>(() => {
  const { missionId: id, crafts } = mission.value;
  return missionToCommand({
    shown: id !== null && source.value?.takesCommands ? { id, crafts } : null,
    served: served.value,
    inAir: new Map([...telemetry.value].map(([craftId, { value }]) => [craftId, value.in_air])),
    preferred: craftShown.value,
  });
});

const same = (a: Flown | null, b: Flown | null) => a?.id === b?.id && a?.craftId === b?.craftId && a?.phase === b?.phase;

/** Stays as it is while telemetry comes and says nothing else. */
export const flying = signal<Flown | null>(null);
effect(() => {
  if (!same(flying.peek(), now.value)) flying.value = now.value;
});
