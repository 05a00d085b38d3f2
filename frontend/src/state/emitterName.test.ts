import { expect, it } from "vitest";
import { reasonText } from "../i18n";
import type { EmitterSpec, MissionEvent, Reason } from "../wire";
import { record, someSpec } from "../wire/examples";
import { namingEmitter } from "./emitterName";
import { eventWords } from "./eventWords";
import { missionAt } from "./mission";

const labelled = (id: string, label: string): EmitterSpec => ({ ...someSpec().emitters[0]!, emitter_id: id, label });
const emitters = [labelled("emitter-1", "ELT"), labelled("emitter-2", "")];
const broke = (id: string): Reason => ({ code: "belief_broke", emitter_id: id });
const raised: MissionEvent = {
  kind: "alert_raised",
  alert_id: "failure-1",
  topic: "failure",
  level: "warning",
  reason: broke("emitter-1"),
  craft_id: null,
  emitter_id: null,
};

it("calls an emitter by its label wherever an alert names one, and by its id where it has none", () => {
  expect(reasonText(namingEmitter(emitters, broke("emitter-1")))).toContain("ELT");
  expect(namingEmitter(emitters, broke("emitter-2"))).toEqual(broke("emitter-2"));
  const drafted: MissionEvent = { kind: "mission_drafted", spec: { ...someSpec(), emitters } };
  const { alerts } = missionAt(record(drafted, raised), Infinity);
  expect(alerts.map(({ reason }) => reason)).toEqual([broke("ELT")]);
  expect(eventWords(record(raised)[0]!, "metric", emitters)).toContain(reasonText(broke("ELT")));
});
