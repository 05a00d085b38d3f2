// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { beforeEach, expect, it, vi } from "vitest";
import { problems, report, send } from "../commands/send";
import { localProblem } from "../sources/problem";
import { CountButton } from "./CountButton";

vi.mock("../commands/send", async (actual) => ({ ...(await actual<typeof import("../commands/send")>()), send: vi.fn() }));

const show = (leftOut: boolean, of = "b") =>
  act(() => render(<CountButton id="m" of={of} leftOut={leftOut} words="sweep.include" />, document.body));

function tap(atMs: number): Promise<void> {
  const click = new MouseEvent("click", { bubbles: true });
  Object.defineProperty(click, "timeStamp", { value: atMs });
  return act(async () => {
    document.querySelector("button")!.dispatchEvent(click);
  });
}

beforeEach(() => {
  vi.mocked(send).mockReset();
  act(() => render(null, document.body));
});

it("sends once until the server has told it, and does not undo it by a second tap", async () => {
  vi.mocked(send).mockResolvedValue(true);
  show(false);
  await tap(1000);
  await tap(4000);
  show(true);
  await tap(1400);
  expect(send).toHaveBeenCalledOnce();
  await tap(5000);
  expect(vi.mocked(send).mock.lastCall![2].kind).toBe("include_bearing");
});

it("sends again what was refused", async () => {
  vi.mocked(send).mockResolvedValue(false);
  show(false);
  await tap(1000);
  await tap(2000);
  expect(send).toHaveBeenCalledTimes(2);
});

const refuseOnce = () =>
  vi.mocked(send).mockImplementationOnce(async () => {
    report("sweep", localProblem("excluded already", ""));
    return false;
  });

it("says no more that it was refused once the news shows what was wanted", async () => {
  refuseOnce();
  show(false);
  await tap(1000);
  expect(problems.value.sweep).toBeDefined();
  show(true);
  expect(problems.value.sweep).toBeUndefined();
});

it("leaves the note of another order, and of another bearing", async () => {
  refuseOnce();
  show(false);
  await tap(1000);
  const other = localProblem("the other one", "");
  act(() => report("sweep", other));
  show(true);
  expect(problems.value.sweep).toBe(other);
  refuseOnce();
  await tap(2000);
  show(true, "next");
  expect(problems.value.sweep).toBeDefined();
});

it("sends again what another console undid before it was told", async () => {
  vi.useFakeTimers();
  vi.mocked(send).mockResolvedValue(true);
  show(false);
  await tap(1000);
  await tap(3000);
  expect(send).toHaveBeenCalledOnce();
  await vi.advanceTimersByTimeAsync(6000);
  await tap(8000);
  expect(send).toHaveBeenCalledTimes(2);
  vi.useRealTimers();
});
