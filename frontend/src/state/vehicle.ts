// The vehicle of the craft shown and its path, at the moment looked at.
import { batch, computed, effect, signal } from "@preact/signals";
import { isRefusal } from "../sources/problem";
import type { Source } from "../sources/source";
import type { TrackFact } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { live, source } from "./connection";
import { craftShown, telemetry } from "./heard";
import { cursor, liveMission, reviewTimeMs } from "./moment";
import { unseen, type VehicleView, withoutTremble } from "./vehicleView";

/** The stored path: what was flown before this page was opened. */
export const track = signal<readonly TrackFact[]>([]);

/** The number of the last load: what an earlier one brings is not taken. */
let loads = 0;
const AGAIN_MS = 5000;
const again = signal(0);
let timer: ReturnType<typeof setTimeout> | undefined;
const NO_PATH: readonly LonLat[] = [];

async function loadTrack(from: Source, missionId: string, craftId: string): Promise<void> {
  const mine = loads;
  const known = live.peek().paths.get(craftId)?.length;
  const loaded = await from.track(missionId, craftId).catch((error: unknown) => {
    if (mine === loads && !isRefusal(error)) timer = setTimeout(() => again.value++, AGAIN_MS);
  });
  if (!loaded || mine !== loads) return;
  const paths = new Map(live.peek().paths);
  paths.set(craftId, (paths.get(craftId) ?? NO_PATH).slice(known)); // what was heard meanwhile
  batch(() => {
    track.value = loaded.points;
    live.value = { ...live.peek(), paths };
  });
}

const craftFlown = computed(() => liveMission.value.craftId);

effect(() => {
  void [source.value, craftFlown.value];
  track.value = [];
});

const reviewing = computed(() => cursor.value !== null);
/** Another one comes after each gap, in which nothing was heard of the flight. */
const hello = computed(() => live.value.hello);
effect(() => {
  const [from, craftId] = [source.value, craftFlown.value, reviewing.value, hello.value, again.value];
  clearTimeout(timer);
  loads++;
  if (from?.missionId && craftId !== null) void loadTrack(from, from.missionId, craftId);
});

const reviewPoint = computed<TrackFact | null>(() => {
  const time = reviewTimeMs.value;
  if (time === null) return null;
  return track.value.findLast((p) => Date.parse(p.at_utc) <= time) ?? track.value[0] ?? null;
});

const seen = computed<VehicleView>(() => {
  if (reviewing.value) {
    const point = reviewPoint.value;
    return point ? { at: [point.lon, point.lat], headingDeg: point.heading_deg, speedMs: null } : unseen;
  }
  const value = telemetry.value?.value;
  if (!value) return unseen;
  const at: LonLat | null = value.lon !== null && value.lat !== null ? [value.lon, value.lat] : null;
  return { at, headingDeg: value.heading_deg, speedMs: value.ground_speed_m_s };
});

export const vehicle = signal<VehicleView>(unseen);
effect(() => {
  vehicle.value = reviewing.value ? seen.value : withoutTremble(vehicle.peek(), seen.value);
});

const livePath = computed(() => live.value.paths.get(craftShown.value ?? "") ?? NO_PATH);

export const path = computed<readonly LonLat[]>(() => {
  const time = reviewTimeMs.value;
  const until = time ?? Infinity;
  const flown = track.value.filter((p) => Date.parse(p.at_utc) <= until).map((p): LonLat => [p.lon, p.lat]);
  return time === null && source.value?.happensNow ? [...flown, ...livePath.value] : flown;
});
