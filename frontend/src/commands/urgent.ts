// Abort, hold, return and landing: sent at once, and again under the same id until the server answers. The last one given
// counts, however the answers come: where an older one may have been carried out after it, it goes out once more.
import { signal } from "@preact/signals";
import { newCommandId } from "../sources/api";
import { isRefusal, refusal } from "../sources/problem";
import { live, source } from "../state/connection";
import type { Flown } from "../state/flying";
import { TAP_MS } from "../state/tap";
import type { Problem } from "../wire";
import { asProblem, report, steered } from "./send";

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
/** By then the server sends a vehicle home whose consoles are gone; later an order would act on one that its giver no longer sees. */
const GIVE_UP_MS = 60_000;
const SHOWN_MS = 4000;
const STEERING: readonly string[] = ["hold", "return", "land", "resume", "abort"];

/** An urgent order, or a resume. */
interface Given {
  /** The mission that it goes to, or the craft that flies for none. */
  to: string;
  /** What was given later has a greater one; a repeat has its first one's. */
  n: number;
}

interface Order extends Given {
  flown: Flown;
  kind: Urgent;
  commandId: string;
  pressedMs: number;
  shown: UrgentState | null;
  /** It is tried no more: something newer counts. */
  isEnded?: boolean;
  /** It goes out once more when it is accepted: it was pressed again, or an older one may have been carried out after it. */
  isCrossed?: boolean;
}

let presses = 0;
const ownIds = new Set<string>();

/** An abort waits for nothing, and nothing ends it. */
const underWay = new Set<Order>();

/** By where it went: the last one given of those that were accepted, or that ran out of tries. */
const settled = new Map<string, Given>();

/** Leaving the page forgets them: the browser asks first. */
addEventListener("beforeunload", (event) => underWay.size > 0 && event.preventDefault());

const toOf = ({ id, craftId }: Flown): string => id ?? craftId;
const ordersTo = (to: string): Order[] => [...underWay].filter((order) => order.to === to && !order.isEnded);
const newerThan = (own: Given): Order[] => ordersTo(own.to).filter(({ n }) => n > own.n);
const lastSettled = (own: Given): Given => settled.get(own.to) ?? { to: own.to, n: 0 };

/** Refused orders do not count. */
const isLast = (own: Given): boolean => newerThan(own).length === 0 && lastSettled(own).n <= own.n;

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

const isShown = (order: Order): boolean => order.shown !== null && urgent.peek()[order.kind] === order.shown;

function show(own: Order, state: UrgentState | null): void {
  if (!state && !isShown(own)) return;
  const { [own.kind]: _old, ...others } = urgent.value;
  urgent.value = state ? { ...others, [own.kind]: state } : others;
  own.shown = state;
}

function end(order: Order): void {
  if (order.kind === "abort") return;
  order.isEnded = true;
  show(order, null);
}

/** As far as the journal is heard here. */
function isOvertaken({ commandId }: Order): boolean {
  const accepted = live.peek().events.flatMap(({ event }) => (event.kind === "command_accepted" ? [event] : []));
  const at = accepted.findIndex(({ command_id }) => command_id === commandId);
  return at >= 0 && accepted.slice(at).some(({ command, command_id }) => STEERING.includes(command) && !ownIds.has(command_id));
}

/** A resume never goes out by itself, nor anything over what somebody else has ordered since. */
function repeat(given: Given | Order): void {
  if ("kind" in given && !isOvertaken(given)) void give(given.flown, given.kind, given.n, true);
}

/** It may have been carried out just now. */
function cross(own: Given): void {
  const last = lastSettled(own);
  const newer = newerThan(own);
  for (const order of newer) order.isCrossed = true;
  if (last.n > own.n && !newer.some(({ n }) => n === last.n)) repeat(last);
}

/** What was given before it is not tried again. */
function settle(own: Given, endsOlder = true): void {
  cross(own);
  if (own.n >= lastSettled(own).n) settled.set(own.to, own);
  if (endsOlder) for (const order of ordersTo(own.to)) if (order.n < own.n) end(order);
}

/** Accepted is not done: what the vehicle makes of it comes with the craft's status. */
export async function sendUrgent(flown: Flown, kind: Urgent): Promise<void> {
  const to = toOf(flown);
  const before = ordersTo(to);
  const alike = before.filter((order) => order.kind === kind);
  const pressed = alike.find((order) => isShown(order) && (kind === "abort" || newerThan(order).length === 0));
  if (flown.id === null && kind === "abort") return;
  const n = ++presses;
  if (pressed) {
    const isTap = Date.now() - pressed.pressedMs < TAP_MS;
    pressed.n = n;
    pressed.pressedMs = Date.now();
    pressed.isCrossed ||= !isTap && kind !== "abort";
    // somebody may have resumed while the first one's answer is on its way
    if (isTap || kind !== "hold") return;
  }
  for (const order of alike) end(order);
  for (const order of before) if (kind !== "abort" && order.kind !== "abort") show(order, null);
  report("bar", null);
  await give(flown, kind, n);
}

/** Of one craft, sent once: not again after taking control, if anything was ordered meanwhile. */
export async function resume(flown: Flown): Promise<void> {
  const { id, craftId } = flown;
  const own: Given = { to: toOf(flown), n: ++presses };
  let problem: Problem;
  report("bar", null);
  try {
    const from = source.peek()!;
    const crafts = live.peek().status?.value.crafts.filter(({ mission_id }) => mission_id === id) ?? [];
    const reply = await (id !== null
      ? steered(from, id, { kind: "resume", craft_id: craftId }, () => isLast(own))
      : from.order(craftId, { kind: "resume" }));
    if (reply.accepted) {
      // what was ordered before may still be due to the mission's other crafts
      settle(own, id === null || crafts.length < 2);
      return;
    }
    problem = refusal(reply.reason);
  } catch (error) {
    if (!isRefusal(error)) cross(own);
    problem = asProblem(error);
  }
  if (isLast(own)) report("bar", problem);
}

async function give(flown: Flown, kind: Urgent, n: number, isRepeat = false): Promise<void> {
  const { id, craftId } = flown;
  const commandId = newCommandId();
  const own: Order = { flown, kind, n, to: toOf(flown), commandId, pressedMs: Date.now(), shown: null };
  ownIds.add(commandId);
  underWay.add(own);
  for (let tries = 0; !own.isEnded; ) {
    const isLate = Date.now() - own.pressedMs > GIVE_UP_MS;
    // an abort may be refused where a hold is not: only another kind is waited for
    if (kind !== "abort" && newerThan(own).some((order) => order.kind !== "abort")) {
      show(own, null);
      if (isLate) break;
      await pause(RETRY_MS);
      continue;
    }
    if (isLate) {
      (kind === "abort" ? cross : settle)(own);
      break;
    }
    show(own, { stage: tries === 0 ? "sending" : "retrying", count: tries });
    tries += 1;
    try {
      const from = source.peek()!;
      const reply = await (id !== null
        ? from.send(id, { kind }, commandId)
        : from.order(craftId, { kind: kind as InNoMission }, commandId));
      if (reply.accepted) {
        underWay.delete(own);
        settle(own);
      }
      if (own.isEnded) break;
      // a repeated return or landing may be refused as done already
      report("bar", reply.accepted || (isRepeat && kind !== "hold") ? null : refusal(reply.reason));
      if (!reply.accepted) break;
      if (own.isCrossed && settled.get(own.to) === own) repeat(own);
      show(own, { stage: "accepted", count: tries - 1 });
      await pause(SHOWN_MS);
      break;
    } catch (error) {
      // an abort is tried on: what becomes of it shows then
      if (kind !== "abort" && !isRefusal(error)) cross(own);
      if (own.isEnded) break;
      report("bar", asProblem(error));
      if (isRefusal(error)) break;
      await pause(RETRY_MS);
    }
  }
  underWay.delete(own);
  show(own, null);
}
