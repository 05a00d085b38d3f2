// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { t } from "../i18n";
import { FakeSource } from "../sources/fakeSource";
import { open } from "../state/open";
import { selectedEmitter } from "../state/selection";
import type { MissionEvent, SweepProgress } from "../wire";
import { CRAFT, phase, record, someBearing, someSpec, started } from "../wire/examples";
import { SweepPanel } from "./SweepPanel";

beforeEach(() => vi.useFakeTimers());
afterEach(() => {
  act(() => render(null, document.body));
  vi.useRealTimers();
});

it("shows the turn under way to one emitter after a sweep of another was picked", () => {
  const spec = someSpec();
  const emitters = ["e1", "e2"].map((emitter_id) => ({ ...spec.emitters[0]!, emitter_id }));
  const drafted: MissionEvent = { kind: "mission_drafted", spec: { ...spec, emitters } };
  const events = record(drafted, started(), someBearing({ emitter_id: "e1" }), phase("measuring"));
  const source = new FakeSource();
  open(source);
  for (const recorded of events) source.tell({ type: "event", recorded });
  const turn = { type: "sweep_progress", mission_id: events[0]!.mission_id, craft_id: CRAFT, emitter_id: "e2", place_number: 2 };
  source.tell({ ...turn, turned_deg: 90, heading_deg: [], power_db: [], sector: null } as unknown as SweepProgress);
  act(() => {
    vi.advanceTimersByTime(500);
    render(<SweepPanel />, document.body);
  });
  const select = document.querySelector("select")!;
  act(() => {
    select.value = "3";
    select.dispatchEvent(new Event("change", { bubbles: true }));
  });
  expect(document.querySelector("[data-testid=sweep-running]")).toBeNull();
  act(() => {
    selectedEmitter.value = "e2";
  });
  expect(document.querySelector("[data-testid=sweep-running]")).not.toBeNull();
});

it("shows no quality, no drift and no power of a bearing that a person entered", () => {
  const told = { sweep_id: null, quality: 1, drift_m: 0, binned_db: [], fitted_db: [], remarks: [] };
  const entered = someBearing({ ...told, source: { kind: "person", name: "Ada" } });
  const source = new FakeSource();
  open(source);
  for (const recorded of record({ kind: "mission_drafted", spec: someSpec() }, entered)) source.tell({ type: "event", recorded });
  act(() => {
    vi.advanceTimersByTime(500);
    render(<SweepPanel />, document.body);
  });
  const panel = document.querySelector("[data-testid=sweep]")!;
  expect(panel.querySelector("[data-testid=sweep-bearing]")).not.toBeNull();
  expect(panel.textContent).not.toContain(t("sweep.quality", { quality: "1.00" }));
  expect(panel.textContent).not.toContain(t("sweep.drift", { length: "0 m" }));
  expect(panel.querySelector("[data-testid=polar]")!.getAttribute("aria-label")).toBe(t("sweep.plotEmpty"));
});
