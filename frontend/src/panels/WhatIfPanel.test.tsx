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

it("asks about the emitter shown", async () => {
  const asked: unknown[] = [];
  vi.stubGlobal("fetch", (_path: string, { body }: RequestInit) => {
    asked.push((JSON.parse(String(body)) as { emitter_id: unknown }).emitter_id);
    return Promise.reject(new TypeError("no link"));
  });
  open(new FakeSource("m"));
  const spec = someSpec();
  const emitters = ["a", "b"].map((emitter_id) => ({ ...spec.emitters[0]!, emitter_id }));
  const all = record({ kind: "mission_drafted", spec: { ...spec, emitters } }, started());
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  selectedEmitter.value = "b";
  act(() => render(<WhatIfPanel />, document.body));
  act(() => document.querySelector<HTMLButtonElement>("[data-testid=what-if-ask]")!.click());
  await vi.waitFor(() => expect(asked).toEqual(["b"]));
});
