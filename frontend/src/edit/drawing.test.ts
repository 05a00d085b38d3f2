// @vitest-environment happy-dom
import { beforeEach, expect, it, vi } from "vitest";
import { someSpec } from "../wire/examples";
import { change, draft, forgetSent, isStored, storedDraft, textBeside, update } from "./draft";
import { add, addRead, discard, replace, settledDraft, tool } from "./drawing";
import { isOfPreset } from "./presets";

const begin = (key: string, text: Record<string, string> = {}) => update({ key, spec: someSpec(), hasArea: true, suggested: false, text });

function held(): { reading: Promise<string>; come: (found: string) => void; fail: (error: Error) => void } {
  let [come, fail]: [(found: string) => void, (error: Error) => void] = [() => {}, () => {}];
  const reading = new Promise<string>((resolve, reject) => {
    come = resolve;
    fail = reject;
  });
  return { reading, come, fail };
}

const turn = () => new Promise((resolve) => setTimeout(resolve));

beforeEach(() => {
  localStorage.clear();
  tool.value = "none";
});

it("waits for the files of its own draft only, and fails as one of them", async () => {
  begin("first");
  const { reading, fail } = held();
  const read = addRead(reading, () => {});
  read.catch(() => undefined);
  begin("second");
  expect((await settledDraft())?.key).toBe("second");
  begin("first");
  const settled = settledDraft();
  fail(new Error("buy milk"));
  await expect(settled).rejects.toThrow("buy milk");
  expect((await settledDraft())?.key).toBe("first");
});

it("says nothing to a page that was left", async () => {
  begin("first");
  const { reading, fail } = held();
  addRead(reading, () => {}).catch(() => undefined);
  const settled = settledDraft();
  begin("second");
  fail(new Error("buy milk"));
  expect(await settled).toBeNull();
});

it("puts nothing into the draft that takes the place of a discarded one, but into its own when that is shown again", async () => {
  for (const [isDiscarded, puts] of [
    [true, 0],
    [false, 1],
  ] as const) {
    begin("new");
    const { reading, come } = held();
    const put = vi.fn();
    const read = addRead(reading, put);
    if (isDiscarded) discard("new");
    else begin("other");
    begin("new");
    come("meadow");
    await read;
    expect(put).toHaveBeenCalledTimes(puts);
  }
});

it("is not settled while something is being drawn", async () => {
  begin("area:1");
  tool.value = "polygon";
  await expect(settledDraft()).rejects.toThrow("press Enter to finish");
  tool.value = "corners";
  expect((await settledDraft())?.key).toBe("area:1");
  await turn();
});

it("gives the map the keys while something is being drawn, unless one has gone elsewhere", async () => {
  vi.useFakeTimers();
  document.body.innerHTML = '<div class="map-area"><canvas tabindex="0"></canvas></div><button></button><input />';
  const [canvas, button, input] = ["canvas", "button", "input"].map((name) => document.querySelector<HTMLElement>(name)!);
  begin("new");
  tool.value = "polygon";
  button!.focus();
  await expect(settledDraft()).rejects.toThrow();
  expect(document.activeElement, "the Enter that is still pressed").toBe(button);
  await vi.advanceTimersByTimeAsync(1000);
  expect(document.activeElement).toBe(canvas);
  button!.focus();
  await expect(settledDraft()).rejects.toThrow();
  input!.focus();
  await vi.advanceTimersByTimeAsync(1000);
  expect(document.activeElement).toBe(input);
  await expect(settledDraft()).rejects.toThrow();
  await vi.advanceTimersByTimeAsync(1000);
  expect(document.activeElement, "somebody types").toBe(input);
  document.body.innerHTML = "";
  vi.useRealTimers();
});

it("discards no draft but the one that is meant", () => {
  begin("area:1");
  begin("new");
  discard("area:1");
  expect(draft.value?.key).toBe("new");
  expect(storedDraft("area:1")).toBeNull();
});

it("what is replaced takes the text of its fields with it, and no other", () => {
  begin("new", { "planner.motion.speed_m_s": "1x", "planner.seed": "?" });
  change("planner.motion", { kind: "linear", speed_m_s: 7 });
  expect(draft.value!.text).toEqual({ "planner.seed": "?" });
  const left = { emitters: "15o.3 typo", "sensor.outlier_probability": "x" };
  const set = {
    "emitters.0.frequency_hz": "abc",
    "sensor.sigma_deg": "7x",
    "sensor.turn_rate_deg_s": "?",
    "sensor.measurement_time_s": "",
  };
  expect(textBeside({ ...left, ...set }, isOfPreset)).toEqual(left);
});

it("a full storage keeps nothing from being typed, and what it holds from before is not shown once the mission is saved", () => {
  begin("new");
  vi.stubGlobal("localStorage", {
    setItem: () => {
      throw new DOMException("full");
    },
  });
  change("name", "Mill");
  expect(draft.value!.spec.name).toBe("Mill");
  expect(isStored.value).toBe(false);
  vi.unstubAllGlobals();
  expect(storedDraft("new")).not.toBeNull();
  forgetSent("new", draft.value!.spec);
  expect(storedDraft("new")).toBeNull();
});

it.each([add, replace])("takes what is drawn across the antimeridian for places on earth", (take) => {
  begin("first");
  const ring = (west: number, east: number): [number, number][] => [
    [west, 50],
    [east, 50],
    [east, 51],
    [west, 50],
  ];
  take("fence", [[ring(-180.25, -179.75)]]);
  expect(draft.peek()?.spec.flight.fence).toEqual({ type: "Polygon", coordinates: [ring(179.75, -179.75)] });
});
