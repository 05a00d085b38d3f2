// A mission is a fold of its events: its search, every emitter and every craft of it, side by side.
// Pure: (state, recorded) -> state, the same live, in review and in tests.
import type {
  AlertLevel,
  AlertTopic,
  CheckFact,
  Holder,
  MissionEnded,
  MissionEvent,
  MissionPhase,
  MissionSpec,
  Place,
  Reason,
  Recorded,
  SearchArea,
} from "../wire";
import { type CraftState, emptyCraft, foldCraft } from "./craft";
import { type At, type EmitterState, emptyEmitter, foldEmitter, type MutedSources, muteEmitter, sourceKey } from "./emitter";
import { namingEmitter } from "./emitterName";
import { inOrder } from "./importance";

/** craftId, emitterId: whom it concerns; null of both: the whole mission. */
export interface Alert {
  id: string;
  topic: AlertTopic;
  level: AlertLevel;
  reason: Reason;
  craftId: string | null;
  emitterId: string | null;
  raisedAt: string;
  acknowledgedBy: string | null;
  cleared: boolean;
}

/** Who steers the search, where there are accounts. fence: counts the changes of hands; an order carries it. */
export interface Control {
  holder: Holder | null;
  fence: number;
  asked: Holder | null;
  askedAt: string | null;
}

export const nobodyControls: Control = { holder: null, fence: 0, asked: null, askedAt: null };

export interface MissionState {
  missionId: string | null;
  lastSeq: number;
  spec: MissionSpec | null;
  /** Since this event the specification stands as it is. */
  specSeq: number;
  checks: CheckFact[] | null;
  preflightPassed: boolean | null;
  home: Place | null;
  startedAt: string | null;
  /** The highest so far, of all craft and bearings. */
  placeNumber: number;
  /** Sources whose bearings count for no emitter. */
  muted: MutedSources;
  /** By id, in the specification's order. */
  emitters: ReadonlyMap<string, EmitterState>;
  /** By id, in the order in which they were started. */
  crafts: ReadonlyMap<string, CraftState>;
  alerts: readonly Alert[];
  control: Control;
  ended: At<MissionEnded> | null;
}

export const emptyMission: MissionState = {
  missionId: null,
  lastSeq: 0,
  spec: null,
  specSeq: 0,
  checks: null,
  preflightPassed: null,
  home: null,
  startedAt: null,
  placeNumber: 0,
  muted: new Set(),
  emitters: new Map(),
  crafts: new Map(),
  alerts: [],
  control: nobodyControls,
  ended: null,
};

/** The same mission elsewhere. */
const searching = (spec: MissionSpec, { area, priors, ...flying }: SearchArea): MissionSpec => ({
  ...spec,
  area,
  emitters: spec.emitters.map((emitter) => ({ ...emitter, prior: priors[emitter.emitter_id] ?? emitter.prior })),
  flight: { ...spec.flight, ...flying },
});

/** An emitter that is no longer looked for takes its bearings with it. */
const withSpec = (state: MissionState, spec: MissionSpec, seq: number): MissionState => ({
  ...state,
  spec,
  specSeq: seq,
  emitters: new Map(spec.emitters.map(({ emitter_id: id }) => [id, state.emitters.get(id) ?? emptyEmitter(id, state.muted)])),
});

const changeAlert = (state: MissionState, id: string, changes: Partial<Alert>): MissionState => ({
  ...state,
  alerts: state.alerts.map((alert) => (alert.id === id ? { ...alert, ...changes } : alert)),
});

/** What the search itself, apart from its emitters and craft, makes of an event. */
function foldSearch(state: MissionState, { event, at_utc: at, seq }: Recorded): MissionState {
  switch (event.kind) {
    case "mission_drafted":
    case "mission_edited":
      return { ...withSpec(state, event.spec, seq), checks: null, preflightPassed: null };
    case "area_changed":
      return state.spec ? withSpec(state, searching(state.spec, event.search), seq) : state;
    case "priorities_changed":
      return state.spec ? { ...state, spec: { ...state.spec, emitters: inOrder(state.spec.emitters, event.priorities) } } : state;
    case "mission_labelled":
      return state.spec ? { ...state, spec: { ...state.spec, name: event.name } } : state;
    case "preflight_checked":
      return { ...state, checks: event.checks, preflightPassed: event.passed };
    case "mission_started":
      return { ...state, home: state.home ?? event.home, startedAt: state.startedAt ?? at };
    case "plan_chosen":
    case "bearing_measured":
      return { ...state, placeNumber: Math.max(state.placeNumber, event.place_number) };
    case "alert_raised": {
      const { alert_id: id, topic, level, craft_id: craftId, emitter_id: emitterId } = event;
      const reason = namingEmitter(state.spec?.emitters ?? [], event.reason);
      const alert: Alert = { id, topic, level, reason, craftId, emitterId, raisedAt: at, acknowledgedBy: null, cleared: false };
      return { ...state, alerts: [...state.alerts.filter((a) => a.id !== id), alert] };
    }
    case "alert_acknowledged":
      return changeAlert(state, event.alert_id, { acknowledgedBy: event.by });
    case "alert_cleared":
      return changeAlert(state, event.alert_id, { cleared: true });
    case "control_changed":
      return { ...state, control: { ...nobodyControls, holder: event.holder, fence: event.fence } };
    case "control_asked":
      return { ...state, control: { ...state.control, asked: event.holder, askedAt: at } };
    case "control_kept":
      return { ...state, control: { ...state.control, asked: null, askedAt: null } };
    case "mission_ended":
      return { ...state, ended: { fact: event, seq, at } };
    default:
      return state;
  }
}

/** Alerts and choices name an emitter only to say what they are about. */
const emitterOf = (event: MissionEvent): string | null => {
  switch (event.kind) {
    case "sweep_rejected":
    case "heard_on_the_way":
    case "bearing_measured":
    case "bearing_excluded":
    case "bearing_included":
    case "belief_updated":
    case "truth_noted":
      return event.emitter_id;
    default:
      return null;
  }
};

function foldEmitters(state: MissionState, { event, at_utc: at, seq }: Recorded): MissionState {
  if (event.kind === "source_mute_changed") {
    const muted = new Set(state.muted);
    if (event.muted) muted.add(sourceKey(event.source));
    else muted.delete(sourceKey(event.source));
    return { ...state, muted, emitters: new Map([...state.emitters].map(([id, one]) => [id, muteEmitter(one, muted)])) };
  }
  const id = emitterOf(event);
  if (id === null) return state;
  const emitter = state.emitters.get(id) ?? emptyEmitter(id, state.muted);
  return { ...state, emitters: new Map(state.emitters).set(id, foldEmitter(emitter, event, seq, at)) };
}

function foldCrafts(state: MissionState, { event, at_utc: at, seq }: Recorded): MissionState {
  const owner = "craft_id" in event ? event.craft_id : null;
  const crafts = new Map(state.crafts);
  if (owner !== null && !crafts.has(owner)) crafts.set(owner, emptyCraft(owner, state.spec?.flight.automatic ?? true));
  for (const [id, craft] of crafts) if (owner === null || owner === id) crafts.set(id, foldCraft(craft, event, seq, at));
  return { ...state, crafts };
}

/** Events come in order; one that was already folded (after a reconnect) changes nothing. */
export function foldMission(state: MissionState, recorded: Recorded): MissionState {
  if (recorded.seq <= state.lastSeq) return state;
  const folded = foldCrafts(foldEmitters(foldSearch(state, recorded), recorded), recorded);
  return { ...folded, missionId: recorded.mission_id, lastSeq: recorded.seq };
}

export function missionAt(events: readonly Recorded[], seq: number): MissionState {
  let state = emptyMission;
  for (const recorded of events) {
    if (recorded.seq > seq) break;
    state = foldMission(state, recorded);
  }
  return state;
}

const STAGES: readonly MissionPhase[] = ["draft", "ready", "searching", "done", "aborted", "failed"];

/** The word says what a craft does in the air. */
export const inFlight = (phase: MissionPhase): boolean => phase !== "ground" && !STAGES.includes(phase);
export const isOver = (phase: MissionPhase): boolean => phase === "done" || phase === "aborted" || phase === "failed";

/** The search is over: no further place is flown to. */
export const isHomeward = ({ ended, phase }: Pick<MissionState, "ended"> & { phase: MissionPhase }): boolean =>
  ended !== null || phase === "returning" || phase === "landing";
