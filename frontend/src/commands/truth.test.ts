// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { open } from "../state/open";
import { selectedEmitter } from "../state/selection";
import { record, someSpec } from "../wire/examples";
import { problems } from "./send";
import { tapping, tell, tellHere } from "./truth";

let told: { emitter_id: string }[];
beforeEach(() => {
  told = [];
  vi.stubGlobal("fetch", async (_path: string, { body }: RequestInit) => {
    told.push(JSON.parse(String(body)) as { emitter_id: string });
    return new Response("{}", { status: 200 });
  });
  open(new FakeSource("m"));
  const spec = someSpec();
  const emitters = ["a", "b"].map((emitter_id) => ({ ...spec.emitters[0]!, emitter_id }));
  const all = record({ kind: "mission_drafted", spec: { ...spec, emitters } });
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
});
afterEach(() => vi.unstubAllGlobals());

it("is of the mission in which the tap was asked for", () => {
  tapping.value = true;
  open(new FakeSource("other"));
  expect(tapping.value).toBe(false);
});

it("is of the emitter shown when somebody said that they stand there, however late the place comes", async () => {
  let fix: PositionCallback = () => undefined;
  Object.defineProperty(navigator, "geolocation", {
    configurable: true,
    value: { getCurrentPosition: (onFix: PositionCallback) => (fix = onFix) },
  });
  const said = tellHere();
  selectedEmitter.value = "b";
  fix({ coords: { latitude: 50, longitude: 7, accuracy: 5 } } as GeolocationPosition);
  expect(await said).toBe(true);
  expect(told.map((one) => one.emitter_id)).toEqual(["a"]);
});

it("says whether it was taken", async () => {
  expect(await tell(null, "map")).toBe(true);
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no link")));
  expect(await tell(null, "map")).toBe(false);
  expect(problems.value.truth).toBeDefined();
});
