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

function show(kind: Urgent, state: UrgentState | null): UrgentState | null {
  const { [kind]: _old, ...others } = urgent.value;
  urgent.value = state ? { ...others, [kind]: state } : others;
  return state;
}

type Target = Pick<Flown, "id" | "craftId">;

interface Order extends Target {
  kind: Urgent;
  /** A newer order to the same craft, which counts instead. */
  instead?: Order;
}

const onTheWay = new Set<Order>();

/** The last order counts: an older one that arrived after it would be carried out after it. Nothing ends an abort. */
function replace(older: readonly Order[], instead: Order): void {
  for (const order of older) {
    if (order.kind === instead.kind || order.kind === "abort" || !onTheWay.delete(order)) continue;
    order.instead = instead;
    show(order.kind, null);
  }
}

const lastOf = (order: Order): Order => (order.instead ? lastOf(order.instead) : order);

/** Accepted is not done: what the vehicle makes of it comes with the craft's status. */
export async function sendUrgent({ id, craftId }: Target, kind: Urgent): Promise<void> {
  if (id === null && kind === "abort") return;
  const older = [...onTheWay].filter((order) => order.craftId === craftId || (id !== null && order.id === id));
  if (urgent.peek()[kind] && older.some((order) => order.kind === kind)) return;
  const own: Order = { id, craftId, kind };
  // an abort may be refused where a hold is not
  if (kind !== "abort") replace(older, own);
  onTheWay.add(own);
  const commandId = newCommandId();
  let shown: UrgentState | null = null;
  report("bar", null);
  for (let count = 0; count < GIVE_UP_AFTER && onTheWay.has(own); count++) {
    shown = show(kind, { stage: count === 0 ? "sending" : "retrying", count });
    try {
      const to = source.peek()!;
      const reply = await (id !== null ? to.send(id, { kind }, commandId) : to.order(craftId, { kind: kind as InNoMission }, commandId));
      if (own.instead) {
        // it arrived after all, perhaps as the last
        if (reply.accepted) void sendUrgent(lastOf(own), lastOf(own).kind);
        return;
      }
      onTheWay.delete(own);
      if (!reply.accepted) {
        report("bar", refusal(reply.reason));
        break;
      }
      replace(older, own);
      report("bar", null);
      shown = show(kind, { stage: "accepted", count });
      await pause(SHOWN_MS);
    } catch (error) {
      if (own.instead) return;
      report("bar", asProblem(error));
      const refused = error instanceof RequestFailed && error.problem.status >= 400 && error.problem.status < 500;
      if (refused) break;
      await pause(RETRY_MS);
    }
  }
  onTheWay.delete(own);
  if (urgent.peek()[kind] === shown) show(kind, null);
}
