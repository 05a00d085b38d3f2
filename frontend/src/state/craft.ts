// What one craft does for a mission: a fold of the mission's events.
import type { Authority, LinkName, MissionEvent, Phase, PlanChosen, Reason } from "../wire";
import type { At } from "./emitter";

export interface Lost {
  since: string;
  reason: Reason;
}

/** What is shown of who flies. */
export type WhoFlies = Pick<Authority, "who" | "taken_by" | "mode" | "given_back" | "perhaps_failsafe" | "failsafe_landed" | "undone">;

export interface CraftState {
  craftId: string;
  /** It was started for this mission and is not down since. */
  engaged: boolean;
  phase: Phase;
  phaseReason: Reason | null;
  phaseSince: string | null;
  /** The place chosen last; it stays while it is measured at, until the next one, a veto or another area. */
  plan: At<PlanChosen> | null;
  /** How long the search stood still since the plan; without the phase that lasts. */
  pausedMs: number;
  /** The place on the way or being measured, by its number; null before the first plan. */
  placeNumber: number | null;
  attempt: number;
  automatic: boolean;
  /** It returns then because its battery runs low, unless somebody stops that. */
  returnsAt: string | null;
  authority: WhoFlies;
  authoritySince: string | null;
  lost: Readonly<Partial<Record<LinkName, Lost>>>;
}

export const NOBODY: WhoFlies = {
  who: "nobody",
  taken_by: null,
  mode: null,
  given_back: false,
  perhaps_failsafe: false,
  failsafe_landed: false,
  undone: false,
};

export const emptyCraft = (craftId: string, automatic: boolean): CraftState => ({
  craftId,
  engaged: false,
  phase: "ground",
  phaseReason: null,
  phaseSince: null,
  plan: null,
  pausedMs: 0,
  placeNumber: null,
  attempt: 1,
  automatic,
  returnsAt: null,
  authority: NOBODY,
  authoritySince: null,
  lost: {},
});

/** A pilot has control, and no operator has taken it back since; after their landing, too. */
export const pilotHas = ({ taken_by, who, failsafe_landed }: WhoFlies): boolean =>
  taken_by !== null && who !== "failsafe" && !failsafe_landed;

/** Until now since the plan: the expected time runs only while the search goes on. */
export function pausedMs(craft: Pick<CraftState, "plan" | "phaseSince" | "pausedMs"> & { phase: string }, nowMs: number): number {
  const { plan, phase, phaseSince, pausedMs: before } = craft;
  const still = phase === "hold" || phase === "manual" || phase === "waiting";
  if (!plan || !phaseSince || !still) return before;
  return before + Math.max(0, nowMs - Math.max(Date.parse(phaseSince), Date.parse(plan.at)));
}

/** `event` is one that speaks of this craft, or of every one. */
export function foldCraft(state: CraftState, event: MissionEvent, seq: number, at: string): CraftState {
  switch (event.kind) {
    case "mission_drafted":
    case "mission_edited":
      return { ...state, automatic: event.spec.flight.automatic };
    case "area_changed":
      return { ...state, plan: null };
    case "mission_started":
      return { ...state, engaged: true };
    case "phase_changed":
      return {
        ...state,
        pausedMs: pausedMs(state, Date.parse(at)),
        engaged: event.after !== "ground",
        phase: event.after,
        phaseReason: event.reason,
        phaseSince: at,
        returnsAt: null,
      };
    case "hold_ordered":
    case "resume_ordered":
      // a failsafe that flew in hold until then changed no phase, and neither does the order
      return event.by === null || state.phase !== "hold"
        ? state
        : { ...state, phaseReason: { code: "ordered", order: event.kind === "hold_ordered" ? "hold" : "resume", by: event.by } };
    case "battery_countdown_started":
      return { ...state, returnsAt: new Date(Date.parse(at) + event.seconds * 1000).toISOString() };
    case "battery_countdown_stopped":
      return { ...state, returnsAt: null };
    case "plan_chosen":
      return { ...state, plan: { fact: event, seq, at }, pausedMs: 0, placeNumber: event.place_number, attempt: 1 };
    case "plan_vetoed":
      return { ...state, plan: null };
    case "flight_started":
      return { ...state, placeNumber: event.place_number };
    case "sweep_started":
      return { ...state, placeNumber: event.place_number, attempt: event.attempt };
    case "automatic_changed":
      return { ...state, automatic: event.automatic };
    case "authority_changed":
      return { ...state, authority: event.authority, authoritySince: at };
    case "link_lost":
      return { ...state, lost: { ...state.lost, [event.link]: { since: at, reason: event.reason } } };
    case "link_restored": {
      const { [event.link]: _restored, ...lost } = state.lost;
      return { ...state, lost };
    }
    case "server_restarted":
      return { ...state, lost: {}, returnsAt: null };
    default:
      return state;
  }
}
