import { beforeEach, expect, it } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { localProblem, unreachable } from "../sources/problem";
import { open } from "../state/open";
import { problems, report, send } from "./send";

let source: FakeSource;
beforeEach(() => {
  source = new FakeSource("m");
  open(source);
});

it("leaves what was refused behind when another mission opens, but for the bar", () => {
  report("bar", localProblem("no", ""));
  report("plan", localProblem("no", ""));
  open(new FakeSource("other"));
  expect(Object.keys(problems.value)).toEqual(["bar"]);
});

it("tells a late no only where the order was given", async () => {
  problems.value = {};
  source.answer = () => Promise.reject(unreachable("no link"));
  const [plan, bar] = [send("plan", "m", { kind: "accept" }), send("bar", "m", { kind: "resume" })];
  open(new FakeSource("other"));
  expect([await plan, await bar]).toEqual([false, false]);
  expect(Object.keys(problems.value)).toEqual(["bar"]);
});
