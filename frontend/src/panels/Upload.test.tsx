// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { localProblem, RequestFailed } from "../sources/problem";
import { upload } from "../sources/upload";
import { session } from "../state/session";
import { Upload } from "./Upload";

vi.mock("../sources/upload", () => ({ upload: vi.fn() }));

const FULL = localProblem("Upload", "the disk is full");

/** On the page of `path`: what is said of uploads. */
function page(path: string) {
  const onProblem = vi.fn();
  const shown = <Upload path={path} testId="upload" accept=".kml" label="Upload" onDone={() => {}} onProblem={onProblem} />;
  act(() => render(shown, document.body));
  return onProblem;
}

/** Sends a file; what is returned refuses it. */
function send(): () => Promise<void> {
  let refuse: (error: unknown) => void = () => {};
  vi.mocked(upload).mockReturnValue(new Promise((_, reject) => (refuse = reject)));
  const input = document.querySelector<HTMLInputElement>("[data-testid=upload]")!;
  Object.defineProperty(input, "files", { value: [new File(["x"], "a.kml")], configurable: true });
  act(() => void input.dispatchEvent(new Event("change")));
  return () =>
    act(async () => {
      refuse(new RequestFailed(FULL));
      await new Promise((resolve) => setTimeout(resolve));
    });
}

const leave = () => act(() => render(null, document.body));

afterEach(() => {
  leave();
  session.value = null;
});

it("says at once that a file was refused", async () => {
  const told = page("/overlays");
  await send()();
  expect(told).toHaveBeenLastCalledWith(FULL);
});

it("says what was refused after its page was left, once, when that is opened again", async () => {
  const left = page("/overlays");
  const refused = send();
  leave();
  left.mockClear();
  await refused();
  expect(left).not.toHaveBeenCalled();
  expect(page("/maps")).not.toHaveBeenCalled();
  leave();
  expect(page("/overlays").mock.calls).toEqual([[FULL]]);
  leave();
  expect(page("/overlays")).not.toHaveBeenCalled();
});

it("says it on the page that was opened again before the file was refused, and nowhere else", async () => {
  const left = page("/overlays");
  const refused = send();
  leave();
  left.mockClear();
  const again = page("/overlays");
  await refused();
  expect(left).not.toHaveBeenCalled();
  expect(again.mock.calls).toEqual([[FULL]]);
  leave();
  expect(page("/overlays")).not.toHaveBeenCalled();
});

it("says nothing to the next person, and says it once the first is back", async () => {
  const enters = (person_id: string) =>
    act(() => {
      session.value = { mode: "people", person: { person_id } } as never;
    });
  enters("ada");
  const adas = page("/overlays");
  const refused = send();
  adas.mockClear();
  enters("bob"); // signed in from another page
  await refused();
  expect(adas).not.toHaveBeenCalled();
  leave();
  expect(page("/overlays")).not.toHaveBeenCalled();
  leave();
  enters("ada");
  expect(page("/overlays").mock.calls).toEqual([[FULL]]);
});
