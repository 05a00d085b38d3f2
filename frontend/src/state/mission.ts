// A mission is a fold of its events. Pure: (state, recorded) -> state, the same live, in review and in tests.
import type {
  AlertLevel,
  BearingMeasured,
  BeliefUpdated,
  CheckFact,
  LinkName,
  MissionEnded,
  MissionSpec,
  Phase,
  PlanChosen,
  Place,
  Recorded,
  SearchArea,
  SweepRejected,
  WhatIf,
} from "../wire";

export interface At<T> {
  fact: T;
  seq: number;
  at: string;
}

export interface Bearing extends At<BearingMeasured> {
  excluded: boolean;
}

export interface Alert {
  id: string;
  level: AlertLevel;
  text: string;
  remedy: string;
  raisedAt: string;
  acknowledgedBy: string | null;
  cleared: boolean;
}

export interface Lost {
  since: string;
  detail: string;
}

export interface BeliefPoint {
  seq: number;
  at: string;
  bearings: number;
  expectedRmse: number | null;
}

export interface MissionState {
  missionId: string | null;
  lastSeq: number;
  spec: MissionSpec | null;
  /** Since this event the specification stands as it is. */
  specSeq: number;
  phase: Phase;
  phaseReason: string;
  phaseSince: string | null;
  checks: CheckFact[] | null;
  preflightPassed: boolean | null;
  home: Place | null;
  startedAt: string | null;
  plan: At<PlanChosen> | null;
  /** How long the search stood still since the plan; without the phase that lasts. */
  pausedMs: number;
  /** The place on the way or being measured, by its number; null before the first plan. */
  placeNumber: number | null;
  attempt: number;
  bearings: readonly Bearing[];
  rejected: readonly At<SweepRejected>[];
  belief: At<BeliefUpdated> | null;
  beliefs: readonly BeliefPoint[];
  automatic: boolean;
  pilot: { mode: string; detail: string; since: string } | null;
  alerts: readonly Alert[];
  lost: Readonly<Partial<Record<LinkName, Lost>>>;
  ended: At<MissionEnded> | null;
}

export const emptyMission: MissionState = {
  missionId: null,
  lastSeq: 0,
  spec: null,
  specSeq: 0,
  phase: "draft",
  phaseReason: "",
  phaseSince: null,
  checks: null,
  preflightPassed: null,
  home: null,
  startedAt: null,
  plan: null,
  pausedMs: 0,
  placeNumber: null,
  attempt: 1,
  bearings: [],
  rejected: [],
  belief: null,
  beliefs: [],
  automatic: true,
  pilot: null,
  alerts: [],
  lost: {},
  ended: null,
};

/** Until now since the plan: the expected time runs only while the search goes on. */
export function pausedMs({ plan, phase, phaseSince, pausedMs: before }: MissionState, nowMs: number): number {
  const still = phase === "hold" || phase === "manual" || phase === "waiting";
  if (!plan || !phaseSince || !still) return before;
  return before + Math.max(0, nowMs - Math.max(Date.parse(phaseSince), Date.parse(plan.at)));
}

/** The same mission elsewhere. */
const searching = (spec: MissionSpec, { area, prior, ...flying }: SearchArea): MissionSpec => ({
  ...spec,
  area,
  prior,
  flight: { ...spec.flight, ...flying },
});

function foldEvent(state: MissionState, { event, at_utc: at, seq }: Recorded): MissionState {
  switch (event.kind) {
    case "mission_drafted":
    case "mission_edited":
      return {
        ...state,
        spec: event.spec,
        specSeq: seq,
        automatic: event.spec.flight.automatic,
        checks: null,
        preflightPassed: null,
      };
    case "area_changed":
      return { ...state, spec: state.spec && searching(state.spec, event.search), specSeq: seq, plan: null };
    case "preflight_checked":
      return { ...state, checks: event.checks, preflightPassed: event.passed };
    case "mission_started":
      return { ...state, home: event.home, startedAt: at };
    case "phase_changed":
      return { ...state, pausedMs: pausedMs(state, Date.parse(at)), phase: event.after, phaseReason: event.reason, phaseSince: at };
    case "plan_chosen":
      return { ...state, plan: { fact: event, seq, at }, pausedMs: 0, placeNumber: event.place_number, attempt: 1 };
    case "plan_vetoed":
      return { ...state, plan: null };
    case "flight_started":
      return { ...state, placeNumber: event.place_number };
    case "sweep_started":
      return { ...state, placeNumber: event.place_number, attempt: event.attempt };
    case "sweep_rejected":
      return { ...state, rejected: [...state.rejected, { fact: event, seq, at }] };
    case "bearing_measured":
      return { ...state, bearings: [...state.bearings, { fact: event, seq, at, excluded: false }] };
    case "bearing_excluded":
      return {
        ...state,
        bearings: state.bearings.map((b) =>
          b.fact.bearing_id === event.bearing_id ? { ...b, excluded: true } : b,
        ),
      };
    case "belief_updated":
      return {
        ...state,
        belief: { fact: event, seq, at },
        beliefs: [
          ...state.beliefs,
          { seq, at, bearings: event.bearings, expectedRmse: event.estimate?.expected_rmse_m ?? null },
        ],
      };
    case "automatic_changed":
      return { ...state, automatic: event.automatic };
    case "control_taken":
      return { ...state, pilot: { mode: event.mode, detail: event.detail, since: at } };
    case "control_released":
      return { ...state, pilot: null };
    case "link_lost":
      return { ...state, lost: { ...state.lost, [event.link]: { since: at, detail: event.detail } } };
    case "link_restored": {
      const { [event.link]: _restored, ...lost } = state.lost;
      return { ...state, lost };
    }
    case "alert_raised": {
      const alert: Alert = {
        id: event.alert_id,
        level: event.level,
        text: event.text,
        remedy: event.remedy,
        raisedAt: at,
        acknowledgedBy: null,
        cleared: false,
      };
      return { ...state, alerts: [...state.alerts.filter((a) => a.id !== alert.id), alert] };
    }
    case "alert_acknowledged":
      return {
        ...state,
        alerts: state.alerts.map((a) => (a.id === event.alert_id ? { ...a, acknowledgedBy: event.by } : a)),
      };
    case "alert_cleared":
      return {
        ...state,
        alerts: state.alerts.map((a) => (a.id === event.alert_id ? { ...a, cleared: true } : a)),
      };
    case "mission_ended":
      return { ...state, ended: { fact: event, seq, at } };
    case "antenna_checked":
    case "recording_imported":
    case "took_off":
    case "place_reached":
    case "hold_ordered":
    case "resume_ordered":
    case "return_ordered":
    case "abort_ordered":
    case "command_accepted":
    case "command_refused":
    case "safety_vetoed":
    case "server_restarted":
      return state;
  }
}

/** Events come in order; one that was already folded (after a reconnect) changes nothing. */
export function foldMission(state: MissionState, recorded: Recorded): MissionState {
  if (recorded.seq <= state.lastSeq) return state;
  return { ...foldEvent(state, recorded), missionId: recorded.mission_id, lastSeq: recorded.seq };
}

export function missionAt(events: readonly Recorded[], seq: number): MissionState {
  let state = emptyMission;
  for (const recorded of events) {
    if (recorded.seq > seq) break;
    state = foldMission(state, recorded);
  }
  return state;
}

/** The same mission with what its sweeps would have told, another belief and another choice at its last moment. */
export function suppose(state: MissionState, { belief, plan, sweeps }: Pick<WhatIf, "belief" | "plan" | "sweeps">): MissionState {
  const [seq, at] = [state.lastSeq, state.belief?.at ?? state.startedAt ?? ""];
  const flown = new Map([...state.bearings, ...state.rejected].map((s) => [s.fact.sweep_id, s]));
  const of = (id: string) => ({ seq: flown.get(id)?.seq ?? seq, at: flown.get(id)?.at ?? at });
  const told = sweeps.flatMap((fact) => (fact.kind === "bearing_measured" ? [{ ...of(fact.sweep_id), fact, excluded: false }] : []));
  return {
    ...state,
    bearings: [...told, ...state.bearings.filter((b) => b.excluded)],
    rejected: sweeps.flatMap((fact) => (fact.kind === "sweep_rejected" ? [{ ...of(fact.sweep_id), fact }] : [])),
    belief: { fact: belief, seq, at },
    plan: plan && { fact: plan, seq, at },
  };
}

const IN_FLIGHT: readonly Phase[] = [
  "taking_off",
  "planning",
  "waiting",
  "flying",
  "measuring",
  "hold",
  "manual",
  "returning",
  "landing",
];

/** The search is over: no further place is flown to. */
export const isHomeward = ({ ended, phase }: MissionState): boolean => ended !== null || phase === "returning" || phase === "landing";

export const inFlight = (phase: Phase): boolean => IN_FLIGHT.includes(phase);
export const isOver = (phase: Phase): boolean => phase === "done" || phase === "aborted" || phase === "failed";
