// @vitest-environment happy-dom
// Of two orders the last one pressed counts, whatever becomes of either on its way.
import { describe, expect, it, vi } from "vitest";
import { t } from "../i18n";
import { accepted } from "../sources/fakeSource";
import { live } from "../state/connection";
import type { Flown } from "../state/flying";
import { emptyLive } from "../state/live";
import { open } from "../state/open";
import type { Command, CommandReply } from "../wire";
import { type Answer, type Fate, inTimeOfItsOwn, LossyServer, later, pass } from "./lossyServer";
import { confirmProposal, proposal } from "./proposal";
import { problems } from "./send";
import { resume, sendUrgent, urgent } from "./urgent";

const M: Flown = { id: "m", craftId: "c", phase: "flying" };

let source: LossyServer;
const begin = (fates: Partial<Record<Command["kind"], Answer[]>>) => {
  source = new LossyServer(fates);
  open(source);
};
const sent = (kind: string) => source.sent.filter((s) => s.kind === kind);

inTimeOfItsOwn();

function withCrafts(...ids: string[]): void {
  const crafts = ids.map((craft_id) => ({ craft_id, mission_id: "m" }));
  live.value = { ...emptyLive, status: { value: { crafts }, atMs: 0 } as unknown as typeof emptyLive.status };
}

const FATES: Fate[] = ["at once", "late", "late reply", "lost", "reply lost", "late, reply lost", "refused"];
const PAIRS = FATES.flatMap((older) => FATES.map((newer) => [older, newer] as const));

const KINDS = [
  ["return", "hold"],
  ["hold", "land"],
  ["hold", "abort"],
] as const;

/** When a first try reaches the server, in ms; what is lost comes with the next one. */
const REACHES: Record<Exclude<Fate, "refused">, number> = {
  "at once": 0,
  "late reply": 0,
  "reply lost": 0,
  late: 300,
  "late, reply lost": 300,
  lost: 700,
};

describe("of an abort, then a hold", () => {
  it.each(PAIRS)("the abort %s and the hold %s: an abort counts whenever it comes", async (older, newer) => {
    begin({ abort: [older], hold: [newer] });
    void sendUrgent(M, "abort");
    await pass(100);
    void sendUrgent(M, "hold");
    await pass();
    const aborted = older === "refused" ? Number.NEGATIVE_INFINITY : REACHES[older];
    const held = newer === "refused" ? Number.NEGATIVE_INFINITY : 100 + REACHES[newer];
    expect(source.done.at(-1)).toBe(aborted === held ? undefined : held > aborted ? "hold" : "abort");
    expect(urgent.value).toEqual({});
  });
});

describe.each(KINDS)("of %s, then %s", (first, last) => {
  it.each(PAIRS)("the older %s and the newer %s: the last one counts", async (older, newer) => {
    begin({ [first]: [older], [last]: [newer] });
    void sendUrgent(M, first);
    await pass(100);
    void sendUrgent(M, last);
    await pass();
    const counts = newer === "refused" ? (older === "refused" ? undefined : first) : last;
    expect(source.done.at(-1)).toBe(counts);
    expect(urgent.value).toEqual({});
  });
});

describe("a resume, then a hold", () => {
  it.each(PAIRS)("the resume %s and the hold %s: the hold counts", async (older, newer) => {
    begin({ resume: [older], hold: [newer] });
    void resume(M);
    await pass(100);
    void sendUrgent(M, "hold");
    await pass();
    const resumed = older === "refused" || older === "lost" ? undefined : "resume";
    expect(source.done.at(-1)).toBe(newer === "refused" ? resumed : "hold");
  });
});

describe("a hold, then a resume", () => {
  it.each(["at once", "late reply", "reply lost", "lost"] as const)("the hold %s: the resume counts", async (older) => {
    begin({ hold: [older, "lost"] });
    void sendUrgent(M, "hold");
    await pass(100);
    void resume(M);
    await pass();
    expect(source.done.at(-1)).toBe("resume");
    expect(sent("resume")).toHaveLength(1);
  });

  it("and the hold pressed again while its first press is on its way: the hold counts", async () => {
    begin({ hold: ["reply lost"], resume: ["late"] });
    void sendUrgent(M, "hold");
    await pass(50);
    void resume(M);
    void sendUrgent(M, "hold");
    await pass();
    expect(source.done).toEqual(["hold", "hold"]);
    expect(sent("resume")).toHaveLength(1);
  });

  it("ends no order that the mission's other craft may still need", async () => {
    begin({ hold: ["lost"] });
    withCrafts("c", "d");
    void sendUrgent(M, "hold");
    await pass(100);
    void resume(M);
    await pass();
    expect(source.done).toEqual(["resume", "hold"]);
  });

  it("ends none either where no status has told how many craft there are, and ends it where there is one", async () => {
    begin({ hold: ["lost"] });
    void sendUrgent(M, "hold");
    await pass(100);
    void resume(M);
    withCrafts("c", "d");
    await pass();
    expect(source.done).toEqual(["resume", "hold"]);
    begin({ hold: ["lost"] });
    withCrafts("c");
    void sendUrgent(M, "hold");
    await pass(100);
    void resume(M);
    await pass();
    expect(sent("hold")).toHaveLength(1);
  });

  it("is not undone by what was given before the hold, with several crafts either", async () => {
    begin({ return: ["late, reply lost"] });
    withCrafts("c", "d");
    void sendUrgent(M, "return");
    await pass(50);
    void sendUrgent(M, "hold");
    await pass(50);
    void resume(M);
    await pass();
    expect(source.done).toEqual(["hold", "resume"]);
  });
});

it("an abort that fails again and again leaves a newer hold alone, and says that it was given up", async () => {
  begin({ abort: Array<Fate>(200).fill("lost") });
  void sendUrgent(M, "abort");
  await pass(100);
  void sendUrgent(M, "hold");
  await pass(120_000);
  expect(source.done).toEqual(["hold"]);
  expect(sent("abort").length).toBeGreaterThan(60);
  expect(problems.value.bar).toMatchObject({ title: t("bar.abort"), detail: t("bar.unanswered") });
});

it("keeps the refusal of a newer order in sight, whatever becomes of an older one", async () => {
  begin({ return: ["late reply"], hold: ["refused"] });
  void sendUrgent(M, "return");
  await pass(100);
  void sendUrgent(M, "hold");
  await pass();
  expect(problems.value.bar?.reason?.code).toBe("pilot_controls");
});

it("does not resume once control is taken, where something was ordered meanwhile", async () => {
  begin({});
  source.answer = () => Promise.resolve(accepted);
  const free: CommandReply = { ...accepted, accepted: false, reason: { code: "control_free" } };
  const send = source.send.bind(source);
  vi.spyOn(source, "send").mockImplementation(async (...order) => {
    const reply = await send(...order);
    if (order[1].kind === "take_control") await later(300);
    return order[1].kind === "resume" && sent("resume").length === 1 ? free : reply;
  });
  void resume(M);
  await pass(100);
  void sendUrgent(M, "hold");
  await pass();
  expect(source.sent.map(({ kind }) => kind)).toEqual(["resume", "take_control", "hold"]);
  expect(problems.value.bar).toBeUndefined();
  void resume(M);
  await pass();
  expect(sent("resume")).toHaveLength(2);
});

it("does not bring back what a newer order took the place of that ran out of tries", async () => {
  begin({ hold: ["lost"], return: Array<Fate>(200).fill("lost") });
  void sendUrgent(M, "hold");
  await pass(200);
  void sendUrgent(M, "return");
  await pass(120_000);
  expect(source.done).toEqual([]);
  expect(sent("return").length).toBeGreaterThan(60);
  expect(urgent.value).toEqual({});
  expect(problems.value.bar).toBeDefined();
});

it("orders of another craft change nothing", async () => {
  begin({ hold: ["lost"], return: ["at once"] });
  void sendUrgent(M, "hold");
  void sendUrgent({ id: "n", craftId: "d", phase: "flying" }, "return");
  await pass();
  expect(source.done).toEqual(["return", "hold"]);
});

it("asks before the page is left while an order is on its way", async () => {
  begin({ hold: ["lost"] });
  const asks = () => !dispatchEvent(new Event("beforeunload", { cancelable: true }));
  expect(asks()).toBe(false);
  void sendUrgent(M, "hold");
  await pass(100);
  expect(asks()).toBe(true);
  await pass();
  expect(asks()).toBe(false);
});

it("a newer proposal outlives the answer to the older one", async () => {
  begin({ override: ["late reply"] });
  live.value = { ...emptyLive, mission: { ...emptyLive.mission, missionId: "m" } };
  const proposed = (lat: number) => ({ place: { lat, lon: 7 }, result: null, problem: null, withPlanner: true });
  proposal.value = proposed(50);
  void confirmProposal();
  await pass(100);
  const newer = proposed(51);
  proposal.value = newer;
  await pass();
  expect(proposal.value).toBe(newer);
  await Promise.all([confirmProposal(), pass()]);
  expect(proposal.value).toBeNull();
});
