// What is usually looked for, and how one listens to it. Only these values change; everything else stays as typed.
import { t } from "../i18n";
import type { MissionSpec } from "../wire";
import { EMITTER, firstEmitter } from "./emitter";
import { set } from "./path";

export type PresetName = "wildlife" | "beacon" | "interference";

interface Preset {
  frequencyHz: number;
  kind: "carrier" | "pulsed";
  sigmaDeg: number;
  measurementS: number;
  turnRateDegS: number;
}

/** A tag pulses about once a second, so a sweep must be slow; a beacon's homing signal and interference are steady. */
const presets: Record<PresetName, Preset> = {
  wildlife: { frequencyHz: 150_000_000, kind: "pulsed", sigmaDeg: 9, measurementS: 45, turnRateDegS: 8 },
  beacon: { frequencyHz: 121_500_000, kind: "carrier", sigmaDeg: 7, measurementS: 16, turnRateDegS: 30 },
  interference: { frequencyHz: 1_575_420_000, kind: "carrier", sigmaDeg: 6, measurementS: 16, turnRateDegS: 30 },
};

export const presetNames = Object.keys(presets) as PresetName[];

export function withPreset(spec: MissionSpec, name: PresetName): MissionSpec {
  const preset = presets[name];
  const emitter = { ...firstEmitter(spec), frequency_hz: preset.frequencyHz, label: t(`edit.preset.${name}`) };
  const named = set(spec, EMITTER, emitter);
  return {
    ...named,
    emitters: named.emitters.map((one) => ({ ...one, kind: preset.kind })),
    sensor: {
      ...spec.sensor,
      sigma_deg: preset.sigmaDeg,
      measurement_time_s: preset.measurementS,
      turn_rate_deg_s: preset.turnRateDegS,
    },
  };
}

/** The preset that the values are still those of; null when one was changed. */
export function presetOf(spec: MissionSpec): PresetName | null {
  const [emitter, { sensor }] = [firstEmitter(spec), spec];
  const found = presetNames.find((name) => {
    const { frequencyHz, kind, sigmaDeg, measurementS, turnRateDegS } = presets[name];
    return (
      emitter.frequency_hz === frequencyHz &&
      emitter.kind === kind &&
      sensor.sigma_deg === sigmaDeg &&
      sensor.measurement_time_s === measurementS &&
      sensor.turn_rate_deg_s === turnRateDegS
    );
  });
  return found ?? null;
}
