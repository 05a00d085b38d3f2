// Abort, hold, return and landing: sent at once, and again under the same id until the server answers. Every press has a
// number: the server carries out none that reaches it after a later one of this page, so that the last one given counts.
import { computed, effect, signal } from "@preact/signals";
import { type MessageKey, t } from "../i18n";
import { newCommandId } from "../sources/api";
import { isRefusal, localProblem, RequestFailed, refusal } from "../sources/problem";
import { live, source } from "../state/connection";
import type { Flown } from "../state/flying";
import { entered, me } from "../state/session";
import { TAP_MS } from "../state/tap";
import type { Problem, Recorded } from "../wire";
import { asProblem, report, steered } from "./send";

export type Urgent = "abort" | "hold" | "return" | "land";

/** A craft without a mission has none to abort. */
type InNoMission = Exclude<Urgent, "abort">;

export interface UrgentState {
  stage: "sending" | "retrying" | "accepted";
  count: number;
  /** When a status that is heard was told after it was accepted. */
  newsMs?: number;
}

/** One entry a kind: a hold never takes the place of an abort that is still on its way. */
export const urgent = signal<Partial<Record<Urgent, UrgentState>>>({});

const RETRY_MS = 700;
/** A first try that hangs is followed by one that may take twice as long. */
const FIRST_TRY_MS = 3000;
const LONGEST_TRY_MS = 20_000;
/** By then the server sends a vehicle home whose consoles are gone; later an order would act on one that its giver no longer sees. */
const GIVE_UP_MS = 60_000;
const SHOWN_MS = 4000;
/** So long a status may be on its way, and wait to be shown. */
const STATUS_MS = 250;
/** What was ordered sooner after the press may have been ordered before it: the server's clock is known no better, by ours. */
const CLOCKS_MS = 2000;
const STEERING: readonly string[] = ["hold", "return", "land", "resume", "abort"];

interface Order {
  flown: Flown;
  kind: Urgent;
  /** The mission that it goes to, or the craft that flies for none. */
  to: string;
  press: number;
  commandId: string;
  /** By both clocks: one is set, the other stands still while the machine sleeps. */
  pressedMs: readonly [number, number];
  shown: UrgentState | null;
  /** It is tried no more: something newer counts. */
  isEnded?: boolean;
}

let presses = 0;
/** By where it went. */
const lastPress = new Map<string, number>();
let lastTap: { of: string; atMs: number } | null = null;
const ownIds = new Set<string>();
const underWay = new Set<Order>();

/** Leaving the page forgets them: the browser asks first. */
addEventListener("beforeunload", (event) => underWay.size > 0 && event.preventDefault());

/** Whoever enters next has given no order. */
const giver = computed(() => (entered.value === "out" ? "" : me.value?.person_id));
effect(() => {
  void giver.value;
  for (const order of underWay) end(order);
});

const toOf = ({ id, craftId }: Flown): string => id ?? craftId;
const ordersTo = (to: string): Order[] => [...underWay].filter((order) => order.to === to && !order.isEnded);
const clocks = (): readonly [number, number] => [Date.now(), performance.now()];
const betweenMs = ({ pressedMs }: Order, then = clocks()): number => Math.max(...then.map((ms, clock) => ms - pressedMs[clock]!));

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

function newId(): string {
  const id = newCommandId();
  ownIds.add(id);
  return id;
}

function newPress(to: string): number {
  presses += 1;
  lastPress.set(to, presses);
  return presses;
}

function show(own: Order, state: UrgentState | null): void {
  if (!state && (own.shown === null || urgent.peek()[own.kind] !== own.shown)) return;
  const { [own.kind]: _old, ...others } = urgent.peek();
  urgent.value = state ? { ...others, [own.kind]: state } : others;
  own.shown = state;
}

function end(order: Order): void {
  order.isEnded = true;
  show(order, null);
}

/** An abort is never ended by another kind. */
function endOlder(to: string, press: number): void {
  for (const order of ordersTo(to)) if (order.press < press && order.kind !== "abort") end(order);
}

function isSteering({ event }: Recorded, craftId: string): boolean {
  if (event.kind === "return_ordered" || event.kind === "land_ordered") return event.by === null && event.craft_id === craftId;
  return event.kind === "command_accepted" && STEERING.includes(event.command) && !ownIds.has(event.command_id);
}

/** When the last status was heard: the machine may have slept before it, or since. */
let heardMs = clocks();
const told = computed(() => live.value.status);
effect(() => {
  void told.value;
  heardMs = clocks();
});

/** After when it was surely pressed, by the server's clock as heard since: what was known of that before a sleep is old. */
function surelyAfterMs(order: Order): number {
  const { status, beganMs, hello } = live.peek();
  if (!status || status.atMs <= Math.max(beganMs, order.pressedMs[1])) return Infinity;
  return Date.parse(status.value.at_utc) + (CLOCKS_MS - betweenMs(order, heardMs)) * (hello?.time_factor ?? 1);
}

/** Has somebody else, or the mission by itself, ordered something since? As far as the journal is heard here. */
function isOvertaken(order: Order): boolean {
  const { mission, events } = live.peek();
  const { id, craftId } = order.flown;
  const afterMs = surelyAfterMs(order);
  return mission.missionId === id && events.some((told) => Date.parse(told.at_utc) > afterMs && isSteering(told, craftId));
}

let toldPress = 0;

/** What became of an order says nothing of a newer one. */
function tell(press: number, problem: Problem | null): void {
  if (press < toldPress) return;
  toldPress = press;
  report("bar", problem);
}

/** Accepted is not done: what the vehicle makes of it comes with the craft's status. */
export async function sendUrgent(flown: Flown, kind: Urgent): Promise<void> {
  const to = toOf(flown);
  if (flown.id === null && kind === "abort") return;
  const atMs = performance.now();
  const of = `${kind} ${to}`;
  if (lastTap?.of === of && atMs - lastTap.atMs < TAP_MS) return; // a thumb's second tap
  lastTap = { of, atMs };
  for (const order of ordersTo(to)) {
    if (order.kind === kind) end(order);
    else if (kind !== "abort" && order.kind !== "abort") show(order, null);
  }
  await give(flown, kind);
}

/** Of one craft, sent once: not again after taking control, if anything was ordered meanwhile. */
export async function resume(flown: Flown): Promise<void> {
  const { id, craftId } = flown;
  const to = toOf(flown);
  const press = newPress(to);
  lastTap = null;
  const isLast = () => lastPress.get(to) === press;
  tell(press, null);
  let problem: Problem;
  try {
    const from = source.peek()!;
    const crafts = live.peek().status?.value.crafts.filter(({ mission_id }) => mission_id === id) ?? [];
    const reply = await (id !== null
      ? steered(from, id, { kind: "resume", craft_id: craftId }, { isWanted: isLast, press, newId })
      : from.order(craftId, { kind: "resume" }, { press }));
    if (reply.accepted) {
      // what was ordered before may still be due to the mission's other crafts
      if (id === null || crafts.length === 1) endOlder(to, press);
      return;
    }
    problem = refusal(reply.reason);
  } catch (error) {
    problem = asProblem(error);
  }
  tell(press, problem);
}

/** Somebody who enters after a session has ended has given no order. */
const isFinal = (error: unknown): boolean => isRefusal(error) || (error instanceof RequestFailed && error.problem.status === 401);

async function give(flown: Flown, kind: Urgent): Promise<void> {
  const { id, craftId } = flown;
  const to = toOf(flown);
  const press = newPress(to);
  const own: Order = { flown, kind, to, press, commandId: newId(), pressedMs: clocks(), shown: null };
  const giveUp = (why: MessageKey) => report("bar", localProblem(t(`bar.${kind}` satisfies MessageKey), t(why)));
  tell(press, null);
  underWay.add(own);
  for (let tries = 0; !own.isEnded; ) {
    const left = GIVE_UP_MS - betweenMs(own);
    if (left <= 0) {
      giveUp("bar.unanswered");
      break;
    }
    // an abort may be refused where a hold is not: only another kind is waited for
    if (kind !== "abort" && ordersTo(to).some((order) => order.press > press && order.kind !== "abort")) {
      show(own, null);
      await pause(RETRY_MS);
      continue;
    }
    const from = source.peek();
    if (!from) break;
    if (tries > 0 && kind !== "abort" && isOvertaken(own)) {
      giveUp("bar.overtaken");
      break;
    }
    show(own, { stage: tries === 0 ? "sending" : "retrying", count: tries });
    const sending = { commandId: own.commandId, press, timeoutMs: Math.min(FIRST_TRY_MS * 2 ** tries, LONGEST_TRY_MS, left) };
    tries += 1;
    try {
      const reply = await (id !== null ? from.send(id, { kind }, sending) : from.order(craftId, { kind: kind as InNoMission }, sending));
      if (reply.accepted) endOlder(to, press);
      if (own.isEnded || reply.reason?.code === "later_order_counts") break;
      tell(press, reply.accepted ? null : refusal(reply.reason));
      if (!reply.accepted) break;
      underWay.delete(own);
      show(own, { stage: "accepted", count: tries - 1, newsMs: performance.now() + STATUS_MS });
      await pause(SHOWN_MS);
      break;
    } catch (error) {
      if (own.isEnded) break;
      tell(press, asProblem(error));
      if (isFinal(error)) break;
      await pause(RETRY_MS);
    }
  }
  underWay.delete(own);
  show(own, null);
}
