import { afterEach, expect, it } from "vitest";
import type { MissionEvent, WhatIf } from "../wire";
import { EMITTER, excluded, included, record, someBearing, someLeg, someSpec } from "../wire/examples";
import { live } from "./connection";
import { missionAt } from "./mission";
import { look } from "./moment";
import { countedThen, supposed, supposedHere } from "./supposed";

afterEach(() => {
  look(null);
  supposed.value = null;
});

it("is shown only where the same bearings and legs count", () => {
  const spec = someSpec();
  const events: MissionEvent[] = [
    { kind: "mission_drafted", spec: { ...spec, emitters: [{ ...spec.emitters[0]!, emitter_id: EMITTER }] } },
    someBearing({ bearing_id: "one" }),
    someBearing({ bearing_id: "two" }),
    someLeg({ leg_id: "leg" }),
    excluded("one"),
    included("one"),
    excluded("two"),
  ];
  const all = record(...events);
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  const missionId = live.value.mission.missionId!;
  const at = (nth: number) => look(all[nth]!.seq);
  at(4);
  expect(countedThen.value).toBe("two,leg");
  supposed.value = { missionId, counted: countedThen.value, answer: { belief: { emitter_id: EMITTER } } as WhatIf, frame: {} as never };
  expect(supposedHere.value).not.toBeNull();
  at(6);
  expect(countedThen.value).toBe("one,leg");
  expect(supposedHere.value).toBeNull();
});
