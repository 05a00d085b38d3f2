// Vehicles and sensors one flies again and again: the values that belong to the equipment, kept under a name.
import { signal } from "@preact/signals";
import type { MissionSpec } from "../wire";

export interface Profile {
  name: string;
  sensor: MissionSpec["sensor"];
  motion: MissionSpec["planner"]["motion"];
  flight: Pick<
    MissionSpec["flight"],
    "altitude_relative_m" | "minimum_altitude_relative_m" | "maximum_altitude_relative_m" | "speed_m_s" | "reserve_battery_percent"
  >;
}

const KEY = "crossfix.profiles";

const isProfile = (value: unknown): value is Profile => {
  const candidate = value as Partial<Profile> | null;
  return typeof candidate?.name === "string" && !!candidate.sensor && !!candidate.motion && !!candidate.flight;
};

export function readProfiles(stored: string | null): Profile[] {
  try {
    const parsed: unknown = JSON.parse(stored ?? "[]");
    return Array.isArray(parsed) ? parsed.filter(isProfile) : [];
  } catch {
    return [];
  }
}

export const profiles = signal<readonly Profile[]>(readProfiles(localStorage.getItem(KEY)));

function keep(next: readonly Profile[]): void {
  profiles.value = next;
  localStorage.setItem(KEY, JSON.stringify(next));
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

/** A profile of the same name is replaced. */
export function saveProfile(profile: Profile): void {
  keep([...profiles.peek().filter((p) => p.name !== profile.name), profile].toSorted((a, b) => a.name.localeCompare(b.name)));
}

export function removeProfile(name: string): void {
  keep(profiles.peek().filter((p) => p.name !== name));
}
