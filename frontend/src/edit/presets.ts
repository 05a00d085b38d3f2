// What is usually looked for, and how one listens to it. Only these values change; everything else stays as typed.
import type { MissionSpec } from "../wire";

export type PresetName = "wildlife" | "beacon" | "interference";

interface Preset {
  frequencyHz: number;
  kind: "carrier" | "pulsed";
  label: string;
  sigmaDeg: number;
  measurementS: number;
}

/** A tag pulses about once a second, so a sweep must be slow; a beacon's homing signal and interference are steady. */
const presets: Record<PresetName, Preset> = {
  wildlife: { frequencyHz: 150_000_000, kind: "pulsed", label: "wildlife tag", sigmaDeg: 9, measurementS: 45 },
  beacon: { frequencyHz: 121_500_000, kind: "carrier", label: "rescue beacon", sigmaDeg: 7, measurementS: 30 },
  interference: { frequencyHz: 1_575_420_000, kind: "carrier", label: "interference", sigmaDeg: 6, measurementS: 30 },
};

export const presetNames = Object.keys(presets) as PresetName[];

export function withPreset(spec: MissionSpec, name: PresetName): MissionSpec {
  const preset = presets[name];
  return {
    ...spec,
    emitter: { ...spec.emitter, frequency_hz: preset.frequencyHz, kind: preset.kind, label: preset.label },
    sensor: {
      ...spec.sensor,
      sigma_deg: preset.sigmaDeg,
      measurement_time_s: preset.measurementS,
      turn_rate_deg_s: Math.max(5, 360 / preset.measurementS),
    },
  };
}
