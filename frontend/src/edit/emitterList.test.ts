import { expect, it } from "vitest";
import { someSpec } from "../wire/examples";
import { listOf, MOST_EMITTERS, readList } from "./emitterList";

const [first] = someSpec().emitters;
const before = [{ ...first!, emitter_id: "emitter-1", frequency_hz: 150_000_000, label: "tag", priority: null }];

it("a pasted list becomes emitters in its order, each under an id of its own", () => {
  const { emitters, bad } = readList("150.125 vixen\r\n\n 150,250;boar 3\n868300 kHz\n150.0\n", before);
  expect(bad).toEqual([]);
  expect(emitters.map((e) => [e.emitter_id, e.frequency_hz, e.label])).toEqual([
    ["emitter-2", 150_125_000, "vixen"],
    ["emitter-3", 150_250_000, "boar 3"],
    ["emitter-4", 868_300_000, "tag"],
    ["emitter-1", 150_000_000, "tag"],
  ]);
});

it("what is shown is read as the same emitters", () => {
  const { emitters } = readList("150.1251 a\n151.5 b c", before);
  expect(readList(listOf(emitters), emitters)).toEqual({ emitters, bad: [] });
});

it("a name that begins like a unit or a period stays a name", () => {
  const labels = ["GHz jammer", "hz", "/2 fox", "hzarbor", "GHz-band"];
  const named = labels.map((label, i) => ({ ...before[0]!, emitter_id: `emitter-${i + 1}`, frequency_hz: 868_300_000 + i * 1e5, label }));
  expect(listOf(named).split("\n")[0]).toBe("868.3: GHz jammer");
  expect(readList(listOf(named), named)).toEqual({ emitters: named, bad: [] });
});

it("a comma with a space parts the name from the frequency", () => {
  const { emitters, bad } = readList("150.100, lynx\n150,2, boar\n150.3,hare\n868.3 GHz, jammer", before);
  expect(bad).toEqual([]);
  expect(emitters.map((e) => [e.frequency_hz, e.label])).toEqual([
    [150_100_000, "lynx"],
    [150_200_000, "boar"],
    [150_300_000, "hare"],
    [868_300_000_000, "jammer"],
  ]);
});

it("a frequency that stays keeps its prior and its rhythm", () => {
  const known = [{ ...before[0]!, emitter_id: "mine", pulse_period_s: 2.5 }];
  const { emitters } = readList("151\n150 renamed", known);
  expect(emitters[1]).toEqual({ ...known[0], label: "renamed" });
});

it("a number behind ! puts it in the order of importance, and without one it comes last", () => {
  const { emitters, bad } = readList("150.1 vixen !2\n150.2 !1\n150.3 hare!1\n150.4 boar", [{ ...before[0]!, priority: 1 }]);
  expect(bad).toEqual([]);
  expect(emitters.map(({ label, priority }) => [label, priority])).toEqual([
    ["vixen", 2],
    ["tag", 1],
    ["hare!1", null],
    ["boar", null],
  ]);
  expect(readList(listOf(emitters), emitters)).toEqual({ emitters, bad: [] });
  const wrong = readList("150.1 a !0\n150.2 b !33\n150.3 c !999999999", before).bad;
  expect(wrong.map(({ line, problem }) => [line, problem])).toEqual([1, 2, 3].map((line) => [line, "edit.list.bad.priority"]));
});

it("every bad line is named with what is wrong with it", () => {
  const { bad } = readList("150.1\nvixen 150.2\n-3\n0\n150.1 again\n1.2.3\n2000 GHz", before);
  expect(bad.map(({ line, problem }) => [line, problem])).toEqual([
    [2, "edit.list.bad.frequency"],
    [3, "edit.list.bad.frequency"],
    [4, "edit.list.bad.range"],
    [5, "edit.list.bad.twice"],
    [6, "edit.list.bad.frequency"],
    [7, "edit.list.bad.range"],
  ]);
});

it("more emitters than a search may have are refused, not cut off in silence", () => {
  const lines = Array.from({ length: MOST_EMITTERS + 2 }, (_, i) => String(150 + i / 100)).join("\n");
  const { emitters, bad } = readList(lines, before);
  expect(emitters).toHaveLength(MOST_EMITTERS);
  expect(bad.map((b) => b.problem)).toEqual(["edit.list.bad.many", "edit.list.bad.many"]);
});

it("tags at one frequency are distinguished by the period behind the slash, and shown with it", () => {
  const { emitters, bad } = readList("150.1/1.3 vixen\n150,1 / 1,05 s cub\n151/1.3", before);
  expect(bad).toEqual([]);
  expect(emitters.map((e) => [e.frequency_hz, e.kind, e.pulse_period_s, e.label])).toEqual([
    [150_100_000, "pulsed", 1.3, "vixen"],
    [150_100_000, "pulsed", 1.05, "cub"],
    [151_000_000, "pulsed", 1.3, "tag"],
  ]);
  expect(listOf(emitters).split("\n")[1]).toBe("150.1/1.05 cub");
  const again = readList(listOf(emitters), emitters);
  expect(again).toEqual({ emitters, bad: [] });
});

it("one frequency and period twice, or a period that cannot be, is a bad line", () => {
  const { bad } = readList("150.1/1.3\n150.1/1.30 again\n150.2/0\n150.2/61\n150.2/x\n150.3/1.3/2", before);
  expect(bad.map(({ line, problem }) => [line, problem])).toEqual([
    [2, "edit.list.bad.twice"],
    [3, "edit.list.bad.period"],
    [4, "edit.list.bad.period"],
    [5, "edit.list.bad.frequency"],
    [6, "edit.list.bad.frequency"],
  ]);
});
