// Events for tests: those of the recorded example, with what tests count on spelled out.
import text from "../../public/example.json?raw";
import type {
  Authority,
  BearingSource,
  CraftStatus,
  EventKind,
  EventOf,
  LiveMessage,
  MissionEvent,
  MissionPhase,
  MissionSpec,
  Phase,
  Reason,
  Recorded,
  StatusMessage,
  TelemetryMessage,
} from ".";

/** What was said in the recorded flight (see sources/example.ts). */
export const { said } = JSON.parse(text) as { said: (readonly [number, LiveMessage | string])[] };

/** The journal of that flight. */
export const flown: readonly Recorded[] = said.flatMap(([, message]) =>
  typeof message === "object" && message.type === "event" ? [message.recorded] : [],
);

const first = <K extends EventKind>(kind: K): EventOf<K> => flown.find(({ event }) => event.kind === kind)!.event as EventOf<K>;

const ofType = (type: LiveMessage["type"]) => said.map(([, message]) => message).find((m) => typeof m === "object" && m.type === type);

export const someBearing = (changes: Partial<EventOf<"bearing_measured">> = {}): EventOf<"bearing_measured"> => ({
  ...first("bearing_measured"),
  bearing_id: "b1",
  sweep_id: "s1",
  bearing_deg: 45,
  peaks: [],
  ...changes,
});

export const somePlan = (changes: Partial<EventOf<"plan_chosen">> = {}): EventOf<"plan_chosen"> => ({
  ...first("plan_chosen"),
  place: { lat: 50.7, lon: 7.1 },
  expected_time_s: 120,
  time_90_s: 200,
  candidates: [
    { lat: 50.701, lon: 7.101, value_s: 140, std_error_s: 2, rollouts: 20, dropped_in_round: 1 },
    { lat: 50.7, lon: 7.1, value_s: 120, std_error_s: 1, rollouts: 80, dropped_in_round: null },
    { lat: 50.702, lon: 7.1, value_s: 125, std_error_s: 1, rollouts: 40, dropped_in_round: 2 },
  ],
  ...changes,
});

export const someBelief = (changes: Partial<EventOf<"belief_updated">> = {}): EventOf<"belief_updated"> => ({
  ...first("belief_updated"),
  ...changes,
});

/** An authority before anything was commanded or heard. */
export const NOBODY: Authority = {
  who: "nobody",
  taken_by: null,
  taken_at_s: null,
  mode: null,
  given_back: false,
  perhaps_failsafe: false,
  failsafe_landed: false,
  cause: null,
  named_at_s: null,
  under_way: [],
  undone: false,
  commanded: [],
  tolerated: [],
  shown_before: null,
  heard: null,
  kind: null,
  armed: false,
  restarted: false,
};

/** In the air, every value new. */
export const someTelemetry = (changes: Partial<TelemetryMessage> = {}): TelemetryMessage => ({
  ...(ofType("telemetry") as TelemetryMessage),
  lat: 50.7,
  lon: 7.1,
  in_air: true,
  position_age_s: 0,
  battery_age_s: 0,
  ...changes,
});

/** Of the craft of the recorded flight; it flies for no mission. */
export const someCraftStatus = (changes: Partial<CraftStatus> = {}): CraftStatus => ({
  ...(ofType("status") as StatusMessage).crafts[0]!,
  mission_id: null,
  phase: "ground",
  ...changes,
});

/** No mission flies. */
export const someStatus = (changes: Partial<StatusMessage> = {}): StatusMessage => ({
  ...(ofType("status") as StatusMessage),
  mission_id: null,
  phase: null,
  crafts: [someCraftStatus()],
  ...changes,
});

/** A craft flies for this mission. */
export const servedStatus = (missionId: string, does: Phase): StatusMessage =>
  someStatus({ mission_id: missionId, phase: does, crafts: [someCraftStatus({ mission_id: missionId, phase: does })] });

/** As the server answers it: the stored one is older than its limits above the ground. */
export const someSpec = (): MissionSpec => {
  const { flight, ...rest } = first("mission_drafted").spec;
  return { ...rest, flight: Object.assign({ minimum_clearance_m: 20, maximum_above_ground_m: 120 }, flight) };
};

export const CRAFT = first("mission_started").craft_id;
export const EMITTER = first("belief_updated").emitter_id;

export const someReason: Reason = { code: "proceeds", after: "plan" };

export const phase = (after: Phase, reason: Reason = someReason): EventOf<"phase_changed"> => ({
  ...first("phase_changed"),
  after,
  reason,
});

export const started = (changes: Partial<EventOf<"mission_started">> = {}): EventOf<"mission_started"> => ({
  ...first("mission_started"),
  ...changes,
});

export const ended = (outcome: EventOf<"mission_ended">["outcome"], reason: Reason = someReason): EventOf<"mission_ended"> => ({
  kind: "mission_ended",
  outcome,
  reason,
  mission_time_s: 1,
});

/** Two stretches of way northward, of which something was heard. */
export const someLeg = (changes: Partial<EventOf<"heard_on_the_way">> = {}): EventOf<"heard_on_the_way"> => ({
  kind: "heard_on_the_way",
  emitter_id: EMITTER,
  source: { kind: "craft", craft_id: CRAFT },
  leg_id: "leg",
  place_number: 2,
  counted: 120,
  left_out: [{ code: "readings_left_out", why: "beside_a_turn", readings: 30 }],
  nose: [],
  stretches: [
    { begin: { lat: 50, lon: 7 }, end: { lat: 50.0002, lon: 7 }, turned_deg: 70 },
    { begin: { lat: 50.0002, lon: 7 }, end: { lat: 50.0004, lon: 7 }, turned_deg: 50.4 },
  ],
  origin: { lat: 50, lon: 7 },
  readings: "packed",
  gain_db: [0],
  sigma_deg: 7,
  ...changes,
});

export const excluded = (bearingId: string): EventOf<"bearing_excluded"> => ({
  kind: "bearing_excluded",
  emitter_id: EMITTER,
  bearing_id: bearingId,
  by: "operator",
  reason: "",
  heard: true,
  on_the_way: false,
});

export const included = (bearingId: string): EventOf<"bearing_included"> => ({
  kind: "bearing_included",
  emitter_id: EMITTER,
  bearing_id: bearingId,
  heard: true,
  by: "operator",
});

export const person = (name: string): BearingSource => ({ kind: "person", name });

export const mute = (source: BearingSource, muted: boolean): EventOf<"source_mute_changed"> => ({
  kind: "source_mute_changed",
  source,
  muted,
  by: "operator",
  reason: "",
});

/** The events after its draft that bring a mission into a phase. */
export function leadingTo(wanted: MissionPhase): MissionEvent[] {
  switch (wanted) {
    case "draft":
      return [];
    case "ready":
      return [{ kind: "preflight_checked", passed: true, checks: [] }];
    case "searching":
      return [started()];
    case "done":
      return [started(), phase("returning"), phase("ground"), ended("localized")];
    case "aborted":
      return [started(), phase("returning"), ended("aborted")];
    case "failed":
      return [started(), phase("ground"), ended("failed")];
    default:
      return [started(), phase(wanted)];
  }
}

/** Numbers events from 1, one second apart. */
export function record(...events: MissionEvent[]): Recorded[] {
  return events.map((event, i) => ({
    seq: i + 1,
    mission_id: "m",
    at_utc: new Date(Date.UTC(2026, 0, 1, 12, 0, i)).toISOString(),
    event,
  }));
}
