// Vehicles and sensors one flies again and again: the values that belong to the equipment, kept under a name.
import { signal } from "@preact/signals";
import type { Suggested } from "../sources/libraryApi";
import { keep, kept } from "../state/kept";
import type { MissionSpec } from "../wire";
import { get } from "./path";

export interface Profile {
  name: string;
  sensor: MissionSpec["sensor"];
  motion: MissionSpec["planner"]["motion"];
  flight: Pick<
    MissionSpec["flight"],
    "altitude_relative_m" | "minimum_altitude_relative_m" | "maximum_altitude_relative_m" | "speed_m_s" | "reserve_battery_percent"
  >;
  /** What it was before each taking over, the newest first. */
  history?: readonly Change[];
}

export interface Change {
  /** UTC, ISO 8601. */
  at: string;
  sensor: Profile["sensor"];
  motion: Profile["motion"];
}

const MOST_KEPT = 20;

const KEY = "crossfix.profiles";

/** Of before 2026-11-23: nothing was taken off bearings, and that is what choosing it must mean. */
const completed = (sensor: Profile["sensor"]): Profile["sensor"] => ({ ...sensor, bearing_offset_deg: sensor.bearing_offset_deg ?? 0 });

const complete = (profile: Profile): Profile => ({
  ...profile,
  sensor: completed(profile.sensor),
  history: (profile.history ?? []).map((change) => ({ ...change, sensor: completed(change.sensor) })),
});

const isProfile = (value: unknown): value is Profile => {
  const candidate = value as Partial<Profile> | null;
  return typeof candidate?.name === "string" && !!candidate.sensor && !!candidate.motion && !!candidate.flight;
};

export function readProfiles(stored: string | null): Profile[] {
  try {
    const parsed: unknown = JSON.parse(stored ?? "[]");
    return Array.isArray(parsed) ? parsed.filter(isProfile).map(complete) : [];
  } catch {
    return [];
  }
}

/** False: they live as long as the page. */
export const areStored = signal(true);
export const profiles = signal<readonly Profile[]>([]);

/** What was saved and could not be stored, by name; null: removed. */
const unstored = new Map<string, Profile | null>();

/** Another tab may have saved one meanwhile. */
const stored = (): Profile[] =>
  [...readProfiles(kept(KEY)).filter((p) => !unstored.has(p.name)), ...[...unstored.values()].filter((p) => p !== null)].sort((a, b) =>
    a.name.localeCompare(b.name),
  );

export function readAgain(): void {
  profiles.value = stored();
}

/** What another tab saved or removed after it holds. */
function forgetOvertaken(before: string | null, now: string | null): void {
  const [was, is] = [before, now].map((text) => new Map(readProfiles(text).map((p) => [p.name, JSON.stringify(p)])));
  for (const name of unstored.keys()) if (was!.get(name) !== is!.get(name)) unstored.delete(name);
  if (unstored.size === 0) areStored.value = true;
}

readAgain();
addEventListener("storage", ({ key, oldValue, newValue }) => {
  if (key === KEY) forgetOvertaken(oldValue, newValue);
  if (key === KEY || key === null) readAgain(); // null: all was cleared
});

function store(name: string, profile: Profile | null): void {
  unstored.set(name, profile);
  readAgain();
  areStored.value = keep(KEY, profiles.peek());
  if (areStored.peek()) unstored.clear();
}

export function profileOf(spec: MissionSpec, name: string): Profile {
  const { altitude_relative_m, minimum_altitude_relative_m, maximum_altitude_relative_m, speed_m_s, reserve_battery_percent } = spec.flight;
  return {
    name,
    sensor: spec.sensor,
    motion: spec.planner.motion,
    flight: { altitude_relative_m, minimum_altitude_relative_m, maximum_altitude_relative_m, speed_m_s, reserve_battery_percent },
  };
}

export const withProfile = (spec: MissionSpec, { sensor, motion, flight }: Profile): MissionSpec => ({
  ...spec,
  sensor,
  planner: { ...spec.planner, motion },
  flight: { ...spec.flight, ...flight },
});

/** Does the profile set the field at the path? */
export const isSetBy = (profile: Profile, path: string): boolean =>
  /^(sensor|planner\.motion)\./.test(path) || get(profile, path) !== undefined;

/** With what checked flights suggest. Pure: the profile after it, its values of before kept in its history. The offset is
 * the whole of it, so that taking it over twice is taking it over once. */
export function learned(profile: Profile, suggested: Suggested, at: string): Profile {
  const { sensor, motion, history = [] } = profile;
  const { sigma_deg, outlier_probability, offset_deg: bearing_offset_deg, speed_m_s: speed, constant_s: constant } = suggested;
  return {
    ...profile,
    sensor: { ...sensor, sigma_deg, outlier_probability, bearing_offset_deg },
    motion: speed === null || constant === null ? motion : { kind: "linear_constant", speed_m_s: speed, constant_s: constant },
    history: [{ at, sensor, motion }, ...history].slice(0, MOST_KEPT),
  };
}

export function learnInto(name: string, suggested: Suggested): void {
  const profile = stored().find((p) => p.name === name);
  if (profile) saveProfile(learned(profile, suggested, new Date().toISOString()));
}

/** As it was before the last taking over; the change itself is forgotten. */
export function takeBack(name: string): void {
  const profile = stored().find((p) => p.name === name);
  const [before, ...history] = profile?.history ?? [];
  if (profile && before) saveProfile({ ...profile, sensor: before.sensor, motion: before.motion, history });
}

/** A profile of the same name is replaced; its history goes on. */
export function saveProfile(saved: Profile): void {
  const history = saved.history ?? stored().find((p) => p.name === saved.name)?.history ?? [];
  store(saved.name, { ...saved, history });
}

export function removeProfile(name: string): void {
  store(name, null);
}
