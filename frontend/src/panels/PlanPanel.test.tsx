// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { proposal, propose } from "../commands/proposal";
import { FakeSource } from "../sources/fakeSource";
import { open } from "../state/open";
import { selectedCraft } from "../state/selection";
import { mission } from "../state/shown";
import type { MissionEvent, Recorded } from "../wire";
import { CRAFT, phase, record, somePlan, someSpec, started } from "../wire/examples";
import { PlanPanel } from "./PlanPanel";
import { WhichShown } from "./WhichShown";

const OTHER = "craft-of-others";

const part = <E extends HTMLElement = HTMLElement>(testId: string) => document.querySelector<E>(`[data-testid=${testId}]`);

function show(...events: MissionEvent[]): FakeSource {
  const source = new FakeSource();
  act(() => {
    open(source);
    for (const recorded of record(...events)) source.tell({ type: "event", recorded });
    render(
      <>
        <WhichShown />
        <PlanPanel />
      </>,
      document.body,
    );
    vi.advanceTimersByTime(200);
  });
  return source;
}

const choose = (testId: string, value: string) =>
  act(() => {
    const select = part<HTMLSelectElement>(testId)!;
    select.value = value;
    select.dispatchEvent(new Event("change", { bubbles: true }));
  });

const drafted = (emitters: number): MissionEvent => {
  const spec = someSpec();
  const [first] = spec.emitters;
  const several = Array.from({ length: emitters }, (_, i) => ({ ...first!, emitter_id: `e${i + 1}` }));
  return { kind: "mission_drafted", spec: { ...spec, emitters: several } };
};

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("fetch", () => new Promise(() => undefined));
});
afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

it("names the craft in what it sends, the one chosen where several fly", () => {
  const source = show(drafted(1), started(), started({ craft_id: OTHER }), phase("waiting"), { ...phase("waiting"), craft_id: OTHER });
  act(() => part("accept")!.click());
  choose("which-craft", OTHER);
  expect(selectedCraft.value).toBe(OTHER);
  for (const button of ["accept", "veto", "automatic"]) act(() => part(button)!.click());
  expect(source.sent.map(({ kind, craftId }) => [kind, craftId])).toEqual([
    ["accept", CRAFT],
    ["accept", OTHER],
    ["veto", OTHER],
    ["set_automatic", OTHER],
  ]);
});

it("shows nothing to choose with one craft and one emitter", () => {
  show(drafted(1), started());
  expect(part("which-shown")).toBeNull();
});

it("shows another emitter of several, and the first again in another mission", () => {
  show(drafted(2), started());
  expect(part("which-craft")).toBeNull();
  expect(mission.value.emitterId).toBe("e1");
  act(() => part("emitter-e2")!.click());
  expect(mission.value.emitterId).toBe("e2");
  show(drafted(2));
  expect(mission.value.emitterId).toBe("e1");
});

const other = { lat: 50.9, lon: 7.3 };
const asked = (source: FakeSource) => vi.spyOn(source, "expectedTime").mockReturnValue(new Promise(() => undefined));
const tell = (source: FakeSource, ...events: Recorded[]) =>
  act(() => {
    for (const recorded of events) source.tell({ type: "event", recorded });
    vi.advanceTimersByTime(200);
  });

it("prices an open proposal again when another place is chosen, and lets it fall when it is the one", () => {
  const before = [drafted(1), started(), somePlan(), phase("waiting")];
  const source = show(...before);
  const asking = asked(source);
  act(() => propose(other));
  tell(source, ...record(...before, somePlan({ place: { lat: 50.8, lon: 7.2 } })));
  expect(asking.mock.lastCall?.[3]).toEqual({ lat: 50.8, lon: 7.2 });
  expect(asking).toHaveBeenCalledTimes(2);
  tell(source, ...record(...before, somePlan({ place: { lat: 50.8, lon: 7.2 } }), somePlan({ place: other })));
  expect(proposal.value).toBeNull();
});

it("offers no other place on the way home, and drops the one that was open", () => {
  const before = [drafted(1), started(), somePlan(), phase("flying")];
  const source = show(...before);
  asked(source);
  act(() => propose(other));
  expect(part("proposal")).not.toBeNull();
  tell(source, ...record(...before, phase("returning")));
  expect(proposal.value).toBeNull();
  expect(document.querySelector(".candidate-name:enabled")).toBeNull();
});

it("drops an open proposal with the mission", () => {
  const source = show(drafted(1), started(), somePlan(), phase("flying"));
  asked(source);
  act(() => propose(other));
  show();
  expect(proposal.value).toBeNull();
});

it("accepts once, however often it is pressed", async () => {
  const source = show(drafted(1), started(), somePlan(), phase("waiting"));
  act(() => part("accept")!.click());
  act(() => part("accept")!.click());
  expect(source.sent).toHaveLength(1);
  await act(async () => void (await vi.advanceTimersByTimeAsync(0)));
  expect(part<HTMLButtonElement>("accept")!.disabled).toBe(false);
});
