// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import * as uploads from "../sources/upload";
import { go, route } from "../state/route";
import { MissionsPage } from "./MissionsPage";

let brought: (mission: { mission_id: string }) => void;

beforeEach(() => {
  vi.stubGlobal("fetch", () => new Promise(() => undefined));
  vi.spyOn(uploads, "upload").mockReturnValue(new Promise((resolve) => (brought = resolve as typeof brought)));
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
