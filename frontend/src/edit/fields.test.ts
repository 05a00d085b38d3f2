import { expect, it } from "vitest";
import { someSpec } from "../state/examples";
import { sections, shownUnit, shownValue, typedNumber } from "./fields";
import { get, set } from "./path";

it("every field of the form exists in the specification, so none edits nothing", () => {
  for (const field of sections.flatMap((s) => s.fields)) expect(get(someSpec(), field.path), field.path).not.toBeUndefined();
});

it("numbers are read as people type them", () => {
  expect(typedNumber(" 7,5 ")).toBe(7.5);
  expect(typedNumber("-3")).toBe(-3);
  expect(typedNumber(".5")).toBe(0.5);
  for (const text of ["", "seven", "1.2.3", "0x10", "1 000"]) expect(typedNumber(text)).toBeNull();
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
