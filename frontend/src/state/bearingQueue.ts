// Bearings on their way from a phone to the server, kept in the browser until the server has them. Pure.
import type { components } from "../wire/generated";

type Report = components["schemas"]["BearingReport"];

/** waiting: the server has not answered; sent: it has it; withdrawing: to be taken back there; back: taken back; restoring: to count again there; refused: by the server, and why. */
export type Stage = "waiting" | "sent" | "withdrawing" | "back" | "restoring" | "refused";

export interface Queued {
  missionId: string;
  report: Report;
  stage: Stage;
  /** Why the server refused it, in its words. */
  problem: string | null;
  /** Who was signed in when it was taken; missing: nobody had to be, or the server could not be asked. */
  who?: string;
}

export type Queue = readonly Queued[];

const COUNTS: readonly Stage[] = ["waiting", "sent", "restoring"];
const TO_SAY: readonly Stage[] = ["waiting", "withdrawing", "restoring"];

/** Of those of which the server knows; what it has not heard is kept, however many there are. */
export const KEPT = 40;

/** name: who is signed in, null for nobody, undefined when that is not known: then it may be anybody's. */
export const isOwn = ({ who }: Queued, name: string | null | undefined): boolean => name === undefined || who === undefined || who === name;

export function add(queue: Queue, missionId: string, report: Report, who?: string): Queue {
  const said = queue.filter((one) => !TO_SAY.includes(one.stage));
  const old = new Set(said.slice(0, Math.max(0, said.length + 1 - KEPT)));
  return [...queue.filter((one) => !old.has(one)), { missionId, report, stage: "waiting" as const, problem: null, ...(who && { who }) }];
}

const change = (queue: Queue, bearingId: string, changes: Partial<Queued>): Queue =>
  queue.map((one) => (one.report.bearing_id === bearingId ? { ...one, ...changes } : one));

/** What the server said: null for yes, else why not. One that was meanwhile taken back stays to be withdrawn. */
export function answered(queue: Queue, bearingId: string, problem: string | null): Queue {
  const one = queue.find((each) => each.report.bearing_id === bearingId);
  if (!one) return queue;
  if (one.stage === "withdrawing") return problem === null ? queue : change(queue, bearingId, { stage: "back" });
  if (one.stage === "restoring") return change(queue, bearingId, problem === null ? { stage: "sent" } : { stage: "back", problem });
  return change(queue, bearingId, problem === null ? { stage: "sent" } : { stage: "refused", problem });
}

/** null: it is taken back at the server, or was never there. Else why not: it is sent again, which tells whether it counts. */
export const withdrawn = (queue: Queue, bearingId: string, problem: string | null = null): Queue =>
  change(queue, bearingId, { stage: problem === null ? "back" : "waiting", problem });

/** One that the server may never have had is sent once more: what it has already, it does not count twice. */
export const restore = (queue: Queue, bearingId: string): Queue =>
  queue.map((one) => (one.report.bearing_id === bearingId && one.stage === "back" ? { ...one, stage: "restoring", problem: null } : one));

/** The last own bearing that counts, or is on its way to. */
export const lastOf = (queue: Queue, missionId: string, name?: string | null): Queued | undefined =>
  queue.findLast((one) => one.missionId === missionId && COUNTS.includes(one.stage) && isOwn(one, name));

/** "Backspace". One that may have reached the server although it never answered is withdrawn there as well. */
export function takeBackLast(queue: Queue, missionId: string, name?: string | null): Queue {
  const last = lastOf(queue, missionId, name);
  return last ? change(queue, last.report.bearing_id, { stage: "withdrawing", problem: null }) : queue;
}

/** What is to be said to the server next, the oldest first; another's waits until they are signed in again. */
export const nextOf = (queue: Queue, name?: string | null): Queued | undefined =>
  queue.find((one) => TO_SAY.includes(one.stage) && isOwn(one, name));

export const pending = (queue: Queue, name?: string | null): number =>
  queue.filter((one) => TO_SAY.includes(one.stage) && isOwn(one, name)).length;

const isQueued = (one: unknown): one is Queued =>
  typeof one === "object" && one !== null && "report" in one && "missionId" in one && "stage" in one;

/** From the browser's storage; what is no queue is no bearing. */
export function read(text: string | null): Queue {
  try {
    const found: unknown = JSON.parse(text ?? "[]");
    return Array.isArray(found) ? found.filter(isQueued) : [];
  } catch {
    return [];
  }
}
