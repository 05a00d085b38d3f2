// The page's state: what the source told, the moment looked at, and what follows from both.
import { batch, computed, effect, signal } from "@preact/signals";
import type { Source, SourceMessage } from "../sources/source";
import { emptyLive, reduceLive, type LiveState } from "../state/live";
import { inFlight, missionAt, suppose, type MissionState } from "../state/mission";
import { steady, unseen, type VehicleView } from "../state/steady";
import type { Phase, TrackFact, WhatIf } from "../wire";
import type { BeliefFrame, LonLat } from "../wire/beliefFrame";

export const live = signal<LiveState>(emptyLive);
export const source = signal<Source | null>(null);

/** Monotonic page time, ms; moves four times a second so that ages move: with what is heard, else by itself. */
export const nowMs = signal(performance.now());
const TICK_MS = 250;
setInterval(() => {
  if (performance.now() - nowMs.peek() > 1.5 * TICK_MS) nowMs.value = performance.now();
}, TICK_MS);

/** Sequence number of the event looked at; null: now. */
export const cursor = signal<number | null>(null);

export const events = computed(() => live.value.events);
const liveMission = computed(() => live.value.mission);

/** A decision of the review taken anew with another sensor or planner: shown in place of what happened, never flown. */
export interface Supposed {
  missionId: string;
  /** Counted bearings after which the decision is taken. */
  bearings: number;
  answer: WhatIf;
  frame: BeliefFrame;
}

export const supposed = signal<Supposed | null>(null);

const happened = computed<MissionState>(() =>
  cursor.value === null ? liveMission.value : missionAt(events.value, cursor.value),
);

/** The bearings that count at the moment shown, as they were flown. */
export const flownBearings = computed(() => happened.value.bearings.filter((b) => !b.excluded).map((b) => b.fact));

/** Only in the review, and only where as many bearings count as it was asked for. */
export const supposedHere = computed<Supposed | null>(() => {
  const what = supposed.value;
  if (!what || cursor.value === null || what.missionId !== happened.value.missionId) return null;
  return flownBearings.value.length === what.bearings ? what : null;
});

export const mission = computed<MissionState>(() => {
  const real = happened.value;
  const answer = supposedHere.value?.answer;
  return answer ? suppose(real, answer) : real;
});

/** UTC of the event looked at, ms; null while live. */
export const reviewTimeMs = computed<number | null>(() => {
  if (cursor.value === null) return null;
  const at = events.value.findLast((e) => e.seq <= cursor.value!)?.at_utc;
  return at === undefined ? null : Date.parse(at);
});

export const track = signal<readonly TrackFact[]>([]);

const telemetry = computed(() => live.value.telemetry);

const reviewPoint = computed<TrackFact | null>(() => {
  const time = reviewTimeMs.value;
  if (time === null) return null;
  return track.value.findLast((p) => Date.parse(p.at_utc) <= time) ?? track.value[0] ?? null;
});

const seen = computed<VehicleView>(() => {
  if (cursor.value !== null) {
    const point = reviewPoint.value;
    return point ? { at: [point.lon, point.lat], headingDeg: point.heading_deg, speedMs: null } : unseen;
  }
  const value = telemetry.value?.value;
  if (!value) return unseen;
  const at: LonLat | null = value.lon !== null && value.lat !== null ? [value.lon, value.lat] : null;
  return { at, headingDeg: value.heading_deg, speedMs: value.ground_speed_m_s };
});

export const vehicle = signal<VehicleView>(unseen);
effect(() => {
  vehicle.value = cursor.value === null ? steady(vehicle.peek(), seen.value) : seen.value;
});

const livePath = computed(() => live.value.path);

export const path = computed<readonly LonLat[]>(() => {
  const time = reviewTimeMs.value;
  const until = time ?? Infinity;
  const flown = track.value.filter((p) => Date.parse(p.at_utc) <= until).map((p): LonLat => [p.lon, p.lat]);
  return time === null && source.value?.kind !== "replay" ? [...flown, ...livePath.value] : flown;
});

/** Beliefs by the event that told of them, the prior by the event since which it is the specification's. */
const beliefs = new Map<number, BeliefFrame>();
export const belief = signal<BeliefFrame | null>(null);

const liveBelief = computed(() => live.value.belief);
const liveBeliefSeq = computed(() => live.value.beliefSeq);
effect(() => {
  if (liveBelief.value && liveBeliefSeq.value !== null) beliefs.set(liveBeliefSeq.value, liveBelief.value);
});

/** In flight the belief follows its event on the same socket: only when it does not is it asked for. */
const PUSHED_WITHIN_MS = 1_500;

/** The picture to draw: what is supposed, else what happened. */
export const shownBelief = computed(() => supposedHere.value?.frame ?? belief.value);

const beliefIsPushed = computed(() => cursor.value === null && source.value?.kind === "live" && inFlight(liveMission.value.phase));
const shownMission = computed(() => happened.value.missionId);
const beliefBearings = computed(() => happened.value.belief?.fact.bearings ?? 0);
const beliefSeq = computed(() => (happened.value.spec ? (happened.value.belief?.seq ?? happened.value.specSeq) : null));

effect(() => {
  const seq = beliefSeq.value;
  const from = source.value;
  const id = shownMission.value;
  if (seq === null || !from || !id) {
    belief.value = null;
    return;
  }
  const known = seq === liveBeliefSeq.value ? liveBelief.value : beliefs.get(seq);
  if (known) {
    belief.value = known;
    return;
  }
  const timer = setTimeout(() => void ask(from, id, seq), beliefIsPushed.value ? PUSHED_WITHIN_MS : 0);
  return () => clearTimeout(timer);
});

async function ask(from: Source, id: string, seq: number): Promise<void> {
  const frame = await from.belief(id, beliefBearings.peek(), seq).catch(() => null);
  if (source.peek() !== from || beliefSeq.peek() !== seq) return;
  if (frame) beliefs.set(seq, frame);
  belief.value = frame;
}

const status = computed(() => live.value.status);
const statusMission = computed(() => status.value?.value.mission_id ?? null);
const statusPhase = computed(() => (status.value?.value.phase ?? null) as Phase | null);

/** The mission that abort, hold and return act on: the one the vehicle flies, whatever the page shows. */
export const flying = computed<{ id: string; phase: Phase } | null>(() => {
  const shown = liveMission.value;
  if (source.value?.kind !== "replay" && shown.missionId && inFlight(shown.phase)) return { id: shown.missionId, phase: shown.phase };
  if (statusMission.value && statusPhase.value && inFlight(statusPhase.value)) {
    return { id: statusMission.value, phase: statusPhase.value };
  }
  return null;
});

/** The server's clock now, ms UTC: a simulated mission's clock runs faster than this page's. */
export const serverNowMs = computed<number>(() => {
  const { telemetry, status, hello } = live.value;
  const newest = [telemetry, status].filter((r) => r !== null).toSorted((a, b) => b.atMs - a.atMs)[0];
  if (!newest) return Date.now() + 0 * nowMs.value;
  return Date.parse(newest.value.at_utc) + (nowMs.value - newest.atMs) * (hello?.time_factor ?? 1);
});

/** The moment shown: of the review, of the mission's end, or now. */
export const shownTimeMs = computed<number>(() => {
  const ended = mission.value.ended;
  return reviewTimeMs.value ?? (ended ? Date.parse(ended.at) : serverNowMs.value);
});

/** Messages are folded at most once a frame; a belief at once, so that the map draws it in the very next frame. */
let pending: SourceMessage[] = [];
let scheduled = false;
let waiting: ReturnType<typeof setTimeout> | undefined;

/** These are shown with the next telemetry, if that comes within the time: each frame drawn costs the whole page. */
const CAN_WAIT: ReadonlySet<SourceMessage["type"]> = new Set(["sweep_progress", "status"]);
const WAIT_MS = 100;

function flush(): void {
  scheduled = false;
  clearTimeout(waiting);
  waiting = undefined;
  if (pending.length === 0) return;
  const messages = pending;
  pending = [];
  const time = performance.now();
  batch(() => {
    live.value = messages.reduce((state, message) => reduceLive(state, message, time), live.peek());
    if (time - nowMs.peek() > TICK_MS) nowMs.value = time;
  });
}

function receive(message: SourceMessage): void {
  pending.push(message);
  if (message.type === "belief") return flush();
  if (scheduled) return;
  if (CAN_WAIT.has(message.type)) {
    waiting ??= setTimeout(flush, WAIT_MS);
    return;
  }
  scheduled = true;
  if (document.hidden) setTimeout(flush, 50);
  else requestAnimationFrame(flush);
}

/** Shows another source. What is known of the vehicle stays, so that the safety bar never goes blank. */
export function open(next: Source): void {
  source.peek()?.stop();
  pending = [];
  const { telemetry: lastTelemetry, status: lastStatus } = live.peek();
  batch(() => {
    beliefs.clear();
    belief.value = null;
    track.value = [];
    cursor.value = null;
    supposed.value = null;
    live.value = {
      ...emptyLive,
      telemetry: lastTelemetry,
      status: lastStatus,
      link: { ...emptyLive.link, sinceMs: performance.now() },
    };
    source.value = next;
  });
  next.start((message) => {
    if (source.peek() === next) receive(message);
  });
  if (next.missionId) void loadTrack(next, next.missionId);
}

/** The path flown before this page was opened; asked again for a review. */
export async function loadTrack(from: Source, missionId: string): Promise<void> {
  const loaded = await from.track(missionId).catch(() => null);
  if (!loaded || source.peek() !== from) return;
  batch(() => {
    track.value = loaded.points;
    live.value = { ...live.peek(), path: [] };
  });
}

export function look(seq: number | null): void {
  const id = live.peek().mission.missionId;
  const from = source.peek();
  if (seq !== null && cursor.peek() === null && id && from) void loadTrack(from, id);
  cursor.value = seq;
}
