// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { localProblem, RequestFailed } from "../sources/problem";
import * as uploads from "../sources/upload";
import { go, route } from "../state/route";
import { MissionsPage } from "./MissionsPage";

let brought: (mission: { mission_id: string }) => void;
let refused: (error: unknown) => void;

beforeEach(() => {
  vi.stubGlobal("fetch", () => new Promise(() => undefined));
  vi.spyOn(uploads, "upload").mockReturnValue(
    new Promise((resolve, reject) => {
      brought = resolve as typeof brought;
      refused = reject;
    }),
  );
  route.value = { page: "missions" };
  act(() => render(<MissionsPage />, document.body));
  const input = document.querySelector<HTMLInputElement>("[data-testid=bring-in]")!;
  Object.defineProperty(input, "files", { value: [new File(["zip"], "flight.zip")] });
  act(() => void input.dispatchEvent(new Event("change", { bubbles: true })));
});
afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
  go("");
});

it("opens the mission that was brought in", async () => {
  await act(async () => brought({ mission_id: "b" }));
  expect(location.hash).toBe("#/mission/b");
});

it("does not lead away from a page that was opened meanwhile", async () => {
  route.value = { page: "health" };
  await act(async () => brought({ mission_id: "b" }));
  expect(location.hash).toBe("");
});

it("says when its page is opened again that a bundle was refused meanwhile", async () => {
  act(() => render(null, document.body));
  await act(async () => refused(new RequestFailed(localProblem("Bundle", "the disk is full"))));
  act(() => render(<MissionsPage />, document.body));
  expect(document.querySelector(".problem")?.textContent).toContain("the disk is full");
});
