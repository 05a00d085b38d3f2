// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { open } from "../state/open";
import { selectedEmitter } from "../state/selection";
import { record, someSpec, started } from "../wire/examples";
import { WhatIfPanel } from "./WhatIfPanel";

afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
});

it("asks about the emitter shown, and what is chosen otherwise than it was flown", async () => {
  const asked: unknown[] = [];
  vi.stubGlobal("fetch", (_path: string, { body }: RequestInit) => {
    const { emitter_id, sweep_evidence, estimator, method } = JSON.parse(String(body)) as Record<string, unknown>;
    asked.push({ emitter_id, sweep_evidence, estimator, method });
    return Promise.reject(new TypeError("no link"));
  });
  open(new FakeSource("m"));
  const spec = someSpec();
  const emitters = ["a", "b"].map((emitter_id) => ({ ...spec.emitters[0]!, emitter_id }));
  const all = record({ kind: "mission_drafted", spec: { ...spec, emitters } }, started());
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  selectedEmitter.value = "b";
  act(() => render(<WhatIfPanel />, document.body));
  const part = <T extends HTMLElement>(name: string) => document.querySelector<T>(`[data-testid=what-if-${name}]`)!;
  const ask = async (expected: unknown) => {
    act(() => part<HTMLButtonElement>("ask").click());
    await vi.waitFor(() => expect(asked.at(-1)).toEqual(expected));
  };
  await ask({ emitter_id: "b", sweep_evidence: null, estimator: null });
  const choose = (name: string, value: string) => {
    part<HTMLSelectElement>(name).value = value;
    part(name).dispatchEvent(new Event("change", { bubbles: true }));
  };
  act(() => choose("evidence", "peak"));
  act(() => choose("planner", "halving"));
  await ask({ emitter_id: "b", sweep_evidence: "peak", estimator: null, method: "rollout" });
});
