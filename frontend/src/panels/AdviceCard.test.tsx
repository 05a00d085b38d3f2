// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { advice } from "../state/advice";
import { open } from "../state/open";
import { AdviceCard } from "./AdviceCard";

afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
});

it.each([
  ["m", true],
  ["other", false],
])("shows a late answer in the search it is of: %s", async (shown, isShown) => {
  let answer: (response: Response) => void = () => undefined;
  vi.stubGlobal("fetch", () => new Promise((resolve) => (answer = resolve)));
  open(new FakeSource("m"));
  act(() => render(<AdviceCard missionId="m" here={[7, 50]} />, document.body));
  const walking = document.querySelector<HTMLButtonElement>("[data-testid=advice-walking]")!;
  act(() => walking.click());
  open(new FakeSource(shown));
  await act(async () => answer(new Response(JSON.stringify({ emitter_id: "a" }), { status: 200 })));
  await vi.waitFor(() => expect(walking.disabled).toBe(false));
  expect(advice.value !== null).toBe(isShown);
});
