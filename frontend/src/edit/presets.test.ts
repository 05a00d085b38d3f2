import { expect, it } from "vitest";
import { someSpec } from "../wire/examples";
import { presetNames, presetOf, withPreset } from "./presets";

it.each(presetNames)("%s is known again by its values, and no longer once one of them was changed", (name) => {
  const spec = withPreset(someSpec(), name);
  expect(presetOf(spec)).toBe(name);
  const { sensor } = spec;
  for (const changed of [
    { sigma_deg: sensor.sigma_deg + 1 },
    { measurement_time_s: sensor.measurement_time_s + 1 },
    { turn_rate_deg_s: sensor.turn_rate_deg_s - 1 },
  ])
    expect(presetOf({ ...spec, sensor: { ...sensor, ...changed } })).toBeNull();
});

it.each(presetNames)("%s leaves the frequencies and names of a list as they are", (name) => {
  const [first] = someSpec().emitters;
  const emitters = [first!, { ...first!, emitter_id: "other", frequency_hz: 150_250_000, label: "lynx" }];
  const spec = withPreset({ ...someSpec(), emitters }, name);
  expect(spec.emitters).toEqual(emitters.map((one) => ({ ...one, kind: spec.emitters[0]!.kind })));
  expect(presetOf(spec)).toBe(name);
});
