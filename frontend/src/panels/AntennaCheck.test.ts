// @vitest-environment happy-dom
import { expect, it } from "vitest";
import { knownEmitter } from "./AntennaCheck";

it("takes a bearing or a place, and nothing else", () => {
  expect(knownEmitter(" 120 ")).toEqual({ bearing_deg: 120 });
  expect(knownEmitter("360")).toEqual({ bearing_deg: 0 });
  expect(knownEmitter("7,5°")).toEqual({ bearing_deg: 7.5 });
  expect(knownEmitter("50.6 7.2")).toEqual({ place: { lat: 50.6, lon: 7.2 } });
  expect(knownEmitter("400")).toBeNull();
  expect(knownEmitter("north")).toBeNull();
});
