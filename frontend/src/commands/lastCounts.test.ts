// @vitest-environment happy-dom
// Of two orders the last one pressed counts, whatever becomes of either on its way.
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { t } from "../i18n";
import type { Sending } from "../sources/api";
import { accepted, FakeSource } from "../sources/fakeSource";
import { localProblem, RequestFailed, unreachable } from "../sources/problem";
import { source as connected, live } from "../state/connection";
import type { Flown } from "../state/flying";
import { emptyLive } from "../state/live";
import { open } from "../state/open";
import { session } from "../state/session";
import type { Command, CommandReply, Recorded } from "../wire";
import { confirmProposal, proposal } from "./proposal";
import { problems } from "./send";
import { resume, sendUrgent, urgent } from "./urgent";

const M: Flown = { id: "m", craftId: "c", phase: "flying" };
const refused: CommandReply = { ...accepted, accepted: false, reason: { code: "pilot_controls" } };
const late: CommandReply = { ...accepted, accepted: false, reason: { code: "later_order_counts" } };

type Fate = "at once" | "late" | "late reply" | "lost" | "reply lost" | "late, reply lost" | "refused";
/** A number: the status of the answer. */
type Answer = Fate | number;

const later = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

/**
 * A server that carries out each command id once and nothing that was given before what each craft has accepted, behind
 * a link that treats the first try of each kind as it was asked to.
 */
class Served extends FakeSource {
  readonly done: string[] = [];
  private readonly known = new Map<string, CommandReply>();
  private readonly last = new Map<string, number>();
  constructor(private readonly fates: Partial<Record<Command["kind"], Answer[]>>) {
    super("m");
  }
  private carryOut(missionId: string, command: Command, { commandId: id = "", press = 0 }: Sending, fate?: Fate): CommandReply {
    const known = this.known.get(id);
    if (known) return known;
    const all = live.peek().status?.value.crafts.map(({ craft_id }) => craft_id) ?? [missionId];
    const crafts = "craft_id" in command && command.craft_id && all.includes(command.craft_id) ? [command.craft_id] : all;
    const isLate = command.kind !== "abort" && crafts.every((craft) => press < (this.last.get(craft) ?? 0));
    const reply = isLate ? late : fate === "refused" ? refused : accepted;
    if (reply.accepted) {
      this.done.push(command.kind);
      for (const craft of crafts) this.last.set(craft, Math.max(press, this.last.get(craft) ?? 0));
    }
    this.known.set(id, reply);
    return reply;
  }
  override async send(missionId: string, command: Command, sending: Sending = {}): Promise<CommandReply> {
    await super.send(missionId, command, sending);
    const fate = this.fates[command.kind]?.shift();
    if (typeof fate === "number") throw new RequestFailed(localProblem("no", "", fate));
    if (fate === "lost") throw unreachable("no link");
    if (fate?.startsWith("late") && fate !== "late reply") await later(300);
    const reply = this.carryOut(missionId, command, sending, fate);
    if (fate === "late reply") await later(300);
    if (fate?.endsWith("reply lost")) throw unreachable("no link");
    return reply;
  }
}

let source: Served;
const begin = (fates: Partial<Record<Command["kind"], Answer[]>>) => {
  source = new Served(fates);
  open(source);
};
const pass = (ms = 10_000) => vi.advanceTimersByTimeAsync(ms);
const sent = (kind: string) => source.sent.filter((s) => s.kind === kind);

let begun = 0;
beforeEach(() => {
  vi.useFakeTimers();
  vi.advanceTimersByTime(60_000 * ++begun); // or a press would be the second tap of the test before
});
afterEach(async () => {
  await vi.runAllTimersAsync();
  vi.useRealTimers();
  problems.value = {};
  live.value = emptyLive;
});

function withTwoCrafts(): void {
  const crafts = ["c", "d"].map((craft_id) => ({ craft_id, mission_id: "m" }));
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
    withTwoCrafts();
    void sendUrgent(M, "hold");
    await pass(100);
    void resume(M);
    await pass();
    expect(source.done).toEqual(["resume", "hold"]);
  });

  it("is not undone by what was given before the hold, with several crafts either", async () => {
    begin({ return: ["late, reply lost"] });
    withTwoCrafts();
    void sendUrgent(M, "return");
    await pass(50);
    void sendUrgent(M, "hold");
    await pass(50);
    void resume(M);
    await pass();
    expect(source.done).toEqual(["hold", "resume"]);
  });
});

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

it("an abort that fails again and again leaves a newer hold alone", async () => {
  begin({ abort: Array<Fate>(200).fill("lost") });
  void sendUrgent(M, "abort");
  await pass(100);
  void sendUrgent(M, "hold");
  await pass(120_000);
  expect(source.done).toEqual(["hold"]);
  expect(sent("abort").length).toBeGreaterThan(60);
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

/** An entry of the journal, so many ms after now. */
const told = (inMs: number, event: object) => ({ seq: 1, at_utc: new Date(Date.now() + inMs).toISOString(), event }) as unknown as Recorded;
const theirs = { kind: "command_accepted", command: "return", command_id: "theirs" };
const byItself = { kind: "return_ordered", by: null, craft_id: "c" };
const M_SHOWN = { ...emptyLive, mission: { ...emptyLive.mission, missionId: "m" } };

it.each([
  ["what somebody else has ordered since", 3000, theirs, 1],
  ["what the mission has ordered by itself since", 3000, byItself, 1],
  ["what was ordered before, and is heard only now", -3000, theirs, 3],
  ["what another craft does by itself", 3000, { ...byItself, craft_id: "d" }, 3],
])("a hold that is lost, and %s", async (_what, inMs, event, tries) => {
  begin({ hold: ["lost", "lost"] });
  live.value = M_SHOWN;
  void sendUrgent(M, "hold");
  await pass(100);
  live.value = { ...M_SHOWN, events: [told(inMs, event)] };
  await pass();
  expect(sent("hold")).toHaveLength(tries);
  expect(urgent.value).toEqual({});
  const gaveUp = problems.value.bar;
  expect(gaveUp?.detail).toBe(tries === 1 ? t("bar.overtaken") : undefined);
  expect(gaveUp?.title).toBe(tries === 1 ? t("bar.hold") : undefined);
});

it("a return given on another page goes out no more over what is heard later", async () => {
  begin({ return: ["lost"] });
  void sendUrgent(M, "return");
  await pass(100);
  live.value = { ...M_SHOWN, events: [told(3000, { ...theirs, command: "hold" })] };
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

it("keeps the refusal of a newer order in sight, whatever becomes of an older one", async () => {
  begin({ return: ["late reply"], hold: ["refused"] });
  void sendUrgent(M, "return");
  await pass(100);
  void sendUrgent(M, "hold");
  await pass();
  expect(problems.value.bar?.reason?.code).toBe("pilot_controls");
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
