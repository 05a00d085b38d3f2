// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { expect, it, vi } from "vitest";
import { draftSuggested } from "../commands/suggested";
import * as api from "../sources/api";
import { MissionsPage } from "./MissionsPage";

vi.mock("../commands/suggested");

it("drafts one suggested search, however often it is pressed", async () => {
  vi.spyOn(api, "missions").mockResolvedValue({ missions: [], next: null });
  vi.mocked(draftSuggested).mockReturnValue(new Promise(() => {}));
  act(() => render(<MissionsPage />, document.body));
  const suggested = () => document.querySelector<HTMLButtonElement>("[data-testid=welcome-suggested]")!;
  await vi.waitFor(() => expect(suggested()).not.toBeNull());
  for (let presses = 0; presses < 2; presses++) act(() => suggested().click());
  expect(draftSuggested).toHaveBeenCalledOnce();
  act(() => render(null, document.body));
});
