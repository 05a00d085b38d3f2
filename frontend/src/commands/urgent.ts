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

/** Accepted is not done: what the vehicle makes of it comes with the craft's status. */
export async function sendUrgent({ id, craftId }: Flown, kind: Urgent): Promise<void> {
  const underWay = urgent.peek()[kind];
  if ((underWay && underWay.stage !== "accepted") || (id === null && kind === "abort")) return;
  const commandId = newCommandId();
  report("bar", null);
  for (let count = 0; count < GIVE_UP_AFTER; count++) {
    show(kind, { stage: count === 0 ? "sending" : "retrying", count });
    try {
      const to = source.peek()!;
      const reply = await (id !== null ? to.send(id, { kind }, commandId) : to.order(craftId, { kind: kind as InNoMission }, commandId));
      if (!reply.accepted) {
        report("bar", refusal(reply.reason));
        break;
      }
      report("bar", null);
      show(kind, { stage: "accepted", count });
      await pause(SHOWN_MS);
      break;
    } catch (error) {
      report("bar", asProblem(error));
      const refused = error instanceof RequestFailed && error.problem.status >= 400 && error.problem.status < 500;
      if (refused) break;
      await pause(RETRY_MS);
    }
  }
  show(kind, null);
}
