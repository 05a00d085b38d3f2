import { expect, it } from "vitest";
import { someSpec } from "../wire/examples";
import { groupsOf, importanceWords, inOrder, move, placeOf, putFirst } from "./importance";

const [one] = someSpec().emitters;
const emitters = (...priorities: (number | null)[]) =>
  priorities.map((priority, i) => ({ ...one!, emitter_id: `e${i + 1}`, label: `hare ${i + 1}`, priority }));

const groups = (before: ReturnType<typeof emitters>, priorities: ReturnType<typeof move>) => groupsOf(inOrder(before, priorities!));

it("numbers may be missing or skip: the order is what counts, and none comes last", () => {
  expect(groupsOf(emitters(7, null, 3, 7))).toEqual([["e3"], ["e1", "e4"], ["e2"]]);
  expect(groupsOf(emitters(null, null))).toEqual([["e1", "e2"]]);
  expect(groupsOf(emitters(2, 2))).toEqual([["e1", "e2"]]);
});

it("a place is said where there is an order, and not of the last", () => {
  expect(["e1", "e2", "e3"].map((id) => placeOf(emitters(5, 5, null), id))).toEqual([1, 1, null]);
  expect(placeOf(emitters(1, 1), "e1")).toBeNull();
});

it("first is ahead of all others, who keep their order", () => {
  expect(groups(emitters(1, 2, null, null), putFirst(emitters(1, 2, null, null), "e3"))).toEqual([["e3"], ["e1"], ["e2"], ["e4"]]);
  expect(putFirst(emitters(null, null, null), "e2")).toEqual({ e2: 1 });
  expect(putFirst(emitters(1, null), "e1")).toEqual({ e1: 1 });
});

it("half a step leaves those alike, or joins the next; each is undone by its opposite", () => {
  const alike = emitters(null, null, null);
  const led = move(alike, "e2", "sooner");
  expect(led).toEqual({ e2: 1 });
  expect(move(inOrder(alike, led!), "e2", "later")).toEqual({});
  expect(move(inOrder(alike, led!), "e2", "sooner")).toBeNull();
  const tied = move(inOrder(alike, led!), "e1", "sooner");
  expect(groups(alike, tied)).toEqual([["e2"], ["e1"], ["e3"]]);
  expect(groups(alike, move(inOrder(alike, tied!), "e1", "sooner"))).toEqual([["e1", "e2"], ["e3"]]);
  expect(move(alike, "e3", "later")).toEqual({ e1: 1, e2: 1 });
  expect(move(inOrder(alike, { e1: 1, e2: 1 }), "e3", "later")).toBeNull();
});

it("the order in words names every group", () => {
  expect(importanceWords(emitters(null, null, null), { e3: 1 })).toBe("hare 3, then the others");
  expect(importanceWords(emitters(null, null, null), { e3: 1, e1: 2, e2: 2 })).toBe("hare 3, then hare 1 and hare 2");
  expect(importanceWords(emitters(null, null), {})).toBe("all alike");
});
