// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { cursor, look } from "../state/moment";
import { open } from "../state/open";
import { flown } from "../wire/examples";
import { Timeline } from "./Timeline";

const part = (name: string) => document.querySelector<HTMLElement>(`[data-testid="${name}"]`)!;
const press = (name: string) => act(() => part(name).click());
const wait = (ms: number) => act(() => void vi.advanceTimersByTime(ms));
const isPlaying = () => part("play").textContent === "Pause";

function show(): void {
  open(new FakeSource());
  live.value = { ...live.value, events: flown };
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal(
    "ResizeObserver",
    class {
      constructor(readonly tell: () => void) {}
      observe() {
        this.tell();
      }
      disconnect() {}
    },
  );
  show();
  act(() => render(<Timeline />, document.body));
});
afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

it("stops where somebody looks elsewhere", () => {
  press("play");
  wait(3000);
  expect(isPlaying()).toBe(true);
  act(() => look(2));
  wait(3000);
  expect([cursor.value, isPlaying()]).toEqual([2, false]);
});

it("leaves another mission at its present", () => {
  press("play");
  wait(3000);
  act(show);
  wait(3000);
  expect([cursor.value, isPlaying()]).toEqual([null, false]);
});

it("plays once more from the first event when it has come to the end", () => {
  act(() => look(flown.at(-1)!.seq));
  press("play");
  wait(500);
  expect(isPlaying()).toBe(true);
  expect(cursor.value).toBeLessThan(flown.at(-1)!.seq);
});

it("follows what happens, until somebody scrolls up in the list", () => {
  const log = part("event-log");
  Object.defineProperties(log, { scrollHeight: { value: 900, configurable: true }, clientHeight: { value: 100 } });
  const bearing = flown.find(({ event }) => event.kind === "bearing_measured")!;
  const more = () =>
    act(() => {
      const { events } = live.value;
      live.value = { ...live.value, events: [...events, { ...bearing, seq: events.at(-1)!.seq + 1 }] };
    });
  const scroll = (to: number) => {
    log.scrollTop = to;
    log.dispatchEvent(new Event("scroll"));
  };
  more();
  expect(log.scrollTop).toBe(900);
  scroll(100);
  more();
  expect(log.scrollTop).toBe(100);
  scroll(800);
  more();
  expect(log.scrollTop).toBe(900);
});
