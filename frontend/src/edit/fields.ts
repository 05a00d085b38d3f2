// The form as a table: which value of the specification stands where, in which unit, within which limits.
import type { MessageKey } from "../i18n";
import { locale } from "../units/locale";
import type { UnitSystem } from "../units/quantities";
import type { MissionSpec } from "../wire";

export type Unit = "m" | "m/s" | "s" | "°" | "°/s" | "%" | "MHz" | "m/s²" | "times" | "places" | "bearings" | "";

interface Listed {
  path: string;
  label: MessageKey;
  more?: boolean;
  /** Where it does not apply it is not asked for; by default it applies. */
  when?: (spec: MissionSpec) => boolean;
}

export interface NumberField extends Listed {
  kind: "number";
  unit: Unit;
  /** Stored value = shown value x scale. */
  scale?: number;
  min?: number;
  max?: number;
  step?: number;
}

export interface ChoiceField extends Listed {
  kind: "choice";
  options: readonly { value: string; label: MessageKey | null }[];
}

export interface SwitchField extends Listed {
  kind: "switch";
}

export type Field = NumberField | ChoiceField | SwitchField;

export interface Section {
  title: MessageKey;
  fields: readonly Field[];
}

const number = (path: string, label: MessageKey, unit: Unit, limits: Partial<NumberField> = {}): NumberField => ({
  kind: "number",
  path,
  label,
  unit,
  ...limits,
});

const isJoint = ({ sensor }: MissionSpec) => sensor.bearing_errors === "joint";

/** A tag's pulses, several emitters at once, and a craft that turns only in order to look elsewhere take whole turns. */
const mayTurnInSectors = (spec: MissionSpec) => isOneCarrier(spec) && spec.sensor.never_stop !== true;

/** Also where it is on and may not be: it has to be there to be turned off. */
const mayNeverStop = (spec: MissionSpec) =>
  spec.sensor.never_stop === true ||
  (isJoint(spec) && isOneCarrier(spec) && spec.sensor.listen_on_the_way === true && spec.sensor.swing_on_the_way === true);

const isOneCarrier = ({ emitters: [first, ...others] }: MissionSpec) => others.length === 0 && first?.kind === "carrier";

export const sections: readonly Section[] = [
  {
    title: "edit.section.flight",
    fields: [
      number("flight.altitude_relative_m", "edit.altitude", "m", { min: 2, max: 500 }),
      number("flight.speed_m_s", "edit.speed", "m/s", { min: 0.1, max: 30 }),
      number("flight.reserve_battery_percent", "edit.reserve", "%", { min: 5, max: 90 }),
      { kind: "switch", path: "flight.automatic", label: "edit.automatic" },
      number("flight.minimum_altitude_relative_m", "edit.altitude.minimum", "m", { min: 0, max: 500, more: true }),
      number("flight.maximum_altitude_relative_m", "edit.altitude.maximum", "m", { min: 2, max: 1000, more: true }),
      number("flight.minimum_clearance_m", "edit.clearance", "m", { min: 0, max: 500, more: true }),
      number("flight.maximum_above_ground_m", "edit.aboveGround", "m", { min: 2, max: 1000, more: true }),
    ],
  },
  {
    title: "edit.section.end",
    fields: [
      number("localization.expected_rmse_m", "edit.rmse", "m", { min: 0.1 }),
      number("localization.maximum_bearings", "edit.maximumBearings", "bearings", { min: 2, max: 200, step: 1 }),
      number("localization.minimum_places", "edit.places", "places", { min: 2, max: 20, step: 1, more: true }),
      number("localization.minimum_place_distance_m", "edit.placeDistance", "m", { min: 0, more: true }),
      number("localization.minimum_crossing_angle_deg", "edit.crossing", "°", { min: 0, max: 90, more: true }),
    ],
  },
  {
    title: "edit.section.sensor",
    fields: [
      number("sensor.sigma_deg", "edit.sigma", "°", { min: 0.1, max: 60 }),
      number("sensor.measurement_time_s", "edit.measurement", "s", { min: 1 }),
      number("sensor.outlier_probability", "edit.outlier", "%", { scale: 0.01, min: 0, max: 50, more: true }),
      number("sensor.bearing_offset_deg", "edit.bearingOffset", "°", { min: -180, max: 180, step: 0.1, more: true }),
      number("sensor.turn_rate_deg_s", "edit.turnRate", "°/s", { min: 5, max: 90, more: true }),
      number("sensor.minimum_quality", "edit.quality", "", { min: 0, max: 1, step: 0.05, more: true }),
      number("sensor.maximum_retakes", "edit.retakes", "times", { min: 0, max: 10, step: 1, more: true }),
      { kind: "switch", path: "sensor.sector_turns", label: "edit.sectorTurns", when: mayTurnInSectors },
      number("sensor.whole_turns", "edit.wholeTurns", "places", {
        min: 1,
        max: 20,
        step: 1,
        more: true,
        when: (spec) => mayTurnInSectors(spec) && spec.sensor.sector_turns === true,
      }),
      {
        kind: "choice",
        path: "sensor.bearing_errors",
        label: "edit.bearingErrors",
        options: [
          { value: "joint", label: "edit.bearingErrors.joint" },
          { value: "independent", label: "edit.bearingErrors.independent" },
        ],
        more: true,
      },
      {
        kind: "switch",
        path: "sensor.shared_errors",
        label: "edit.sharedErrors",
        more: true,
        when: (spec) => isJoint(spec) && spec.emitters.length > 1,
      },
      {
        kind: "choice",
        path: "sensor.sweep_evidence",
        label: "edit.sweepEvidence",
        options: [
          { value: "peak", label: "edit.sweepEvidence.peak" },
          { value: "whole", label: "edit.sweepEvidence.whole" },
        ],
        more: true,
        when: isJoint,
      },
      { kind: "switch", path: "sensor.listen_on_the_way", label: "edit.listenOnTheWay", more: true, when: isJoint },
      {
        kind: "switch",
        path: "sensor.swing_on_the_way",
        label: "edit.swingOnTheWay",
        more: true,
        when: (spec) => isJoint(spec) && spec.sensor.listen_on_the_way === true,
      },
      { kind: "switch", path: "sensor.never_stop", label: "edit.neverStop", more: true, when: mayNeverStop },
    ],
  },
  {
    title: "edit.section.planner",
    fields: [
      {
        kind: "choice",
        path: "planner.method",
        label: "edit.method",
        options: [
          { value: "rollout", label: "edit.method.rollout" },
          { value: "base_policy", label: "edit.method.base_policy" },
        ],
      },
      number("planner.standoff_m", "edit.standoff", "m", { min: 0 }),
      number("planner.budget", "edit.budget", "", { min: 10, max: 100_000, step: 1, more: true }),
      number("planner.action_spacing_m", "edit.spacing", "m", { min: 0.5, more: true }),
      {
        kind: "choice",
        path: "planner.base_policy",
        label: "edit.basePolicy",
        options: [
          { value: "dynamic_program", label: "edit.basePolicy.dynamic_program" },
          { value: "fisher", label: null },
          { value: "ellipse", label: null },
        ],
        more: true,
      },
      {
        kind: "choice",
        path: "planner.selection",
        label: "edit.selection",
        options: [
          { value: "sequential_halving", label: "edit.selection.sequential_halving" },
          { value: "uniform", label: "edit.selection.uniform" },
        ],
        more: true,
      },
      {
        kind: "choice",
        path: "planner.sampling",
        label: "edit.sampling",
        options: [
          { value: "crn", label: null },
          { value: "deterministic", label: null },
          { value: "pmc", label: null },
          { value: "quasi_random", label: null },
        ],
        more: true,
      },
      {
        kind: "choice",
        path: "planner.estimator",
        label: "edit.estimator",
        options: [
          { value: "map", label: "edit.estimator.map" },
          { value: "expected_value", label: "edit.estimator.expected_value" },
          { value: "geometric_median", label: "edit.estimator.geometric_median" },
        ],
        more: true,
      },
      number("planner.seed", "edit.seed", "", { min: 0, step: 1, more: true }),
    ],
  },
  {
    title: "edit.section.timers",
    fields: [
      number("timers.console_lost_hold_s", "edit.consoleHold", "s", { min: 1, max: 120 }),
      number("timers.console_lost_return_s", "edit.consoleReturn", "s", { min: 1, max: 600 }),
      number("timers.receiver_silent_s", "edit.receiverSilent", "s", { min: 1, max: 60, more: true }),
    ],
  },
];

const IMPERIAL: Partial<Record<Unit, { unit: string; scale: number }>> = {
  m: { unit: "ft", scale: 0.3048 },
  "m/s": { unit: "mph", scale: 0.44704 },
  "m/s²": { unit: "ft/s²", scale: 0.3048 },
};

/** Unit to show and stored-per-shown factor in the operator's system of units. */
export function shownUnit(field: NumberField, system: UnitSystem): { unit: string; scale: number } {
  const converted = system === "imperial" ? IMPERIAL[field.unit] : undefined;
  return { unit: converted?.unit ?? field.unit, scale: (converted?.scale ?? 1) * (field.scale ?? 1) };
}

/** Stored to shown, without the noise of floating point; feet of whole metres end nowhere. */
export function shownValue(stored: number, scale: number): string {
  const text = String(Number((stored / scale).toPrecision(Number.isInteger(Math.log10(scale)) ? 12 : 7)));
  return locale.value === "de" ? text.replace(".", ",") : text;
}

/** Number from what was typed (a decimal comma is fine); null when it is none, or may have a mark between thousands, which
 * nobody writes into MHz. */
export function typedNumber(text: string, scale = 1): number | null {
  const plain = text.trim().replace(",", ".");
  const mayBeThousands = /^[+-]?[1-9]\d{0,2}\.\d{3}$/.test(plain) && text.includes(locale.value === "de" ? "." : ",");
  if ((mayBeThousands && scale !== 1e6) || !/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(plain)) return null;
  return Number(plain);
}
