// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import * as api from "../sources/api";
import * as coursesApi from "../sources/coursesApi";
import { someSpec } from "../wire/examples";
import { ComparePage } from "./ComparePage";

afterEach(() => act(() => render(null, document.body)));

const settled = () => act(() => new Promise((resolve) => setTimeout(resolve)));
const emitters = ["a", "b"].map((id) => ({ ...someSpec().emitters[0]!, emitter_id: id, label: `tag ${id}` }));
const about = (emitter: string) => ({
  mission_id: "m",
  name: "owls",
  emitter_id: emitter,
  emitters,
  ended_s: 60,
  bearings_s: [],
  courses: [null, "duller"].map((name) => ({ name, wanted: null, points: [], problem: null })),
});

it("names the emitter that courses are about, and asks for the one that is chosen", async () => {
  vi.spyOn(api, "missions").mockReturnValue(new Promise(() => undefined));
  const asked = vi.spyOn(coursesApi, "courses").mockImplementation((_, emitter) => Promise.resolve(about(emitter ?? "a") as never));
  const rows = () => [...document.querySelectorAll("[data-testid=compare-row] th")].map((cell) => cell.textContent);
  act(() => render(<ComparePage route={{ page: "compare", missionIds: ["m"] }} />, document.body));
  await settled();
  expect(rows()).toEqual(["As it was flown · tag a", "duller · tag a"]);
  const choice = document.querySelector<HTMLSelectElement>("[data-testid=compare-emitter]")!;
  expect([...choice.options].map((one) => one.text)).toEqual(["tag a", "tag b"]);
  choice.value = "b";
  act(() => void choice.dispatchEvent(new Event("change", { bubbles: true })));
  await settled();
  expect(asked.mock.calls).toEqual([
    ["m", undefined],
    ["m", "b"],
  ]);
  expect(rows()).toEqual(["As it was flown · tag b", "duller · tag b"]);
});
