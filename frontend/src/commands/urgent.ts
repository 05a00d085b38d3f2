// Abort, hold, return and landing: sent at once, and again under the same id until the server answers.
import { signal } from "@preact/signals";
import { newCommandId } from "../sources/api";
import { RequestFailed, refusal } from "../sources/problem";
import { source } from "../state/connection";
import type { Flown } from "../state/flying";
import { asProblem, report } from "./send";

export type Urgent = "abort" | "hold" | "return" | "land";

/** A craft without a mission has none to abort. */
type InNoMission = Exclude<Urgent, "abort">;

export interface UrgentState {
  stage: "sending" | "retrying" | "accepted";
  count: number;
  to: string;
}

/** One entry a kind: a hold never takes the place of an abort that is still on its way. */
export const urgent = signal<Partial<Record<Urgent, UrgentState>>>({});

const RETRY_MS = 700;
const GIVE_UP_AFTER = 60;
const SHOWN_MS = 4000;

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

function show(kind: Urgent, state: UrgentState | null): void {
  const { [kind]: _old, ...others } = urgent.value;
  urgent.value = state ? { ...others, [kind]: state } : others;
}

/** Gives the last order once more, by the mission that it went to, or by the craft that flies for none. */
const newest = new Map<string, () => void>();

/** The trying of an older one ends, else it would be carried out after this. Nothing ends an abort. */
function count(to: string, again: () => void): void {
  newest.set(to, again);
  const { abort } = urgent.peek();
  urgent.value = abort ? { abort } : {};
}

/** Accepted is not done: what the vehicle makes of it comes with the craft's status. */
export async function sendUrgent(flown: Flown, kind: Urgent): Promise<void> {
  const { id, craftId } = flown;
  const to = id ?? craftId;
  const underWay = urgent.peek()[kind];
  if ((underWay?.to === to && underWay.stage !== "accepted") || (id === null && kind === "abort")) return;
  const commandId = newCommandId();
  const before = newest.get(to);
  const again = () => void sendUrgent(flown, kind);
  const counts = () => kind === "abort" || newest.get(to) === again;
  if (kind !== "abort") count(to, again);
  report("bar", null);
  for (let tries = 0; tries < GIVE_UP_AFTER && counts(); tries++) {
    show(kind, { stage: tries === 0 ? "sending" : "retrying", count: tries, to });
    try {
      const from = source.peek()!;
      const reply = await (id !== null
        ? from.send(id, { kind }, commandId)
        : from.order(craftId, { kind: kind as InNoMission }, commandId));
      if (!counts()) {
        // it arrived all the same, perhaps after the one that counts
        if (reply.accepted) newest.get(to)!();
        return;
      }
      report("bar", reply.accepted ? null : refusal(reply.reason));
      if (!reply.accepted) break;
      // an abort only now: it may be refused where a hold is not
      if (newest.get(to) === before) count(to, again);
      show(kind, { stage: "accepted", count: tries, to });
      await pause(SHOWN_MS);
      break;
    } catch (error) {
      if (!counts()) return;
      report("bar", asProblem(error));
      const refused = error instanceof RequestFailed && error.problem.status >= 400 && error.problem.status < 500;
      if (refused) break;
      await pause(RETRY_MS);
    }
  }
  if (counts()) show(kind, null);
}
