// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { change } from "../edit/draft";
import * as api from "../sources/api";
import { FakeSource } from "../sources/fakeSource";
import { unreachable } from "../sources/problem";
import { open } from "../state/open";
import { phase, record, someSpec } from "../wire/examples";
import { AreaPage } from "./AreaPage";

vi.mock("./EditMapArea", () => ({ EditMapArea: () => null }));

const part = (name: string) => document.querySelector<HTMLElement>(`[data-testid=${name}]`);
const turn = () => act(() => new Promise<void>((resolve) => setTimeout(resolve)));
const show = (missionId: string) => {
  act(() => render(<AreaPage route={{ page: "area", missionId }} />, document.body));
  return turn();
};

let source: FakeSource;

beforeEach(() => {
  vi.stubGlobal("fetch", () => new Promise(() => {}));
  vi.spyOn(api, "mission").mockImplementation(async () => ({ spec: someSpec() }) as never);
  source = new FakeSource("m");
  act(() => {
    open(source);
    for (const recorded of record({ kind: "mission_drafted", spec: someSpec() })) source.tell({ type: "event", recorded });
  });
});
afterEach(() => {
  act(() => render(null, document.body));
  localStorage.clear();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

it("can be read again when that failed, and says nothing of what was never typed or of orders that do not help", async () => {
  vi.mocked(api.mission).mockRejectedValueOnce(unreachable("The connection failed."));
  await show("m");
  expect(part("area-problem")?.textContent).toContain("The connection failed.");
  expect(part("area-problem")?.textContent).not.toContain("typed");
  expect([part("area-not-held"), part("outlook-ask"), part("area-section")]).toEqual([null, null, null]);
  act(() => part("area-again")!.click());
  await turn();
  expect(part("area-section")).not.toBeNull();
  expect([part("area-problem"), part("area-again")]).toEqual([null, null]);
});

it("asks for a hold only of a mission that flies", async () => {
  await show("m");
  expect(part("area-what")?.textContent).toContain("has not started");
  expect(part("area-not-held")).toBeNull();
  act(() => {
    for (const recorded of record({ kind: "mission_drafted", spec: someSpec() }, phase("flying"))) source.tell({ type: "event", recorded });
  });
  await vi.waitFor(() => expect(part("area-not-held")?.textContent).toContain("press Hold"));
});

it("says of the area that is typed only that it could not be stored", async () => {
  const isShown = () => vi.waitFor(() => expect(part("area-section")).not.toBeNull());
  await show("first");
  await isShown();
  const setItem = () => {
    throw new DOMException("full");
  };
  vi.stubGlobal("localStorage", { getItem: () => null, setItem, removeItem: () => {} });
  act(() => change("flight.fence_margin_m", 61));
  await vi.waitFor(() => expect(part("not-stored")).not.toBeNull());
  vi.unstubAllGlobals();
  vi.stubGlobal("fetch", () => new Promise(() => {}));
  await show("second");
  await isShown();
  expect(part("not-stored")).toBeNull();
});
