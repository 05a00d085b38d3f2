// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import * as api from "../sources/api";
import { localProblem, RequestFailed, unreachable } from "../sources/problem";
import type { Mission, Reason } from "../wire";
import { someSpec } from "../wire/examples";
import { draftOnce, forgetSaving } from "./saving";

/** A server that drafts, and whose next answers are lost. */
const stored = new Map<string, string>();
let lost = 0;
let found: Partial<Mission> = {};

beforeEach(() => {
  lost = 0;
  found = { editable: true, deleted_at_utc: null };
  vi.spyOn(api, "mission").mockImplementation(async (id) => ({ mission_id: id, ...found }) as never);
  vi.spyOn(api, "draftMission").mockImplementation(async (spec, id = "") => {
    const before: Reason = { code: "drafted_before", mission_id: id };
    if (stored.has(id)) throw new RequestFailed({ ...localProblem("", "", 409), reason: before });
    stored.set(id, spec.name);
    if (lost-- > 0) throw unreachable("");
    return { mission_id: id } as never;
  });
});

afterEach(() => {
  stored.clear();
  sessionStorage.clear();
  vi.restoreAllMocks();
});

const named = (name: string) => ({ ...someSpec(), name });
const names = () => [...stored.values()];

it("drafts one mission when answers are lost and Save is pressed again and again", async () => {
  lost = 1;
  await expect(draftOnce("new", named("Meadow"))).rejects.toThrow();
  const { mission_id } = await draftOnce("new", named("Meadow"));
  expect([...stored]).toEqual([[mission_id, "Meadow"]]);
});

it("leaves what was saved without an answer alone when something else is drafted in its place, in a copied tab too", async () => {
  lost = 1;
  await expect(draftOnce("new", named("Alpha"))).rejects.toThrow();
  const copied = sessionStorage.getItem("crossfix.saving.new")!;
  await draftOnce("new", named("Bravo"));
  sessionStorage.setItem("crossfix.saving.new", copied);
  await draftOnce("new", named("Charlie"));
  expect(names()).toEqual(["Alpha", "Bravo", "Charlie"]);
});

it("drafts another mission once the first is saved or given up", async () => {
  await draftOnce("new", named("Meadow"));
  forgetSaving("new");
  await draftOnce("new", named("Meadow"));
  expect(names()).toEqual(["Meadow", "Meadow"]);
});

it.each([
  ["has flown", { editable: false }],
  ["was deleted", { deleted_at_utc: "2026-11-30T00:00:00Z" }],
])("drafts another mission where the one whose answer was lost %s since, and the same is wanted again", async (_what, since) => {
  lost = 1;
  await expect(draftOnce("new:m", named("Meadow"))).rejects.toThrow();
  const [first] = stored.keys();
  Object.assign(found, since);
  const again = await draftOnce("new:m", named("Meadow"));
  expect(names()).toEqual(["Meadow", "Meadow"]);
  expect(again.mission_id).not.toBe(first);
});
