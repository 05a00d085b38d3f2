// @vitest-environment happy-dom
import { expect, it, vi } from "vitest";
import { someSpec } from "../wire/examples";
import { textBeside } from "./draft";
import { set } from "./path";
import {
  areStored,
  isSetBy,
  learned,
  learnInto,
  profileOf,
  profiles,
  readProfiles,
  removeProfile,
  saveProfile,
  takeBack,
  withProfile,
} from "./profiles";

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

it("keeps what another tab saved meanwhile", () => {
  const key = "crossfix.profiles";
  saveProfile(profileOf(someSpec(), "quad"));
  localStorage.setItem(key, JSON.stringify([...profiles.value, profileOf(someSpec(), "plane")]));
  saveProfile(profileOf(someSpec(), "heli"));
  expect(profiles.value.map((p) => p.name)).toEqual(["heli", "plane", "quad"]);
  localStorage.setItem(key, JSON.stringify([...profiles.value, profileOf(someSpec(), "rover")]));
  for (const name of ["heli", "plane", "quad"]) removeProfile(name);
  expect(profiles.value.map((p) => p.name)).toEqual(["rover"]);
  removeProfile("rover");
});

it("what could not be stored joins what other tabs stored, and is stored with it later", () => {
  const key = "crossfix.profiles";
  const names = () => profiles.value.map((p) => p.name);
  const inStorage = () => readProfiles(localStorage.getItem(key)).map((p) => p.name);
  saveProfile(profileOf(someSpec(), "quad"));
  const kept = localStorage.getItem(key);
  const setItem = () => {
    throw new DOMException("full");
  };
  vi.stubGlobal("localStorage", { getItem: () => kept, setItem });
  saveProfile(profileOf(someSpec(), "heli"));
  removeProfile("quad");
  vi.unstubAllGlobals();
  expect([names(), areStored.value]).toEqual([["heli"], false]);
  localStorage.setItem(key, JSON.stringify([...readProfiles(localStorage.getItem(key)), profileOf(someSpec(), "plane")]));
  dispatchEvent(new StorageEvent("storage", { key: "crossfix.settings" }));
  expect(names()).toEqual(["heli"]);
  dispatchEvent(new StorageEvent("storage", { key }));
  expect(names()).toEqual(["heli", "plane"]);
  saveProfile(profileOf(someSpec(), "rover"));
  expect(inStorage()).toEqual(["heli", "plane", "rover"]);
  for (const name of inStorage()) removeProfile(name);
});

it("what could not be stored gives way to what another tab saved or removed later", () => {
  const key = "crossfix.profiles";
  const one = (sigma: number) => profileOf(set(someSpec(), "sensor.sigma_deg", sigma), "one");
  const unstored = (sigma: number) => {
    const kept = localStorage.getItem(key);
    const setItem = () => {
      throw new DOMException("full");
    };
    vi.stubGlobal("localStorage", { getItem: () => kept, setItem });
    saveProfile(one(sigma));
    vi.unstubAllGlobals();
  };
  const elsewhere = (next: object[]) => {
    const oldValue = localStorage.getItem(key);
    localStorage.setItem(key, JSON.stringify(next));
    dispatchEvent(new StorageEvent("storage", { key, oldValue, newValue: localStorage.getItem(key) }));
  };
  saveProfile(one(1));
  unstored(5);
  elsewhere([one(1), profileOf(someSpec(), "two")]);
  expect(profiles.value.map((p) => [p.name, p.sensor.sigma_deg])[0]).toEqual(["one", 5]);
  expect(areStored.value).toBe(false);
  elsewhere([one(7)]);
  expect(profiles.value.map((p) => [p.name, p.sensor.sigma_deg])).toEqual([["one", 7]]);
  expect(areStored.value).toBe(true);
  unstored(5);
  elsewhere([]);
  saveProfile(profileOf(someSpec(), "three"));
  expect(readProfiles(localStorage.getItem(key)).map((p) => p.name)).toEqual(["three"]);
  removeProfile("three");
});

it("takes the place of what was typed in its own fields only", () => {
  const left = { emitters: "15o.3 typo", "flight.fence_margin_m": "wide" };
  const set = { "flight.speed_m_s": "fast", "sensor.sigma_deg": "x", "planner.motion.turn_rate_deg_s": "?" };
  expect(textBeside({ ...left, ...set }, (path) => isSetBy(profileOf(someSpec(), "quad"), path))).toEqual(left);
});

it("bears a storage that holds something else", () => {
  for (const stored of [null, "{", "7", '[{"name":1}]']) expect(readProfiles(stored)).toEqual([]);
});

const suggested = {
  sigma_deg: 4.2,
  outlier_probability: 0.08,
  offset_deg: -6.5,
  offset_std_error_deg: 0.9,
  speed_m_s: null,
  constant_s: null,
};

it("takes all of a suggestion over, the offset once however often, and gives it back", () => {
  saveProfile(profileOf(set(someSpec(), "sensor.bearing_offset_deg", 2), "quad"));
  learnInto("quad", suggested);
  learnInto("quad", suggested);
  const [profile] = profiles.value;
  expect(withProfile(someSpec(), profile!).sensor).toMatchObject({ sigma_deg: 4.2, outlier_probability: 0.08, bearing_offset_deg: -6.5 });
  expect(profile!.history!.map((change) => change.sensor.bearing_offset_deg)).toEqual([-6.5, 2]);
  expect(readProfiles(localStorage.getItem("crossfix.profiles"))).toEqual(profiles.value);
  takeBack("quad");
  takeBack("quad");
  expect(profiles.value[0]!.sensor.bearing_offset_deg).toBe(2);
  removeProfile("quad");
});

it("an older profile takes nothing off bearings, whichever was chosen before it", () => {
  const { bearing_offset_deg: _unsaid, ...sensor } = someSpec().sensor;
  const older = { ...profileOf(someSpec(), "older"), sensor, history: [{ at: "2026-11-01", sensor, motion: someSpec().planner.motion }] };
  const [read] = readProfiles(JSON.stringify([older]));
  const turned = set(someSpec(), "sensor.bearing_offset_deg", 6);
  expect(withProfile(turned, read!).sensor.bearing_offset_deg).toBe(0);
  expect(learned(read!, suggested, "2026-11-23").history!.map((change) => change.sensor.bearing_offset_deg)).toEqual([0, 0]);
});
