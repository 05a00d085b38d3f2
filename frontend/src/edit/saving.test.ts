// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import * as api from "../sources/api";
import { localProblem, RequestFailed, unreachable } from "../sources/problem";
import type { MissionSpec, Reason } from "../wire";
import { someSpec } from "../wire/examples";
import { draftOnce, forgetSaving } from "./saving";

/** A server that drafts and edits, and whose next answers are lost. */
const stored = new Map<string, { spec: MissionSpec; seq: number }>();
let lost = 0;

const refuse = (reason: Reason) => {
  throw new RequestFailed({ ...localProblem("", "", 409), reason });
};

const answered = (id: string) => {
  if (lost-- > 0) throw unreachable("");
  return { mission_id: id } as never;
};

beforeEach(() => {
  lost = 0;
  vi.spyOn(api, "draftMission").mockImplementation(async (spec, id = "") => {
    if (stored.has(id)) refuse({ code: "drafted_before", mission_id: id });
    stored.set(id, { spec, seq: 1 });
    return answered(id);
  });
  vi.spyOn(api, "editMission").mockImplementation(async (id, spec, fromSeq) => {
    const there = stored.get(id)!;
    if (there.spec.name === spec.name) return answered(id);
    if (there.seq !== fromSeq) refuse({ code: "edited_meanwhile", by: "anna", seq: there.seq });
    stored.set(id, { spec, seq: there.seq + 1 });
    return answered(id);
  });
});

afterEach(() => {
  stored.clear();
  sessionStorage.clear();
  vi.restoreAllMocks();
});

const named = (name: string) => ({ ...someSpec(), name });
const names = () => [...stored.values()].map(({ spec }) => spec.name);

it("drafts one mission when the answer is lost and Save is pressed again, with what has been changed since", async () => {
  lost = 1;
  await expect(draftOnce("new", named("Meadow"))).rejects.toThrow();
  await draftOnce("new", named("Mill"));
  expect(names()).toEqual(["Mill"]);
});

it("leaves what somebody else has saved of it alone", async () => {
  lost = 1;
  await expect(draftOnce("new", named("Meadow"))).rejects.toThrow();
  const [id] = stored.keys();
  stored.set(id!, { spec: named("Anna's"), seq: 5 });
  await draftOnce("new", named("Mill"));
  expect(names()).toEqual(["Anna's", "Mill"]);
});

it("drafts another mission once the first is saved or given up", async () => {
  await draftOnce("new", named("Meadow"));
  forgetSaving("new");
  await draftOnce("new", named("Mill"));
  expect(names()).toEqual(["Meadow", "Mill"]);
});

it("asks again with the same id while no answer comes", async () => {
  lost = 3;
  for (let tries = 0; tries < 3; tries++) await expect(draftOnce("new", named("Meadow"))).rejects.toThrow();
  await draftOnce("new", named("Meadow"));
  expect(names()).toEqual(["Meadow"]);
});
