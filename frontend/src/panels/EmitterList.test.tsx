// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { live, source } from "../state/connection";
import { missionAt } from "../state/mission";
import { locale } from "../units/locale";
import type { MissionEvent } from "../wire";
import { record, someBelief, somePlan, someSpec, started } from "../wire/examples";
import { EmitterList } from "./EmitterList";

const sent = vi.fn((..._given: unknown[]) => Promise.resolve(true));
vi.mock("../commands/send", () => ({ send: (...given: unknown[]) => sent(...given), problems: { value: {} }, report: () => undefined }));

const part = (name: string) => document.querySelector<HTMLElement>(`[data-testid="${name}"]`);
const press = (name: string) => act(() => part(name)!.click());

function show(...events: MissionEvent[]): void {
  const spec = someSpec();
  const [one] = spec.emitters;
  const emitters = ["a", "b", "c"].map((id, i) => ({
    ...one!,
    emitter_id: id,
    label: `hare ${i + 1}`,
    priority: i === 1 ? 1 : null,
    frequency_hz: i === 2 ? 150.2e6 : 150.1e6,
    pulse_period_s: 1.3 - 0.25 * i,
  }));
  const all = record({ kind: "mission_drafted", spec: { ...spec, emitters } }, started(), ...events);
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  act(() => render(<EmitterList />, document.body));
}

beforeEach(() => {
  source.value = { takesCommands: true, keptByServer: true } as typeof source.value;
});
afterEach(() => {
  if (part("order")?.getAttribute("aria-expanded") === "true") press("order");
  act(() => render(null, document.body));
  sent.mockClear();
  source.value = null;
});

it("says who comes first, and how long each takes at least until it is found", () => {
  const forecasts = ["a", "b", "c"].map((emitter_id, i) => ({ emitter_id, expected_time_s: 100 * (i + 1) }));
  show(somePlan({ forecasts, first: ["b"] }), someBelief({ emitter_id: "c", localized: true }));
  expect(part("place-b")?.textContent).toBe("first");
  expect(part("place-a")).toBeNull();
  expect(part("left-a")?.textContent).toContain("≥");
  expect(part("left-c")).toBeNull();
});

it("puts what comes first at the top, and lets no row move while the order is being set", () => {
  const order = () => [...document.querySelectorAll("[data-testid^=emitter-]")].map((row) => row.getAttribute("data-testid"));
  show();
  expect(order()).toEqual(["emitter-b", "emitter-a", "emitter-c"]);
  press("order");
  expect(order()).toEqual(["emitter-a", "emitter-b", "emitter-c"]);
});

it("tells tags at one frequency apart by their periods", () => {
  show();
  expect(part("emitter-a")?.textContent).toContain("150.1 MHz, every 1.3 s");
  expect(part("emitter-b")?.textContent).toContain("150.1 MHz, every 1.05 s");
  expect(part("emitter-c")?.textContent).not.toContain("every");
});

it("marks the one that stands back", () => {
  show(somePlan({ set_back: [{ emitter_id: "b", reason: { code: "unheard_for_long", places: 3 } }] }));
  expect(part("emitter-b")?.textContent).toContain("stands back");
  expect(part("place-b")).toBeNull();
});

it("gives the whole order with each press, and offers no step that there is not", () => {
  show();
  expect(part("first-a")).toBeNull();
  press("order");
  press("first-c");
  expect(sent).toHaveBeenLastCalledWith("order", expect.any(String), { kind: "set_priorities", priorities: { c: 1, b: 2 } });
  expect(part("sooner-c")?.getAttribute("aria-disabled")).toBe("true");
  press("sooner-c");
  expect(sent).toHaveBeenCalledTimes(1);
});

it("goes on from what was pressed before the server has told it, and from the server's order after a refusal", async () => {
  show();
  press("order");
  press("sooner-c");
  expect(sent).toHaveBeenLastCalledWith("order", expect.any(String), { kind: "set_priorities", priorities: { b: 1, c: 2 } });
  press("sooner-c");
  expect(sent).toHaveBeenLastCalledWith("order", expect.any(String), { kind: "set_priorities", priorities: { b: 1, c: 1 } });
  sent.mockResolvedValueOnce(false);
  press("sooner-c");
  expect(sent).toHaveBeenLastCalledWith("order", expect.any(String), { kind: "set_priorities", priorities: { c: 1, b: 2 } });
  await act(() => Promise.resolve());
  press("later-b");
  expect(sent).toHaveBeenLastCalledWith("order", expect.any(String), { kind: "set_priorities", priorities: {} });
});

it("takes no orders for a recording", () => {
  source.value = { takesCommands: false } as typeof source.value;
  show();
  expect(part("order")).toBeNull();
  expect(part("place-b")?.textContent).toBe("first");
});

it("goes on from another's order that came after its own, however both were told", async () => {
  show();
  press("order");
  press("first-a");
  await act(() => Promise.resolve());
  show(
    { kind: "priorities_changed", priorities: { a: 1, b: 2 }, by: "o" },
    { kind: "priorities_changed", priorities: { c: 1, b: 2 }, by: "o" },
  );
  expect(part("place-c")?.textContent).toBe("first");
  press("first-b");
  expect(sent).toHaveBeenLastCalledWith("order", expect.any(String), { kind: "set_priorities", priorities: { b: 1, c: 2 } });
});

it("builds on its second step while the event of the first arrives", async () => {
  show();
  press("order");
  press("sooner-c");
  press("sooner-c");
  await act(() => Promise.resolve());
  show({ kind: "priorities_changed", priorities: { b: 1, c: 2 }, by: "o" });
  press("sooner-c");
  expect(sent).toHaveBeenLastCalledWith("order", expect.any(String), { kind: "set_priorities", priorities: { c: 1, b: 2 } });
});

it("writes numbers as the page's language does", () => {
  locale.value = "de";
  show();
  expect(part("emitter-a")?.textContent).toContain("150,1 MHz, every 1,3 s");
  locale.value = "en";
});
