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

interface Order {
  flown: Flown;
  kind: Urgent;
  /** The mission that it goes to, or the craft that flies for none. */
  to: string;
  shown: UrgentState | null;
  /** It is tried no more: the newer one that was accepted instead, null when it does not matter which. */
  endedBy?: Order | null;
  /** An older one was accepted while this was on its way, and may have been carried out after it. */
  isCrossed?: boolean;
  isRepeat?: boolean;
}

/** The first given first. An abort waits for nothing, and nothing ends it. */
const underWay = new Set<Order>();

const ordersTo = (to: string): Order[] => [...underWay].filter((order) => order.to === to);

const newerThan = (own: Order): Order[] => {
  const all = ordersTo(own.to);
  return all.slice(all.indexOf(own) + 1);
};

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

const isShown = (order: Order): boolean => order.shown !== null && urgent.peek()[order.kind] === order.shown;

function show(own: Order, state: UrgentState | null): void {
  if (!state && !isShown(own)) return;
  const { [own.kind]: _old, ...others } = urgent.value;
  urgent.value = state ? { ...others, [own.kind]: state } : others;
  own.shown = state;
}

function end(order: Order, by: Order | null): void {
  if (order.kind === "abort") return;
  order.endedBy = by;
  show(order, null);
}

/** Somebody has ordered something else since: what is still on its way is not tried again. */
export function countermand(to: string): void {
  for (const order of ordersTo(to)) end(order, null);
}

const repeat = ({ flown, kind, to }: Order): void => void give({ flown, kind, to, shown: null, isRepeat: true });

/** Accepted is not done: what the vehicle makes of it comes with the craft's status. */
export async function sendUrgent(flown: Flown, kind: Urgent): Promise<void> {
  const to = flown.id ?? flown.craftId;
  const before = ordersTo(to);
  const alike = before.filter((order) => order.kind === kind && order.endedBy === undefined);
  const isPressed = alike.some((order) => isShown(order) && (kind === "abort" || order === before.at(-1)));
  if (isPressed || (flown.id === null && kind === "abort")) return;
  for (const order of alike) end(order, null);
  for (const order of before) if (kind !== "abort" && order.kind !== "abort") show(order, null);
  report("bar", null);
  await give({ flown, kind, to, shown: null });
}

async function give(own: Order): Promise<void> {
  const { id, craftId } = own.flown;
  const { kind } = own;
  const commandId = newCommandId();
  underWay.add(own);
  for (let tries = 0; tries < GIVE_UP_AFTER && own.endedBy === undefined; ) {
    // an abort may be refused where a hold is not: only another kind is waited for
    if (kind !== "abort" && newerThan(own).some((order) => order.kind !== "abort" && order.endedBy === undefined)) {
      show(own, null);
      await pause(RETRY_MS);
      continue;
    }
    show(own, { stage: tries === 0 ? "sending" : "retrying", count: tries });
    tries += 1;
    try {
      const from = source.peek()!;
      const reply = await (id !== null
        ? from.send(id, { kind }, commandId)
        : from.order(craftId, { kind: kind as InNoMission }, commandId));
      const newer = newerThan(own);
      if (reply.accepted) for (const order of newer) order.isCrossed = true;
      if (own.endedBy !== undefined) {
        if (reply.accepted && own.endedBy && newer.length === 0) repeat(own.endedBy);
        break;
      }
      if (!own.isRepeat) report("bar", reply.accepted ? null : refusal(reply.reason));
      if (!reply.accepted) break;
      for (const order of ordersTo(own.to)) {
        if (order === own) break;
        end(order, own);
      }
      underWay.delete(own);
      if (own.isCrossed && newer.length === 0) repeat(own);
      show(own, { stage: "accepted", count: tries - 1 });
      await pause(SHOWN_MS);
      break;
    } catch (error) {
      if (own.endedBy !== undefined) break;
      report("bar", asProblem(error));
      const refused = error instanceof RequestFailed && error.problem.status >= 400 && error.problem.status < 500;
      if (refused) break;
      await pause(RETRY_MS);
    }
  }
  underWay.delete(own);
  show(own, null);
}
