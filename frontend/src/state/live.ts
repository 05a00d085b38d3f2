// Everything the page knows, folded from the source's messages. Pure: time comes in as an argument.
import type { SourceMessage } from "../sources/source";
import type { Hello, Recorded, StatusMessage, SweepProgress, TelemetryMessage } from "../wire";
import type { BeliefFrame, LonLat } from "../wire/beliefFrame";
import { distanceM } from "./geometry";
import { emptyMission, foldMission, type MissionState } from "./mission";

/** A value and when this page received it (ms of the page's monotonic clock), so that it can visibly age. */
export interface Received<T> {
  value: T;
  atMs: number;
}

export interface LiveState {
  /** When this source began to speak. What is older was told by the one before. */
  beganMs: number;
  hello: Hello | null;
  link: { state: "connecting" | "open" | "closed"; attempt: number; sinceMs: number };
  lastMessageMs: number | null;
  events: readonly Recorded[];
  mission: MissionState;
  /** By craft, as are the paths. */
  telemetry: ReadonlyMap<string, Received<TelemetryMessage>>;
  status: Received<StatusMessage> | null;
  /** The running turn by craft, and in it by emitter. */
  sweeps: ReadonlyMap<string, ReadonlyMap<string, Received<SweepProgress>>>;
  paths: ReadonlyMap<string, readonly LonLat[]>;
  /** The newest frame of each emitter. */
  beliefs: ReadonlyMap<string, BeliefFrame>;
  /** Messages of other kinds that could not be read. */
  unreadable: number;
}

export const emptyLive: LiveState = {
  beganMs: 0,
  hello: null,
  link: { state: "connecting", attempt: 0, sinceMs: 0 },
  lastMessageMs: null,
  events: [],
  mission: emptyMission,
  telemetry: new Map(),
  status: null,
  sweeps: new Map(),
  paths: new Map(),
  beliefs: new Map(),
  unreadable: 0,
};

/** The turn under way, and what was heard of this emitter in it; null: none. Other emitters' samples tell how far it is. */
export function turnOf(heard: ReadonlyMap<string, Received<SweepProgress>> | undefined, emitterId: string): SweepProgress | null {
  const newest = [...(heard?.values() ?? [])].reduce<Received<SweepProgress> | null>((a, b) => (a && a.atMs > b.atMs ? a : b), null);
  if (!newest) return null;
  const own = heard?.get(emitterId)?.value ?? { ...newest.value, emitter_id: emitterId, heading_deg: [], power_db: [] };
  return { ...own, turned_deg: newest.value.turned_deg };
}

/** About what the vehicle covers on the map; each step draws the whole map again. */
const PATH_STEP_M = 5.0;

const withEntry = <T>(map: ReadonlyMap<string, T>, id: string, value: T): ReadonlyMap<string, T> => new Map(map).set(id, value);

const NO_PATH: readonly LonLat[] = [];

/** Of the mission shown: the vehicle may be on the way home from another one. */
function extendPaths({ paths, mission }: LiveState, { craft_id: id, ...telemetry }: TelemetryMessage): LiveState["paths"] {
  const flies = mission.crafts.get(id)?.engaged ?? false;
  if (telemetry.lon === null || telemetry.lat === null || telemetry.in_air === false || !flies) return paths;
  const path = paths.get(id) ?? NO_PATH;
  const here: LonLat = [telemetry.lon, telemetry.lat];
  const last = path.at(-1);
  return last && distanceM(last, here) < PATH_STEP_M ? paths : withEntry(paths, id, [...path, here]);
}

/** The craft whose running sweep is over with this event. */
function swept({ event }: Recorded): string | null {
  if (event.kind === "sweep_started") return event.craft_id;
  if (event.kind !== "bearing_measured" && event.kind !== "sweep_rejected") return null;
  return event.source.kind === "craft" ? event.source.craft_id : null;
}

function foldRecorded(state: LiveState, recorded: Recorded): LiveState {
  const mission = foldMission(state.mission, recorded);
  if (mission === state.mission) return state;
  const over = swept(recorded);
  const sweeps = over !== null && state.sweeps.has(over) ? new Map([...state.sweeps].filter(([id]) => id !== over)) : state.sweeps;
  return { ...state, mission, events: [...state.events, recorded], sweeps };
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
      return {
        ...heard,
        telemetry: withEntry(heard.telemetry, message.craft_id, { value: message, atMs: nowMs }),
        paths: extendPaths(heard, message),
      };
    case "sweep_progress": {
      const { craft_id: craft, emitter_id: emitter } = message;
      const turn = withEntry(heard.sweeps.get(craft) ?? new Map(), emitter, { value: message, atMs: nowMs });
      return { ...heard, sweeps: withEntry(heard.sweeps, craft, turn) };
    }
    case "status":
      return { ...heard, status: { value: message, atMs: nowMs } };
    case "belief":
      return { ...heard, beliefs: withEntry(heard.beliefs, message.frame.emitterId, message.frame) };
    case "unreadable":
      return { ...heard, unreadable: heard.unreadable + 1 };
    case "gone":
      return heard;
  }
}
