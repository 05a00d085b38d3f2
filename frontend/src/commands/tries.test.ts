// @vitest-environment happy-dom
// How often an order is tried, what a second press does, and when it is given up.
import { describe, expect, it, vi } from "vitest";
import { t } from "../i18n";
import { accepted } from "../sources/fakeSource";
import { unreachable } from "../sources/problem";
import { source as connected, live } from "../state/connection";
import type { Flown } from "../state/flying";
import { emptyLive } from "../state/live";
import { open } from "../state/open";
import { session } from "../state/session";
import type { Command, Recorded } from "../wire";
import { someStatus } from "../wire/examples";
import { type Answer, type Fate, inTimeOfItsOwn, LossyServer, later, pass } from "./lossyServer";
import { problems } from "./send";
import { sendUrgent, urgent } from "./urgent";

const M: Flown = { id: "m", craftId: "c", phase: "flying" };

let source: LossyServer;
const begin = (fates: Partial<Record<Command["kind"], Answer[]>>) => {
  source = new LossyServer(fates);
  open(source);
};
const sent = (kind: string) => source.sent.filter((s) => s.kind === kind);

inTimeOfItsOwn();

const inTime = (ms: number) => new Date(Date.now() + ms).toISOString();
/** An entry of the journal, inMs from now. */
const told = (inMs: number, event: object) => ({ seq: 1, at_utc: inTime(inMs), event }) as unknown as Recorded;
const theirs = { kind: "command_accepted", command: "return", command_id: "theirs" };
const byItself = { kind: "return_ordered", by: null, craft_id: "c" };
const M_SHOWN = { ...emptyLive, mission: { ...emptyLive.mission, missionId: "m" } };
/** What the page hears now of the server's time, and entries of its journal. */
function hear(statusInMs: number, ...events: Recorded[]): void {
  const status = { value: someStatus({ at_utc: inTime(statusInMs) }), atMs: performance.now() };
  live.value = { ...M_SHOWN, beganMs: live.value.beganMs, status, events };
}

describe("a hold pressed again", () => {
  it("while the answer to the first hangs goes out", async () => {
    begin({ hold: ["late reply"] });
    source.answer = () => later(3000).then(() => accepted);
    void sendUrgent(M, "hold");
    await pass(1000);
    void sendUrgent(M, "hold");
    await pass(100);
    expect(sent("hold")).toHaveLength(2);
    await pass(20_000);
    expect(urgent.value).toEqual({});
  });

  it("by a thumb that taps twice goes out once", async () => {
    begin({});
    source.answer = () => later(3000).then(() => accepted);
    void sendUrgent(M, "hold");
    await pass(200);
    void sendUrgent(M, "hold");
    await pass(20_000);
    expect(sent("hold")).toHaveLength(1);
  });
});

it.each(["abort", "hold", "return", "land"] as const)("%s pressed again while the first hangs goes out at once", async (kind) => {
  begin({});
  vi.spyOn(source, "answer");
  const send = source.send.bind(source);
  vi.spyOn(source, "send").mockImplementationOnce(async (...order) => {
    await send(...order);
    await later(20_000);
    throw unreachable("no link");
  });
  void sendUrgent(M, kind);
  await pass(1000);
  void sendUrgent(M, kind);
  await pass(100);
  expect(sent(kind)).toHaveLength(2);
  expect(new Set(sent(kind).map(({ press }) => press)).size).toBe(2);
  await pass(120_000);
  expect(sent(kind)).toHaveLength(2);
});

it("goes out every 600 ms for a thumb that keeps tapping", async () => {
  begin({ hold: Array<Fate>(200).fill("lost") });
  for (let taps = 0; taps < 20; taps++) {
    void sendUrgent(M, "hold");
    await pass(400);
  }
  expect(new Set(sent("hold").map(({ commandId }) => commandId)).size).toBe(10);
});

it("is tried again when the first try hangs, for longer each time", async () => {
  begin({ hold: Array<Fate>(200).fill("lost") });
  void sendUrgent(M, "hold");
  await pass(120_000);
  expect(
    sent("hold")
      .slice(0, 5)
      .map(({ timeoutMs }) => timeoutMs),
  ).toEqual([3000, 6000, 12_000, 20_000, 20_000]);
});

it.each([-3_600_000, 120_000])("a clock that is set by %d ms tries no longer than a minute, and takes a second press", async (ms) => {
  begin({ hold: Array<Fate>(2000).fill("lost") });
  void sendUrgent(M, "hold");
  await pass(1000);
  vi.setSystemTime(Date.now() + ms);
  void sendUrgent(M, "hold");
  await pass(100);
  expect(new Set(sent("hold").map(({ press }) => press)).size).toBe(2);
  await pass(61_000);
  const tries = sent("hold").length;
  await pass(600_000);
  expect(sent("hold")).toHaveLength(tries);
});

it.each([
  ["what somebody else has ordered since", 3000, theirs, 1],
  ["what the mission has ordered by itself since", 3000, byItself, 1],
  ["the landing of an empty battery since", 3000, { ...byItself, kind: "land_ordered" }, 1],
  ["what was ordered before, and is heard only now", -3000, theirs, 3],
  ["what another craft does by itself", 3000, { ...byItself, craft_id: "d" }, 3],
])("a hold that is lost, and %s", async (_what, inMs, event, tries) => {
  begin({ hold: ["lost", "lost"] });
  live.value = M_SHOWN;
  void sendUrgent(M, "hold");
  await pass(100);
  hear(0, told(inMs, event));
  await pass();
  expect(sent("hold")).toHaveLength(tries);
  expect(urgent.value).toEqual({});
  const gaveUp = problems.value.bar;
  expect(gaveUp?.detail).toBe(tries === 1 ? t("bar.overtaken") : undefined);
  expect(gaveUp?.title).toBe(tries === 1 ? t("bar.hold") : undefined);
});

it.each([3_600_000, -3_600_000])("knows what was ordered since by a server's clock that is %d ms ahead", async (ms) => {
  for (const [inMs, done] of [
    [3000, []],
    [-3000, ["hold"]],
  ] as const) {
    begin({ hold: ["lost"] });
    void sendUrgent(M, "hold");
    await pass(100);
    hear(ms, told(ms + inMs, theirs));
    await pass();
    expect(source.done).toEqual(done);
  }
});

it("the clock of a simulation that runs fast is known less well: what was ordered just before the press ends nothing", async () => {
  begin({ hold: ["lost"] });
  void sendUrgent(M, "hold");
  await pass(100);
  hear(2000 - 200 * 20, told(-1000, theirs)); // it ran 100 ms at 20 times, and the status was 200 ms on its way
  live.value = { ...live.value, hello: { time_factor: 20 } as typeof live.value.hello };
  await pass();
  expect(source.done).toEqual(["hold"]);
});

it("what was ordered while the machine slept, before the press, is heard after it and ends nothing", async () => {
  begin({ hold: ["lost"] });
  hear(0);
  vi.setSystemTime(Date.now() + 600_000);
  void sendUrgent(M, "hold");
  await pass(100);
  hear(0, told(-300_000, theirs));
  await pass();
  expect(source.done).toEqual(["hold"]);
});

it("a machine that slept since a status was heard knows what was ordered before the press, and it ends nothing", async () => {
  begin({ hold: ["lost"] });
  void sendUrgent(M, "hold");
  await pass(100);
  hear(0, told(-10_000, theirs));
  vi.setSystemTime(Date.now() + 30_000);
  await pass();
  expect(source.done).toEqual(["hold"]);
});

it("the time that an example told says nothing of the mission that is shown instead", async () => {
  begin({ hold: ["lost", "lost"] });
  hear(-86_400_000);
  void sendUrgent(M, "hold");
  await pass(100);
  hear(-86_400_000);
  await pass(100);
  open(source);
  live.value = { ...M_SHOWN, ...live.value, mission: M_SHOWN.mission, events: [told(-300_000, theirs)] };
  await pass();
  expect(source.done).toEqual(["hold"]);
});

it("a return given on another page goes out no more over what is heard later", async () => {
  begin({ return: ["lost"] });
  void sendUrgent(M, "return");
  await pass(100);
  hear(0, told(3000, { ...theirs, command: "hold" }));
  await pass();
  expect(source.done).toEqual([]);
});

it("is given up with a word after a minute, whose last try is no longer than what is left of it", async () => {
  begin({ hold: Array<Fate>(200).fill("lost") });
  void sendUrgent(M, "hold");
  await pass(120_000);
  expect(problems.value.bar).toMatchObject({ title: t("bar.hold"), detail: t("bar.unanswered") });
  expect(sent("hold").at(-1)!.timeoutMs).toBeLessThan(1000);
});

it.each(["hold", "abort"] as const)("%s is not given under the session that follows", async (kind) => {
  begin({ [kind]: ["lost"] });
  void sendUrgent(M, kind);
  await pass(100);
  session.value = { mode: "accounts", person: null } as never;
  await pass(100);
  session.value = null;
  await pass();
  expect(source.done).toEqual([]);
});

it("ends where somebody else has entered meanwhile, and not where the same person is heard of again", async () => {
  const enters = (person_id: string) => (session.value = { mode: "people", person: { person_id } } as never);
  enters("ada");
  begin({ hold: ["lost"], return: ["lost"] });
  void sendUrgent(M, "hold");
  await pass(100);
  enters("ada");
  await pass();
  void sendUrgent(M, "return");
  await pass(100);
  enters("bob");
  await pass();
  session.value = null;
  expect(source.done).toEqual(["hold"]);
});

it.each([408, 429, 503])("goes on after a %d, which is no refusal", async (status) => {
  begin({ hold: [status] });
  void sendUrgent(M, "hold");
  await pass();
  expect(source.done).toEqual(["hold"]);
  expect(new Set(sent("hold").map(({ commandId }) => commandId)).size).toBe(1);
});

it("ends with the session: whoever enters next has given no order", async () => {
  begin({ hold: [401, "lost"], return: ["lost"] });
  await sendUrgent(M, "hold");
  expect(problems.value.bar?.status).toBe(401);
  void sendUrgent(M, "return");
  connected.value = null;
  await pass();
  begin({});
  await pass();
  expect(source.sent).toEqual([]);
});
