// For tests: a server behind a link that loses and delays orders and answers, as the test chose.

import { afterEach, beforeEach, vi } from "vitest";
import type { Sending } from "../sources/api";
import { accepted, FakeSource } from "../sources/fakeSource";
import { localProblem, RequestFailed, unreachable } from "../sources/problem";
import { live } from "../state/connection";
import { emptyLive } from "../state/live";
import type { Command, CommandReply } from "../wire";
import { problems } from "./send";

const refused: CommandReply = { ...accepted, accepted: false, reason: { code: "pilot_controls" } };
const late: CommandReply = { ...accepted, accepted: false, reason: { code: "later_order_counts" } };

export type Fate = "at once" | "late" | "late reply" | "lost" | "reply lost" | "late, reply lost" | "refused";
/** A number: the status of the answer. */
export type Answer = Fate | number;

export const later = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

/**
 * A server that carries out each command id once and nothing that was given before what each craft has accepted, behind
 * a link that treats the first try of each kind as it was asked to.
 */
export class LossyServer extends FakeSource {
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

export const pass = (ms = 10_000) => vi.advanceTimersByTimeAsync(ms);

/** Each test of the file begins with nothing on its way, and ends so. */
export function inTimeOfItsOwn(): void {
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
}
