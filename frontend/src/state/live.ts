// Everything the page knows, folded from the source's messages. Pure: time comes in as an argument.
import type { SourceMessage } from "../sources/source";
import type { Hello, Recorded, StatusMessage, SweepProgress, TelemetryMessage } from "../wire";
import type { BeliefFrame, LonLat } from "../wire/beliefFrame";
import { distanceM } from "./geometry";
import { emptyMission, foldMission, inFlight, type MissionState } from "./mission";

/** A value and when this page received it (ms of the page's monotonic clock), so that it can visibly age. */
export interface Received<T> {
  value: T;
  atMs: number;
}

export interface LiveState {
  hello: Hello | null;
  link: { state: "connecting" | "open" | "closed"; attempt: number; sinceMs: number };
  lastMessageMs: number | null;
  events: readonly Recorded[];
  mission: MissionState;
  telemetry: Received<TelemetryMessage> | null;
  status: Received<StatusMessage> | null;
  sweep: Received<SweepProgress> | null;
  path: readonly LonLat[];
  belief: BeliefFrame | null;
  /** The event that the frame belongs to; null when another one came in between. */
  beliefSeq: number | null;
  /** Messages of other kinds that could not be read. */
  unreadable: number;
}

export const emptyLive: LiveState = {
  hello: null,
  link: { state: "connecting", attempt: 0, sinceMs: 0 },
  lastMessageMs: null,
  events: [],
  mission: emptyMission,
  telemetry: null,
  status: null,
  sweep: null,
  path: [],
  belief: null,
  beliefSeq: null,
  unreadable: 0,
};

/** About what the vehicle covers on the map; each step draws the whole map again. */
const PATH_STEP_M = 5.0;

/** Of the mission shown: the vehicle may be on the way home from another one. */
function extendPath({ path, mission }: LiveState, telemetry: TelemetryMessage): readonly LonLat[] {
  if (telemetry.lon === null || telemetry.lat === null || telemetry.in_air === false || !inFlight(mission.phase)) return path;
  const here: LonLat = [telemetry.lon, telemetry.lat];
  const last = path.at(-1);
  return last && distanceM(last, here) < PATH_STEP_M ? path : [...path, here];
}

function foldRecorded(state: LiveState, recorded: Recorded): LiveState {
  const mission = foldMission(state.mission, recorded);
  if (mission === state.mission) return state;
  const kind = recorded.event.kind;
  const sweepOver = kind === "bearing_measured" || kind === "sweep_rejected" || kind === "sweep_started";
  return { ...state, mission, events: [...state.events, recorded], sweep: sweepOver ? null : state.sweep };
}

export function reduceLive(state: LiveState, message: SourceMessage, nowMs: number): LiveState {
  if (message.type === "link") {
    return { ...state, link: { state: message.state, attempt: message.attempt, sinceMs: nowMs } };
  }
  const heard = { ...state, lastMessageMs: nowMs };
  switch (message.type) {
    case "hello":
      return { ...heard, hello: message };
    case "event":
      return foldRecorded(heard, message.recorded);
    case "telemetry":
      return { ...heard, telemetry: { value: message, atMs: nowMs }, path: extendPath(heard, message) };
    case "sweep_progress":
      return { ...heard, sweep: { value: message, atMs: nowMs } };
    case "status":
      return { ...heard, status: { value: message, atMs: nowMs } };
    case "belief": {
      const told = state.mission.belief;
      return { ...heard, belief: message.frame, beliefSeq: told?.fact.bearings === message.frame.bearings ? told.seq : null };
    }
    case "unreadable":
      return { ...heard, unreadable: heard.unreadable + 1 };
  }
}
