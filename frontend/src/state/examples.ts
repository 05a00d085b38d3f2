// Recorded events for tests, with only what a test cares about spelled out.
import type { EventOf, MissionEvent, Recorded } from "../wire";
import { exampleSpec } from "../sources/fixture";

const bearing: EventOf<"bearing_measured"> = {
  kind: "bearing_measured",
  bearing_id: "b1",
  sweep_id: "s1",
  place_number: 1,
  place: { lat: 50.7, lon: 7.1 },
  altitude_amsl_m: 100,
  bearing_deg: 45,
  sigma_deg: 4,
  quality: 0.9,
  peaks: [],
  snr_db: 20,
  drift_m: 0.3,
  binned_db: Array.from({ length: 180 }, (_, i) => -60 - Math.abs(i - 22) / 4),
  fitted_db: Array.from({ length: 180 }, () => -60),
  measurement_time_s: 30,
  heading_sigma_deg: 4,
};

const plan: EventOf<"plan_chosen"> = {
  kind: "plan_chosen",
  place_number: 1,
  place: { lat: 50.7, lon: 7.1 },
  source: "planner",
  reason: "crosses well",
  expected_time_s: 120,
  time_90_s: 200,
  candidates: [
    { lat: 50.701, lon: 7.101, value_s: 140, std_error_s: 2, rollouts: 20, dropped_in_round: 1 },
    { lat: 50.7, lon: 7.1, value_s: 120, std_error_s: 1, rollouts: 80, dropped_in_round: null },
    { lat: 50.702, lon: 7.1, value_s: 125, std_error_s: 1, rollouts: 40, dropped_in_round: 2 },
  ],
  rollouts: 140,
  plan_ms: 12,
  by: null,
};

export const someBearing = (changes: Partial<EventOf<"bearing_measured">> = {}) => ({ ...bearing, ...changes });
export const somePlan = (changes: Partial<EventOf<"plan_chosen">> = {}) => ({ ...plan, ...changes });

export const someSpec = () => exampleSpec([[7.1, 50.7], [7.104, 50.7], [7.104, 50.702], [7.1, 50.702], [7.1, 50.7]]); // prettier-ignore

export const phase = (after: EventOf<"phase_changed">["after"], reason = ""): MissionEvent => ({
  kind: "phase_changed",
  before: "draft",
  after,
  reason,
});

/** Numbers events from 1, one second apart. */
export function record(...events: MissionEvent[]): Recorded[] {
  return events.map((event, i) => ({
    seq: i + 1,
    mission_id: "m",
    at_utc: new Date(Date.UTC(2026, 0, 1, 12, 0, i)).toISOString(),
    event,
  }));
}

