// What is usually looked for, and how one listens to it. Only these values change; everything else stays as typed.
import { t } from "../i18n";
import type { EmitterSpec, MissionSpec } from "../wire";

export type PresetName = "wildlife" | "beacon" | "interference";

type Sensor = Pick<MissionSpec["sensor"], "sigma_deg" | "measurement_time_s" | "turn_rate_deg_s">;

interface Preset {
  hz: number;
  kind: EmitterSpec["kind"];
  sensor: Sensor;
}

const preset = (hz: number, kind: EmitterSpec["kind"], sigma_deg: number, measurement_time_s: number, turn_rate_deg_s: number): Preset => ({
  hz,
  kind,
  sensor: { sigma_deg, measurement_time_s, turn_rate_deg_s },
});

/** A tag pulses about once a second, so a sweep must be slow; a beacon's homing signal and interference are steady. */
const presets: Record<PresetName, Preset> = {
  wildlife: preset(150_000_000, "pulsed", 9, 45, 8),
  beacon: preset(121_500_000, "carrier", 7, 16, 30),
  interference: preset(1_575_420_000, "carrier", 6, 16, 30),
};

export const presetNames = Object.keys(presets) as PresetName[];

/** Frequencies and names of several emitters are a list that somebody typed. */
export function withPreset(spec: MissionSpec, name: PresetName): MissionSpec {
  const { hz, kind, sensor } = presets[name];
  const own = spec.emitters.length === 1 && { frequency_hz: hz, label: t(`edit.preset.${name}`) };
  return { ...spec, emitters: spec.emitters.map((one) => ({ ...one, ...own, kind })), sensor: { ...spec.sensor, ...sensor } };
}

export const isOfPreset = (path: string): boolean => /^sensor\.(sigma|measurement|turn)|\.frequency_hz$/.test(path);

/** The preset that the values are still those of, whatever the names are; null when one was changed. */
export function presetOf(spec: MissionSpec): PresetName | null {
  const values = ({ emitters, sensor }: MissionSpec) => JSON.stringify([emitters.map((one) => ({ ...one, label: "" })), sensor]);
  return presetNames.find((name) => values(withPreset(spec, name)) === values(spec)) ?? null;
}
