// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { open } from "../state/open";
import { record, someSpec, started } from "../wire/examples";
import { TruthCard } from "./TruthCard";

const part = <T extends HTMLElement = HTMLElement>(name: string) => document.querySelector<T>(`[data-testid="${name}"]`);

afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
});

it("keeps a place that was written until the server has it", async () => {
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no link")));
  open(new FakeSource("m"));
  const all = record({ kind: "mission_drafted", spec: someSpec() }, started());
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  act(() => render(<TruthCard />, document.body));
  act(() => part("truth-write")!.click());
  act(() => {
    part<HTMLInputElement>("truth-place")!.value = "50.734 N 7.098 E";
    part("truth-place")!.dispatchEvent(new InputEvent("input", { bubbles: true }));
  });
  const send = () => act(async () => void part("truth-set")!.click());
  await send();
  await vi.waitFor(() => expect(part("problem-truth")).not.toBeNull());
  expect(part<HTMLInputElement>("truth-place")!.value).toBe("50.734 N 7.098 E");
  vi.stubGlobal("fetch", async () => new Response("{}", { status: 200 }));
  await send();
  await vi.waitFor(() => expect(part("truth-place")).toBeNull());
});
