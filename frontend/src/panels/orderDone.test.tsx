// @vitest-environment happy-dom
// The bar says "done" of an order only once that one is accepted, and the vehicle is heard since.
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { t } from "../i18n";
import { accepted, FakeSource } from "../sources/fakeSource";
import type { SourceMessage } from "../sources/source";
import { open } from "../state/open";
import type { CommandReply } from "../wire";
import { CRAFT, phase, record, someCraftStatus, someSpec, someStatus } from "../wire/examples";
import { SafetyBar } from "./SafetyBar";

const EVENTS = record({ kind: "mission_drafted", spec: someSpec() }, phase("hold"));
/** The server's word, once a second, of an earlier hold. */
const HELD = someStatus({
  crafts: [
    someCraftStatus({
      craft_id: CRAFT,
      mission_id: "m",
      phase: "hold",
      order: { order: "hold", way: "hold", stage: "done", because: null },
    }),
  ],
});
const DONE = t("bar.order.done", { command: t("bar.hold") });

let source: FakeSource;
const says = () => document.querySelector("[data-testid=urgent-note]")!.textContent;
const later = (ms: number, ...messages: SourceMessage[]) =>
  act(async () => {
    source.tell(...messages);
    await vi.advanceTimersByTimeAsync(ms);
  });
const pressHold = () => act(() => document.querySelector<HTMLButtonElement>("[data-testid=hold]")!.click());

let begun = 0;
beforeEach(async () => {
  vi.useFakeTimers();
  vi.advanceTimersByTime(60_000 * ++begun); // or a press would be the second tap of the test before
  source = new FakeSource();
  open(source);
  act(() => render(<SafetyBar />, document.body));
  await later(300, ...EVENTS.map((recorded) => ({ type: "event", recorded }) as const), HELD);
});
afterEach(async () => {
  act(() => render(null, document.body));
  await vi.runOnlyPendingTimersAsync();
  vi.useRealTimers();
});

it("says so once it is accepted, and the vehicle is heard since", async () => {
  let answer = (_reply: CommandReply) => {};
  source.answer = () => new Promise((resolve) => (answer = resolve));
  pressHold();
  await later(300, HELD);
  expect(says()).not.toContain(DONE);
  answer(accepted);
  await later(300);
  expect(says()).not.toContain(DONE);
  await later(300, HELD);
  expect(says()).toContain(DONE);
  await later(5000, HELD);
  expect(says()).toBe("");
});

it("does not of a status that was told before, and waited to be shown", async () => {
  source.answer = () => Promise.resolve(accepted);
  act(() => source.tell(HELD));
  pressHold();
  await later(300);
  expect(document.querySelector("[data-testid=order-note]")?.textContent ?? "").not.toContain(DONE);
  expect(says()).not.toContain(DONE);
  await later(300, HELD);
  expect(says()).toContain(DONE);
  await later(5000, HELD);
});

it("does not where it is refused", async () => {
  source.answer = () => Promise.resolve({ ...accepted, accepted: false, reason: { code: "pilot_controls" } });
  pressHold();
  await later(300, HELD);
  expect(says()).toBe("");
});
