// What is heard of the craft shown.
import { computed } from "@preact/signals";
import type { CraftStatus, SweepProgress, TelemetryMessage } from "../wire";
import { live } from "./connection";
import { type Received, turnOf } from "./live";
import { liveMission } from "./moment";
import { selectedCraft } from "./selection";

const crafts = computed(() => live.value.status?.value.crafts ?? []);
const telemetries = computed(() => live.value.telemetry);

/** The one selected, else the mission's first, else the server's first; null: none was heard of. */
export const craftShown = computed<string | null>(() => {
  const wanted = [selectedCraft.value, liveMission.value.craftId].find((id) => id !== null) ?? crafts.value[0]?.craft_id;
  return wanted ?? telemetries.value.keys().next().value ?? null;
});

export const telemetry = computed<Received<TelemetryMessage> | null>(() => telemetries.value.get(craftShown.value ?? "") ?? null);

export const craftStatus = computed<Received<CraftStatus> | null>(() => {
  const { status } = live.value;
  const value = crafts.value.find(({ craft_id }) => craft_id === craftShown.value);
  return status && value ? { value, atMs: status.atMs } : null;
});

/** Of the turn under way. */
export const sweep = computed<SweepProgress | null>(() =>
  turnOf(live.value.sweeps.get(craftShown.value ?? ""), liveMission.value.emitterId ?? ""),
);
