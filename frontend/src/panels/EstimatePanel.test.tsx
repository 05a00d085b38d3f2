// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it } from "vitest";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { record, someBelief, someSpec, started } from "../wire/examples";
import { EstimatePanel } from "./EstimatePanel";

const text = (name: string) => document.querySelector(`[data-testid="${name}"]`)?.textContent;

function show(goalM: number | null): void {
  const all = record({ kind: "mission_drafted", spec: someSpec() }, started(), someBelief({ goal_m: goalM }));
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  act(() => render(<EstimatePanel />, document.body));
}

afterEach(() => act(() => render(null, document.body)));

it("shows the goal that was set", () => {
  show(null);
  expect(text("inside-goal")).toBe("goal 50 m");
  expect(text("moving-goal")).toBeUndefined();
});

it("shows what a claim really needs of an emitter that moves, and what was set", () => {
  show(80.4);
  expect(text("inside-goal")).toBe("goal 80.4 m");
  expect(text("moving-goal")).toContain("50 m");
});
