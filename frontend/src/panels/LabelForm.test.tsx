// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { beforeEach, expect, it, vi } from "vitest";
import { problems } from "../commands/send";
import { label, remove } from "../sources/libraryApi";
import type { MissionSummary } from "../wire";
import { LabelForm } from "./LabelForm";

vi.mock("../sources/libraryApi");

const part = <E extends HTMLElement>(name: string) => document.querySelector<E>(`[data-testid=${name}]`)!;
const notes = () => part<HTMLTextAreaElement>("label-notes");
const done = vi.fn();

function open(id: string): void {
  const mission = { mission_id: id, name: id, tags: [] as string[], notes: "", deleted_at_utc: null } as unknown as MissionSummary;
  act(() => render(<LabelForm mission={mission} onDone={done} key={id} />, document.body));
}

function write(text: string): void {
  act(() => {
    notes().value = text;
    notes().dispatchEvent(new Event("input", { bubbles: true }));
  });
}

beforeEach(() => {
  vi.clearAllMocks();
  problems.value = {};
});

it("keeps what was typed when another row's form was opened, until it is saved", async () => {
  open("one");
  write("three pages of field notes");
  open("two");
  expect(notes().value).toBe("");
  open("one");
  expect(notes().value).toBe("three pages of field notes");
  vi.mocked(label).mockResolvedValue(undefined as never);
  act(() => part("label-save").click());
  await vi.waitFor(() => expect(done).toHaveBeenCalled());
  expect(vi.mocked(label).mock.lastCall![1].notes).toBe("three pages of field notes");
  open("two");
  open("one");
  expect(notes().value).toBe("");
});

it("takes no further words while it saves, and again when that failed", async () => {
  open("three");
  write("fed at dusk");
  vi.mocked(label).mockRejectedValue(new Error("no network"));
  act(() => part("label-save").click());
  expect(part("label-form").inert).toBe(true);
  const save = part<HTMLButtonElement>("label-save");
  expect([save.textContent, save.disabled]).toEqual(["Saving …", true]);
  await vi.waitFor(() => expect(part("label-form").inert).toBe(false));
  expect([save.textContent, save.disabled]).toEqual(["Save", false]);
  expect(notes().value).toBe("fed at dusk");
  expect(done).not.toHaveBeenCalled();
});

it("closes no other row's form when it is saved, and says at the bar when it could not be", async () => {
  open("four");
  write("note");
  vi.mocked(label).mockResolvedValue(undefined as never);
  act(() => part("label-save").click());
  open("five");
  await act(() => Promise.resolve());
  expect(done).not.toHaveBeenCalled();
  vi.mocked(label).mockRejectedValue(new Error("no network"));
  act(() => part("label-save").click());
  open("four");
  expect(notes().value).toBe("");
  await vi.waitFor(() => expect(problems.value.bar?.title).toContain("five"));
});

it("forgets what was typed when that is wished, and with the mission", async () => {
  for (const [id, button] of [
    ["six", "label-discard"],
    ["seven", "delete-mission"],
  ] as const) {
    open(id);
    write("old words");
    vi.mocked(remove).mockResolvedValue(undefined as never);
    act(() => part(button).click());
    await vi.waitFor(() => expect(done).toHaveBeenCalled());
    done.mockClear();
    open("eight");
    open(id);
    expect(notes().value).toBe("");
  }
});
