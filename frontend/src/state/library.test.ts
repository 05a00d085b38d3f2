import { expect, test } from "vitest";
import type { MissionSummary } from "../wire";
import { ANY, asQuery, type Library, withFirstPage, withNextPage } from "./library";

const mission = (n: number, bearings = 0) =>
  ({ mission_id: `m${n}`, drafted_at_utc: `2026-01-${String(n).padStart(2, "0")}T00:00:00Z`, bearings }) as MissionSummary;
const ids = (library: Library) => library.missions.map((m) => m.mission_id);

test("pages follow one another, and the first one is read again without a gap", () => {
  const first = withFirstPage(null, "", { missions: [mission(4), mission(3)], next: "3" });
  const both = withNextPage(first, { missions: [mission(2), mission(1)], next: null });
  expect(ids(both)).toEqual(["m4", "m3", "m2", "m1"]);
  const again = withFirstPage(both, "", { missions: [mission(5), mission(4, 7)], next: "4" });
  expect(ids(again)).toEqual(["m5", "m4", "m3", "m2", "m1"]);
  expect(again.missions[1]?.bearings).toBe(7);
  expect(again.next).toBe(null);
});

test("another name begins a list of its own", () => {
  const first = withFirstPage(null, "", { missions: [mission(4)], next: "4" });
  const further = withNextPage(first, { missions: [mission(3)], next: null });
  expect(ids(withFirstPage(further, "owl", { missions: [mission(1)], next: null }))).toEqual(["m1"]);
});

test("before a further page was read, the first page is the list: what was taken away is gone", () => {
  const first = withFirstPage(null, "", { missions: [mission(4), mission(3)], next: null });
  expect(ids(withFirstPage(first, "", { missions: [mission(3)], next: null }))).toEqual(["m3"]);
});

test("days are asked for as instants, the last one included; what is no day is not asked for", () => {
  expect(asQuery({ ...ANY, since: "2026-11-01", until: "2026-11-30" })).toEqual({
    since: "2026-11-01T00:00:00.000Z",
    until: "2026-12-01T00:00:00.000Z",
  });
  for (const day of ["", "20266-11-30", "9999-12-31"]) expect(asQuery({ ...ANY, since: day, until: day })).toEqual({});
});
