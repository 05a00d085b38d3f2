// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { open } from "../state/open";
import { ended, phase, record, someBearing, someBelief, someSpec, started } from "../wire/examples";
import { EstimatePanel } from "./EstimatePanel";

const DOUBT = { code: "not_the_measured_antenna", name: "yagi", repeats_db: 2.6, sweeps: 4 };
const ANSWER = { sweeps: 4, repeats_db: 2.6, doubt: DOUBT, proposed: { filename: "refined_in_flight.json", text: '{"a": "°"}' } };
const bearings = ["a", "b"].map((bearing_id) => someBearing({ bearing_id }));

afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
});

function show(...events: Parameters<typeof record>): string[] {
  const asked: string[] = [];
  vi.stubGlobal("fetch", (path: string) => {
    asked.push(path);
    return Promise.resolve(Response.json(ANSWER));
  });
  open(new FakeSource("m"));
  const all = record({ kind: "mission_drafted", spec: someSpec() }, started(), ...bearings, someBelief(), ...events);
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  act(() => render(<EstimatePanel />, document.body));
  return asked;
}

it("says by itself, once the flight is over, that it was not the antenna that was measured, and hands out the pattern", async () => {
  show(ended("localized"));
  await vi.waitFor(() =>
    expect(document.querySelector("[data-testid=antenna-doubt]")?.textContent).toContain("not the antenna that was measured"),
  );
  const save = document.querySelector<HTMLAnchorElement>("[data-testid=antenna-save]")!;
  expect(save.download).toBe("refined_in_flight.json");
  expect(decodeURIComponent(save.href.split(",")[1]!)).toBe('{"a": "°"}');
});

it("asks nothing while it flies", () => {
  expect(show(phase("flying"))).toEqual([]);
});

it("asks again once a bearing was left out after the flight, and not while nothing changes", async () => {
  const asked = show(ended("localized"));
  await act(async () => {});
  await act(() => {
    live.value = { ...live.value };
  });
  expect(asked).toHaveLength(1);
  const { emitter_id } = bearings[0]!;
  const at = { emitter_id, bearing_id: "a", heard: false, on_the_way: false };
  const left = { kind: "bearing_excluded", ...at, by: "operator", reason: "" } as const;
  const all = record(...live.value.events.map((one) => one.event), left, someBelief({ bearings: 1, digest: "other" }));
  await act(() => {
    live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  });
  expect(asked).toHaveLength(2);
});
