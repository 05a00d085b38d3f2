// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { localProblem } from "../sources/problem";
import { EXPIRES_S, HOLD_MS, SlideToConfirm } from "./SlideToConfirm";
import { problems, report } from "./send";

const onConfirm = vi.fn();
const onCancel = vi.fn();
const WIDTH_PX = 300;
const HEIGHT_PX = 50;

const slide = () => document.querySelector<HTMLElement>("[data-testid=slide]")!;
const knob = () => document.querySelector<HTMLElement>(".slide-knob")!;

function show(): void {
  act(() => render(<SlideToConfirm label="go" testId="slide" onConfirm={onConfirm} onCancel={onCancel} />, document.body));
  Object.defineProperty(slide(), "clientWidth", { value: WIDTH_PX });
  Object.defineProperty(slide(), "clientHeight", { value: HEIGHT_PX });
  knob().setPointerCapture = () => undefined;
}

function drag(share: number, end: "pointerup" | "pointercancel" = "pointerup"): void {
  const x = 10 + share * (WIDTH_PX - HEIGHT_PX);
  for (const [type, clientX] of [["pointerdown", 10], ["pointermove", x], [end, x]] as const) // biome-ignore format: one gesture
    act(() => void knob().dispatchEvent(new PointerEvent(type, { clientX, bubbles: true })));
}

/** The event's own time counts, not when it is heard. */
const key = (type: "keydown" | "keyup", name: string, atMs: number) => {
  const event = new KeyboardEvent(type, { key: name, bubbles: true });
  Object.defineProperty(event, "timeStamp", { value: atMs });
  act(() => void slide().dispatchEvent(event));
};

const wait = (ms: number) => act(() => void vi.advanceTimersByTime(ms));

beforeEach(() => {
  vi.useFakeTimers();
  vi.resetAllMocks();
});
afterEach(() => {
  act(() => render(null, document.body));
  vi.useRealTimers();
});

describe("drawn by its knob", () => {
  it("confirms at the end of the way, once", () => {
    show();
    drag(1);
    drag(1);
    expect(onConfirm).toHaveBeenCalledOnce();
  });

  it.each([0, 0.5, 0.9])("springs back after %d of the way", (share) => {
    show();
    drag(share);
    expect(onConfirm).not.toHaveBeenCalled();
    expect(slide().getAttribute("aria-valuenow")).toBe("0");
  });

  it("confirms nothing when the gesture breaks off", () => {
    show();
    drag(1, "pointercancel");
    expect(onConfirm).not.toHaveBeenCalled();
  });
});

describe("held by the space bar", () => {
  it("confirms after the full time, while the key is still down", () => {
    show();
    key("keydown", " ", performance.now());
    wait(HOLD_MS + 50);
    expect(onConfirm).toHaveBeenCalledOnce();
  });

  it("confirms when the key was held long enough, although no frame was drawn", () => {
    show();
    key("keydown", " ", 1_000);
    key("keyup", " ", 1_000 + HOLD_MS);
    expect(onConfirm).toHaveBeenCalledOnce();
  });

  it("confirms nothing when the key comes up too early, or the focus goes", () => {
    show();
    key("keydown", " ", 1_000);
    key("keyup", " ", 1_000 + HOLD_MS - 100);
    key("keydown", " ", performance.now());
    act(() => void slide().dispatchEvent(new FocusEvent("blur")));
    wait(2 * HOLD_MS);
    expect(onConfirm).not.toHaveBeenCalled();
  });
});

it("can be drawn again once its own order is answered, whatever becomes of others", async () => {
  let answer = () => {};
  onConfirm.mockImplementation(() => new Promise<void>((resolve) => (answer = resolve)));
  report("plan", localProblem("no link", ""));
  show();
  drag(1);
  act(() => report("bar", localProblem("no link", "")));
  act(() => {
    problems.value = {};
  });
  wait(2 * EXPIRES_S * 1000);
  drag(1);
  expect(onConfirm).toHaveBeenCalledOnce();
  expect(onCancel).not.toHaveBeenCalled();
  await act(async () => answer());
  expect(slide().getAttribute("aria-valuenow")).toBe("0");
  drag(1);
  expect(onConfirm).toHaveBeenCalledTimes(2);
  await act(async () => answer());
  wait((EXPIRES_S + 1) * 1000);
  expect(onCancel).toHaveBeenCalled();
});

it("goes away with Escape, and by itself when it is left alone", () => {
  show();
  key("keydown", "Escape", 0);
  expect(onCancel).toHaveBeenCalledOnce();
  wait((EXPIRES_S - 1) * 1000);
  expect(onCancel).toHaveBeenCalledOnce();
  wait(2_000);
  expect(onCancel).toHaveBeenCalledTimes(2);
});

it("does not expire under a finger", () => {
  show();
  act(() => void knob().dispatchEvent(new PointerEvent("pointerdown", { clientX: 10, bubbles: true })));
  wait(2 * EXPIRES_S * 1000);
  expect(onCancel).not.toHaveBeenCalled();
});
