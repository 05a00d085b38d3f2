// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { look } from "../state/moment";
import { open } from "../state/open";
import type { MissionEvent } from "../wire";
import { CRAFT, ended, phase, record, someCraftStatus, someReason, someSpec, someStatus, started } from "../wire/examples";
import { AlertBanner } from "./AlertBanner";

const raised: MissionEvent = {
  kind: "alert_raised",
  alert_id: "a",
  topic: "battery",
  craft_id: null,
  emitter_id: null,
  level: "warning",
  reason: someReason,
};

/** How many buttons stand on the banner. */
function offered(seq: number | null, ...after: MissionEvent[]): number {
  const all = record({ kind: "mission_drafted", spec: someSpec() }, started(), raised, phase("flying"), ...after);
  open(new FakeSource());
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  look(seq);
  act(() => render(<AlertBanner />, document.body));
  expect(document.querySelector("[data-testid=alert-banner]")).not.toBeNull();
  return document.querySelectorAll("button").length;
}

beforeEach(() => {
  const silent = { observe: () => {}, disconnect: () => {} };
  vi.stubGlobal("ResizeObserver", function ResizeObserver() {
    return silent;
  });
});
afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
});

it("lets an alert be acknowledged while the flight lasts, not when it is looked back at", () => {
  expect(offered(null)).toBe(1);
  expect(offered(3)).toBe(0);
  expect(offered(null, ended("aborted"))).toBe(0);
});

it("acknowledges nothing by the second tap on the alert before", () => {
  const source = new FakeSource();
  const all = record({ kind: "mission_drafted", spec: someSpec() }, started(), raised, { ...raised, alert_id: "b" }, phase("flying"));
  const show = (...more: MissionEvent[]) => {
    const events = [...all, ...record(...more).map((one, i) => ({ ...one, seq: all.length + 1 + i }))];
    live.value = { ...live.value, mission: missionAt(events, Number.POSITIVE_INFINITY), events };
    act(() => render(<AlertBanner />, document.body));
  };
  const tap = (atMs: number) => {
    const click = new MouseEvent("click", { bubbles: true });
    Object.defineProperty(click, "timeStamp", { value: atMs });
    act(() => void document.querySelector("button")!.dispatchEvent(click));
  };
  const send = vi.spyOn(source, "send");
  open(source);
  vi.spyOn(performance, "now").mockReturnValue(1000);
  show();
  tap(3000);
  const [, first] = send.mock.lastCall!;
  vi.spyOn(performance, "now").mockReturnValue(3100);
  show({ kind: "alert_acknowledged", alert_id: (first as { alert_id: string }).alert_id, by: "o" });
  tap(3250);
  expect(send).toHaveBeenCalledOnce();
  tap(5000);
  expect(send).toHaveBeenCalledTimes(2);
});

it("tells how much the receiver loses now, and how much it lost when that is looked back at", () => {
  const losing: MissionEvent = { ...raised, topic: "receiver", craft_id: CRAFT, reason: { code: "samples_lost", lost_percent: 8 } };
  offered(null, losing);
  const status = someStatus({ crafts: [someCraftStatus({ craft_id: CRAFT, receiver: "ok", receiver_lost_percent: 31 })] });
  const shown = () => document.querySelector("[data-testid=alert-banner]")!.textContent;
  act(() => {
    live.value = { ...live.value, status: { value: status, atMs: performance.now() } };
  });
  look(null);
  act(() => render(<AlertBanner />, document.body));
  expect(shown()).toMatch(/lost 31\s%/);
  look(5);
  act(() => render(<AlertBanner />, document.body));
  expect(shown()).toMatch(/lost 8\s%/);
});
