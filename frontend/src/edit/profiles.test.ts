// @vitest-environment happy-dom
import { expect, it } from "vitest";
import { someSpec } from "../wire/examples";
import { set } from "./path";
import { profileOf, profiles, readProfiles, removeProfile, saveProfile, withProfile } from "./profiles";

it("brings the equipment's values back and leaves the search alone", () => {
  const flown = set(set(someSpec(), "sensor.sigma_deg", 3), "flight.speed_m_s", 12);
  const fresh = { ...someSpec(), name: "another" };
  const taken = withProfile(fresh, profileOf(flown, "quad"));
  expect(taken.sensor.sigma_deg).toBe(3);
  expect(taken.flight.speed_m_s).toBe(12);
  expect(taken.name).toBe("another");
  expect(taken.flight.fence_margin_m).toBe(fresh.flight.fence_margin_m);
});

it("keeps one profile a name, in the browser's storage", () => {
  saveProfile(profileOf(someSpec(), "quad"));
  saveProfile(profileOf(set(someSpec(), "sensor.sigma_deg", 5), "quad"));
  expect(profiles.value.map((p) => [p.name, p.sensor.sigma_deg])).toEqual([["quad", 5]]);
  expect(readProfiles(localStorage.getItem("crossfix.profiles"))).toEqual(profiles.value);
  removeProfile("quad");
  expect(profiles.value).toEqual([]);
});

it("bears a storage that holds something else", () => {
  for (const stored of [null, "{", "7", '[{"name":1}]']) expect(readProfiles(stored)).toEqual([]);
});
