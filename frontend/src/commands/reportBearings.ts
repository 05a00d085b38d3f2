// The phone's bearings go to the server one after the other; without a link they wait in the browser.
import { computed, signal } from "@preact/signals";
import { newCommandId } from "../sources/api";
import { isRefusal, RequestFailed } from "../sources/problem";
import { type BearingReport, reportBearing, restoreBearing, takeBackBearing } from "../sources/reportsApi";
import { add, answered, lastOf, nextOf, type Queue, type Queued, read, restore, takeBackLast, withdrawn } from "../state/bearingQueue";
import { keep, kept } from "../state/kept";
import { me, refreshSession, session } from "../state/session";
import { TAP_MS } from "../state/tap";

const KEY = "crossfix.bearings";
const AGAIN_MS = 4000;
const TWICE_MS = 2000;
const TWICE_DEG = 2;

type Told = Omit<BearingReport, "bearing_id" | "taken_at_utc">;

const stored = () => kept(KEY);

export const queue = signal<Queue>(read(stored()));
/** The last attempt did not reach the server. */
export const unreached = signal(false);

/** Whose bearings are sent: see `isOwn`. */
export const reporting = computed<string | null | undefined>(() =>
  session.value === null || session.value === "unreachable" ? undefined : (me.value?.name ?? null),
);

/** False: a private window keeps nothing, a full one not all; the bearings live as long as the page. */
let keeps = true;

/** Of what the browser keeps, where another tab may have put bearings meanwhile. */
function change(next: (queue: Queue) => Queue): void {
  const kept = keeps ? stored() : null;
  queue.value = next(kept === null ? queue.peek() : read(kept));
  keeps = keep(KEY, queue.peek());
}

const refused = (error: unknown): string | null => (isRefusal(error) ? error.problem.detail || error.problem.title : null);

const isUnknown = (error: unknown) =>
  error instanceof RequestFailed && (error.problem.status === 404 || error.problem.reason?.code === "no_such_bearing");

async function say({ missionId, report, stage }: Queued): Promise<void> {
  const id = report.bearing_id;
  if (stage === "withdrawing") {
    try {
      await takeBackBearing(missionId, id);
      change((now) => withdrawn(now, id));
    } catch (error) {
      const why = refused(error);
      if (why === null) throw error;
      change((now) => withdrawn(now, id, isUnknown(error) ? null : why));
    }
    return;
  }
  try {
    await reportBearing(missionId, report);
    if (stage === "restoring") await restoreBearing(missionId, id);
    change((now) => answered(now, id, null));
  } catch (error) {
    const why = refused(error);
    if (why === null) throw error;
    change((now) => answered(now, id, why));
  }
}

let busy = false;

export async function sendWaiting(): Promise<void> {
  if (busy || !nextOf(queue.peek(), reporting.peek())) return;
  busy = true;
  try {
    if (reporting.peek() === undefined) await refreshSession();
    if (reporting.peek() === undefined) throw new Error("the server has not said who is signed in");
    for (let next = nextOf(queue.peek(), reporting.peek()); next; next = nextOf(queue.peek(), reporting.peek())) {
      await say(next);
      unreached.value = false;
    }
  } catch {
    unreached.value = true;
  } finally {
    busy = false;
  }
}

/** A thumb's second tap, while compass and place may have moved a little. */
function isTwice({ report: { taken_at_utc, ...last } }: Queued, bearing: Told): boolean {
  const off = Math.abs(last.bearing_deg - bearing.bearing_deg);
  const isSame = (["by", "emitter_id", "sigma_deg", "snr_db"] as const).every((name) => last[name] === bearing[name]);
  const alike = isSame && Math.min(off, 360 - off) < TWICE_DEG;
  return alike && Math.abs(Date.now() - Date.parse(taken_at_utc ?? "")) < TWICE_MS;
}

export function report(missionId: string, bearing: Told): void {
  const last = lastOf(queue.peek(), missionId, reporting.peek());
  if (last && isTwice(last, bearing)) return;
  const taken = { ...bearing, bearing_id: newCommandId(), taken_at_utc: new Date().toISOString() };
  change((now) => add(now, missionId, taken, reporting.peek() ?? undefined));
  void sendWaiting();
}

let backAt = Number.NEGATIVE_INFINITY;

/** atMs: of the tap; a thumb's second one takes nothing more back. */
export function backspace(missionId: string, atMs: number): void {
  if (atMs - backAt < TAP_MS) return;
  backAt = atMs;
  change((now) => takeBackLast(now, missionId, reporting.peek()));
  void sendWaiting();
}

export function countAgain(bearingId: string): void {
  change((now) => restore(now, bearingId));
  void sendWaiting();
}

/** Until what it returns is called. Two at once send nothing twice. */
export function keepSending(): () => void {
  const again = setInterval(() => void sendWaiting(), AGAIN_MS);
  const online = () => void sendWaiting();
  const elsewhere = ({ key, newValue }: StorageEvent) => {
    if (key === KEY && newValue !== null) queue.value = read(newValue);
  };
  addEventListener("online", online);
  addEventListener("storage", elsewhere);
  void sendWaiting();
  return () => {
    clearInterval(again);
    removeEventListener("online", online);
    removeEventListener("storage", elsewhere);
  };
}
