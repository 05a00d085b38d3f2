// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { draftSuggested } from "../commands/suggested";
import * as api from "../sources/api";
import type { ReplaySource } from "../sources/replay";
import { replays } from "../sources/replays";
import { route } from "../state/route";
import { MissionsPage } from "./MissionsPage";

vi.mock("../commands/suggested");

afterEach(() => {
  act(() => render(null, document.body));
  replays.clear();
});

it("drafts one suggested search, however often it is pressed", async () => {
  vi.spyOn(api, "missions").mockResolvedValue({ missions: [], next: null });
  vi.mocked(draftSuggested).mockReturnValue(new Promise(() => {}));
  act(() => render(<MissionsPage />, document.body));
  const suggested = () => document.querySelector<HTMLButtonElement>("[data-testid=welcome-suggested]")!;
  await vi.waitFor(() => expect(suggested()).not.toBeNull());
  for (let presses = 0; presses < 2; presses++) act(() => suggested().click());
  expect(draftSuggested).toHaveBeenCalledOnce();
});

it("keeps no recording that was read after its reader had left", async () => {
  vi.spyOn(api, "missions").mockResolvedValue({ missions: [], next: null });
  const read = vi.spyOn(api, "readExported").mockResolvedValue({ mission_id: "m", events: [], tracks: [] } as never);
  act(() => render(<MissionsPage />, document.body));
  await vi.waitFor(() => expect(document.querySelector("[data-testid=welcome]")).not.toBeNull());
  const input = document.querySelector<HTMLInputElement>("input[accept*=json]")!;
  Object.defineProperty(input, "files", { value: [new File(["{}"], "m.json")] });
  act(() => void input.dispatchEvent(new Event("change", { bubbles: true })));
  route.value = { page: "health" };
  await vi.waitFor(() => expect(read).toHaveBeenCalled());
  await act(async () => {});
  expect(replays.size).toBe(0);
  route.value = { page: "missions" };
});

it("forgets the recording of a mission that the server lists, and no other", async () => {
  for (const id of ["m", "elsewhere"]) replays.set(id, {} as ReplaySource);
  const listed = { mission_id: "m", phase: "done", outcome: null, drafted_at_utc: "2026-05-01T10:00:00Z", mission_time_s: null, tags: [] };
  const sketch = { outline: [], places: [], found: {}, truth: {} };
  vi.spyOn(api, "missions").mockResolvedValue({ missions: [{ ...listed, sketch } as never], next: null });
  act(() => render(<MissionsPage />, document.body));
  await vi.waitFor(() => expect([...replays.keys()]).toEqual(["elsewhere"]));
});
