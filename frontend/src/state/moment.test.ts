import { expect, it } from "vitest";
import type { BeliefUpdated, MissionEvent } from "../wire";
import { EMITTER, phase, record, someBearing } from "../wire/examples";
import { settledSeq } from "./moment";

const belief = (emitter: string): MissionEvent => ({ kind: "belief_updated", emitter_id: emitter, bearings: 1 }) as BeliefUpdated;

it("shows a bearing with the belief that followed from it", () => {
  const events = record(phase("measuring"), someBearing(), belief("other"), belief(EMITTER), phase("planning"));
  expect(events.map(({ seq }) => settledSeq(events, seq))).toEqual([1, 4, 3, 4, 5]);
});

it("shows a bearing alone where none followed before the next decision", () => {
  const started = { kind: "sweep_started" } as MissionEvent;
  const events = record(someBearing(), started, belief(EMITTER));
  expect(settledSeq(events, 1)).toBe(1);
});
