import { afterEach, beforeEach, expect, it, vi } from "vitest";
import * as api from "../sources/api";
import type { AreaOutlook, MissionSpec } from "../wire";
import { type Draft, draft } from "./draft";
import { askOutlook, clearOutlook, forgetOutlookOfOthers, outlook } from "./outlook";

const drawn = (margin: number): Draft => ({
  key: "area:m",
  spec: { area: { type: "MultiPolygon", coordinates: [] }, emitters: [], flight: { fence_margin_m: margin } } as unknown as MissionSpec,
  hasArea: true,
  suggested: false,
  text: {},
});
let stop: () => void;

beforeEach(() => {
  vi.spyOn(api, "areaOutlook").mockResolvedValue({ allowed: true } as AreaOutlook);
  draft.value = drawn(60);
  stop = forgetOutlookOfOthers();
});
afterEach(() => {
  stop();
  clearOutlook();
});

it("keeps what was said while the same area is drawn or stored once more", async () => {
  const asked = askOutlook("m", draft.peek()!.spec);
  draft.value = drawn(60);
  await asked;
  expect(outlook.value?.found?.allowed).toBe(true);
});

it("forgets it with another area, with a field that cannot be read, and with no draft", async () => {
  for (const after of [drawn(61), { ...drawn(60), text: { "flight.fence_margin_m": "x" } }, null]) {
    draft.value = drawn(60);
    await askOutlook("m", draft.peek()!.spec);
    expect(outlook.value).not.toBeNull();
    draft.value = after;
    expect(outlook.value).toBeNull();
  }
});
