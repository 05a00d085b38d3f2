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
import { phase, record, someSpec, started } from "../wire/examples";
import { FlyPage } from "./FlyPage";

const part = (name: string) => document.querySelector<HTMLElement>(`[data-testid="${name}"]`);
const drafted: MissionEvent = { kind: "mission_drafted", spec: someSpec() };
const checked = vi.fn(() => Promise.resolve({ passed: true, checks: [] }));

function show(changes: Partial<FakeSource>, ...events: MissionEvent[]): void {
  const all = record(drafted, ...events);
  open(Object.assign(new FakeSource(), { preflight: checked }, changes));
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  act(() => render(<FlyPage />, document.body));
}

beforeEach(() => void vi.stubGlobal("fetch", () => new Promise(() => undefined)));
afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
  checked.mockClear();
});

it("runs the checklist of a draft", () => {
  show({});
  expect(part("preflight")).not.toBeNull();
  expect(checked).toHaveBeenCalledOnce();
});

it("runs no checklist where a flight is looked back at", () => {
  show({}, started(), phase("flying"));
  act(() => look(1));
  expect(part("preflight")).toBeNull();
  expect(checked).not.toHaveBeenCalled();
});

it("runs no checklist in a recording", () => {
  show({ takesCommands: false });
  expect(part("preflight")).toBeNull();
  expect(checked).not.toHaveBeenCalled();
});
