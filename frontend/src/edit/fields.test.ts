import { readFileSync } from "node:fs";
import { expect, it } from "vitest";
import { localProblem, RequestFailed } from "../sources/problem";
import { locale } from "../units/locale";
import type { MissionSpec } from "../wire";
import { someReason, someSpec } from "../wire/examples";
import { EMITTER, firstEmitter, PRIOR } from "./emitter";
import { sections, shownUnit, shownValue, typedNumber } from "./fields";
import { get, set } from "./path";
import { presetOf, withPreset } from "./presets";

it("every field of the form exists in the specification, so none edits nothing", () => {
  const paths = sections.flatMap((s) => s.fields.map((field) => field.path));
  const ofEmitter = ["label", "frequency_hz", "kind"].map((name) => `${EMITTER}.${name}`);
  for (const path of [...paths, ...ofEmitter, PRIOR]) expect(get(someSpec(), path), path).not.toBeUndefined();
});

it("every choice offers all that the specification may hold, so that none is shown as nothing", () => {
  const schemas = JSON.parse(readFileSync("src/wire/openapi.json", "utf8")).components.schemas;
  const choices = sections.flatMap((s) => s.fields).filter((field) => field.kind === "choice");
  expect(choices.length).toBeGreaterThan(5);
  for (const { path, options } of choices) {
    const [section, name] = path.split(".") as [string, string];
    const known: string[] | undefined = schemas[{ planner: "PlannerSpec", sensor: "SensorSpec" }[section]!].properties[name].enum;
    expect(options.map(({ value }) => value).sort(), path).toEqual(known?.toSorted());
  }
});

const asked = (spec: MissionSpec) =>
  sections.flatMap((s) => s.fields.filter(({ when }) => when?.(spec) ?? true).map(({ path }) => path.replace("sensor.", "")));

it("what does not apply is not asked for", () => {
  const spec = set(set(someSpec(), "sensor.listen_on_the_way", false), "sensor.sector_turns", false);
  const independent = set(spec, "sensor.bearing_errors", "independent");
  for (const path of ["listen_on_the_way", "swing_on_the_way", "sweep_evidence", "shared_errors"])
    expect(asked(independent)).not.toContain(path);
  const joint = set(independent, "sensor.bearing_errors", "joint");
  expect(asked(joint)).toContain("listen_on_the_way");
  expect(asked(joint)).not.toContain("swing_on_the_way");
  expect(asked(set(joint, "sensor.listen_on_the_way", true))).toContain("swing_on_the_way");
  const [first] = joint.emitters;
  expect(asked({ ...joint, emitters: [first!, { ...first!, emitter_id: "other" }] })).toContain("shared_errors");
  const turning = set(spec, "sensor.sector_turns", true);
  expect(asked(turning)).toContain("whole_turns");
  expect(asked(set(turning, `${EMITTER}.kind`, "pulsed"))).not.toContain("sector_turns");
  expect(asked(set(turning, "sensor.never_stop", true))).not.toContain("sector_turns");
});

it("numbers are read as people type them", () => {
  expect(typedNumber(" 7,5 ")).toBe(7.5);
  expect(typedNumber("-3")).toBe(-3);
  expect(typedNumber(".5")).toBe(0.5);
  expect(typedNumber("0,125")).toBe(0.125);
  expect(typedNumber("868.125")).toBe(868.125);
  for (const text of ["", "seven", "1.2.3", "0x10", "1 000", "1,000", "-868,125", "1,575.42"]) expect(typedNumber(text), text).toBeNull();
});

it("what may be thousands in German is not guessed at", () => {
  locale.value = "de";
  expect(typedNumber("868,125")).toBe(868.125);
  expect(typedNumber("1.5")).toBe(1.5);
  for (const text of ["1.000", "868.125", "1.575,42"]) expect(typedNumber(text), text).toBeNull();
  locale.value = "en";
});

it("is shown to the last digit that is kept", () => {
  expect(shownValue(1_234_567_891, 1)).toBe("1234567891");
  expect(shownValue(1_575_420_125, 1e6)).toBe("1575.420125");
  expect(shownValue(0.07, 0.01)).toBe("7");
  expect(shownValue(40, 0.3048)).toBe("131.2336");
});

it("numbers are shown as they are written in the operator's language", () => {
  locale.value = "de";
  expect(shownValue(868_300_000, 1e6)).toBe("868,3");
  expect(typedNumber(shownValue(868_300_000, 1e6))).toBe(868.3);
  locale.value = "en";
  expect(shownValue(868_300_000, 1e6)).toBe("868.3");
});

it("what is shown in feet goes back as the same metres", () => {
  const field = sections[0]!.fields[0]!;
  if (field.kind !== "number") throw new Error("the altitude is a number");
  const { unit, scale } = shownUnit(field, "imperial");
  expect(unit).toBe("ft");
  expect(Number(shownValue(40, scale)) * scale).toBeCloseTo(40, 4);
});

it("setting a value changes nothing else and nothing in place", () => {
  const spec = someSpec();
  const changed = set(spec, "sensor.sigma_deg", 3);
  expect(changed.sensor.sigma_deg).toBe(3);
  expect(spec.sensor.sigma_deg).toBe(7);
  expect(changed.flight).toBe(spec.flight);
});

it("a field of the emitter sets it in its list, and leaves the other emitters alone", () => {
  const [first] = someSpec().emitters;
  const spec = { ...someSpec(), emitters: [first!, { ...first!, emitter_id: "other" }] };
  const changed = set(spec, `${EMITTER}.frequency_hz`, 1e8);
  expect(get(changed, `${EMITTER}.frequency_hz`)).toBe(1e8);
  expect(changed.emitters[1]).toBe(spec.emitters[1]);
  expect(spec.emitters[0]).toBe(first);
});

it("what is known beforehand is set for all emitters alike, and shown as the first one's", () => {
  const [first] = someSpec().emitters;
  const ring = { kind: "ring" as const, centre: { lat: 50, lon: 7 }, inner_m: 30, outer_m: 300 };
  const others = [{ ...first!, emitter_id: "other", frequency_hz: 1e8, prior: ring }];
  const spec = set({ ...someSpec(), emitters: [first!, ...others] }, PRIOR, ring);
  const changed = set(spec, `${PRIOR}.outer_m`, 200);
  const prior = { ...ring, outer_m: 200 };
  expect(changed.emitters).toEqual([
    { ...first, prior },
    { ...others[0], prior },
  ]);
  expect(get(changed, `${PRIOR}.outer_m`)).toBe(200);
  const errors = [{ field: "spec.emitters.0.prior.outer_m", reason: someReason }];
  expect(new RequestFailed({ ...localProblem("", ""), errors }).fieldMessage(`${PRIOR}.outer_m`)).not.toBeNull();
});

it("a preset changes the first emitter and is found again", () => {
  const beacon = withPreset(someSpec(), "beacon");
  expect(presetOf(beacon)).toBe("beacon");
  expect(firstEmitter(beacon)).toMatchObject({ frequency_hz: 121_500_000, kind: "carrier", prior: firstEmitter(someSpec()).prior });
  expect(presetOf(set(beacon, `${EMITTER}.kind`, "pulsed"))).toBeNull();
});
