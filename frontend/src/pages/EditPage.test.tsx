// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { draft } from "../edit/draft";
import { tool } from "../edit/drawing";
import * as api from "../sources/api";
import type { MissionSpec } from "../wire";
import { someSpec } from "../wire/examples";
import { EditPage } from "./EditPage";

vi.mock("./EditMapArea", () => ({ EditMapArea: () => null }));

/** The page of a mission's draft; the server answers when what is returned is called. */
function edited(missionId: string): (name: string) => Promise<void> {
  let come: (told: never) => void = () => {};
  vi.spyOn(api, "mission").mockReturnValue(new Promise((resolve) => (come = resolve)));
  act(() => render(<EditPage route={{ page: "edit", missionId }} />, document.body));
  return (name) =>
    act(async () => {
      come({ spec: { ...someSpec(), name } satisfies MissionSpec } as never);
      await new Promise((resolve) => setTimeout(resolve));
    });
}

const shownName = () => document.querySelector<HTMLInputElement>("[data-testid=field-name]")?.value;

beforeEach(() => vi.stubGlobal("fetch", () => new Promise(() => {})));
afterEach(() => {
  act(() => render(null, document.body));
  localStorage.clear();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

it("shows nothing of the mission before until its own has come: what is typed into it would be lost", async () => {
  await edited("first")("Meadow");
  expect(shownName()).toBe("Meadow");
  act(() => render(null, document.body));
  expect(draft.value).toBeNull();

  draft.value = { key: "first", spec: someSpec(), hasArea: true, suggested: false, text: {} };
  render(<EditPage route={{ page: "edit", missionId: "second" }} />, document.body); // its effects have not run yet
  expect(shownName()).toBeUndefined();
});

it("does not take the late answer of a mission that was left for its own", async () => {
  const first = edited("first");
  const second = edited("second");
  await second("Mill");
  await first("Meadow");
  expect(draft.value?.key).toBe("second");
  expect(shownName()).toBe("Mill");
});

it("gives the keys back to the field whose Enter asked to save what cannot be saved yet", async () => {
  await edited("first")("Meadow");
  const name = document.querySelector<HTMLInputElement>("[data-testid=field-name]")!;
  tool.value = "polygon";
  name.focus();
  await act(async () => {
    name.form!.requestSubmit();
    await new Promise((resolve) => setTimeout(resolve));
  });
  expect(document.querySelector("[data-testid=edit-problem]")?.textContent).toContain("press Enter to finish");
  expect(document.activeElement).toBe(name);
});

it("reads the mission again after a failure, at a tap", async () => {
  vi.spyOn(api, "mission").mockRejectedValueOnce(new TypeError("no network"));
  const answered = () => act(() => new Promise<void>((resolve) => setTimeout(resolve)));
  act(() => render(<EditPage route={{ page: "edit", missionId: "first" }} />, document.body));
  await answered();
  expect(document.querySelector("[data-testid=edit-problem]")).not.toBeNull();
  expect(document.querySelector("[data-testid=save]")).toBeNull();
  vi.mocked(api.mission).mockResolvedValue({ spec: { ...someSpec(), name: "Meadow" } } as never);
  act(() => document.querySelector<HTMLButtonElement>("[data-testid=read-again]")!.click());
  await answered();
  expect(shownName()).toBe("Meadow");
  expect(document.querySelector("[data-testid=edit-problem]")).toBeNull();
  expect(document.querySelector("[data-testid=read-again]")).toBeNull();
});
