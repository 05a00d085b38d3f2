// @vitest-environment happy-dom
import { effect } from "@preact/signals";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import type { SourceMessage } from "../sources/source";
import type { BeliefFrame } from "../wire/beliefFrame";
import {
  CRAFT,
  EMITTER,
  phase,
  record,
  someBearing,
  someBelief,
  someCraftStatus,
  someSpec,
  someStatus,
  someTelemetry,
  started,
} from "../wire/examples";
import { shownBelief } from "./belief";
import { live } from "./connection";
import { craftStatus, telemetry } from "./heard";
import { cursor, look } from "./moment";
import { open } from "./open";
import { selectedCraft, selectedEmitter } from "./selection";
import { mission } from "./shown";
import { vehicle } from "./vehicle";

const journal = record({ kind: "mission_drafted", spec: someSpec() }, phase("flying"), someBearing(), phase("hold"));
const events = journal.map((recorded): SourceMessage => ({ type: "event", recorded }));
const someFrame = (seq: number): BeliefFrame => ({
  missionId: "m",
  emitterId: EMITTER,
  seq,
  bearings: 1,
  nx: 1,
  ny: 1,
  bounds: [
    [7, 50],
    [8, 50],
    [8, 51],
    [7, 51],
  ],
  peak: 1,
  cells: new Float32Array([1]),
});
const toldBelief = (seq: number): SourceMessage => ({ type: "event", recorded: { ...journal[0]!, seq, event: someBelief() } });
const hello = (lastSeq: number): SourceMessage => ({
  type: "hello",
  server_version: "",
  mission_id: "m",
  last_seq: lastSeq,
  time_factor: 1,
});
const frame = () => vi.advanceTimersByTime(17);

let source: FakeSource;
beforeEach(() => {
  vi.useFakeTimers();
  source = new FakeSource();
  open(source);
});
afterEach(() => {
  vi.useRealTimers();
});

/** How often what is heard changes while `act` goes on. */
function changes(act: () => void): number {
  let count = -1;
  const stop = effect(() => {
    live.value;
    count += 1;
  });
  act();
  stop();
  return count;
}

describe("what is heard", () => {
  it("is folded once a frame, however many messages came", () => {
    const folds = changes(() => {
      source.tell(...events, someTelemetry());
      frame();
    });
    expect(folds).toBe(1);
    expect(mission.value.phase).toBe("hold");
    expect(vehicle.value.at).toEqual([7.1, 50.7]);
  });

  it("is folded at once when a belief arrives, together with all before it", () => {
    source.tell(...events, { type: "belief", frame: someFrame(5) }, toldBelief(5));
    expect(shownBelief.value?.seq).toBe(5);
    expect(live.value.events).toHaveLength(events.length + 1);
  });

  it("waits for the next telemetry when it is no more than a status, but not long", () => {
    source.tell(someStatus({ mission_id: "m" }));
    frame();
    expect(live.value.status?.value.mission_id).not.toBe("m");
    vi.advanceTimersByTime(100);
    expect(live.value.status?.value.mission_id).toBe("m");
  });
});

describe("a bearing", () => {
  const told = (seq: number, event: Parameters<typeof record>[0]): SourceMessage => ({
    type: "event",
    recorded: { ...record(event)[0]!, seq },
  });
  const bearing = told(5, someBearing());
  const belief = toldBelief(7);
  beforeEach(() => {
    source.tell(...events);
    frame();
  });

  it("is drawn with its belief, in one change with all that came between", () => {
    const folds = changes(() => {
      source.tell(someTelemetry({ battery_percent: 40 }));
      source.tell(bearing, told(6, phase("planning")), someTelemetry({ battery_percent: 22 }), someStatus({ mission_id: "m" }));
      vi.advanceTimersByTime(60);
      expect(live.value.telemetry.get(CRAFT)?.value.battery_percent).not.toBe(22);
      expect(live.value.events).toHaveLength(events.length);
      source.tell({ type: "belief", frame: someFrame(7) }, belief);
    });
    expect(folds).toBe(1);
    expect(live.value.events.map(({ seq }) => seq).slice(-3)).toEqual([5, 6, 7]);
    expect(live.value.telemetry.get(CRAFT)?.value.battery_percent).toBe(22);
    expect(changes(() => vi.advanceTimersByTime(1000))).toBe(0);
  });

  it("does not wait long for a belief that does not come", () => {
    source.tell(bearing);
    vi.advanceTimersByTime(99);
    expect(live.value.events).toHaveLength(events.length);
    vi.advanceTimersByTime(1);
    expect(live.value.events.at(-1)?.seq).toBe(5);
  });

  it.each([phase("hold"), phase("manual"), { kind: "hold_ordered", craft_id: CRAFT, by: "a", reason: null }])(
    "holds up no news of another kind",
    (news) => {
      source.tell(bearing, told(6, news as Parameters<typeof record>[0]));
      frame();
      expect(live.value.events.at(-1)?.seq).toBe(6);
      source.tell(belief);
      expect(live.value.events.at(-1)?.seq).toBe(7);
    },
  );

  it("that comes behind other news waits for nothing", () => {
    source.tell(told(5, phase("manual")), told(6, someBearing()));
    frame();
    expect(live.value.events.at(-1)?.seq).toBe(6);
  });
});

describe("another source", () => {
  it("keeps what is known of the vehicle and forgets the mission", () => {
    source.tell(...events, someTelemetry({ battery_percent: 41 }), someStatus({ mission_id: "m" }));
    frame();
    const next = new FakeSource("other");
    open(next);
    expect(source.stopped).toBe(true);
    expect(mission.value.missionId).toBeNull();
    expect(live.value.telemetry.get(CRAFT)?.value.battery_percent).toBe(41);
    expect(live.value.status?.value.mission_id).toBe("m");
  });

  it("is the only one that is heard", () => {
    open(new FakeSource("other"));
    source.tell(...events);
    frame();
    expect(live.value.events).toEqual([]);
  });

  it("is looked at as it is now", () => {
    source.tell(...events);
    frame();
    look(2);
    open(new FakeSource("other"));
    expect(cursor.value).toBeNull();
  });
});

it("shows the mission as it was at the event looked at, and as it is when nothing is", () => {
  source.tell(...events);
  frame();
  look(2);
  expect([mission.value.phase, mission.value.bearings.length]).toEqual(["flying", 0]);
  look(null);
  expect([mission.value.phase, mission.value.bearings.length]).toEqual(["hold", 1]);
});

describe("with several craft and emitters", () => {
  const spec = someSpec();
  const two = { ...spec, emitters: [spec.emitters[0]!, { ...spec.emitters[0]!, emitter_id: "b" }] };
  const flights = record(
    { kind: "mission_drafted", spec: two },
    started(),
    started({ craft_id: "craft-2" }),
    someBearing({ emitter_id: "b" }),
    { ...phase("hold"), craft_id: "craft-2" },
  ).map((recorded): SourceMessage => ({ type: "event", recorded }));
  const crafts = [someCraftStatus({ mission_id: "m" }), someCraftStatus({ craft_id: "craft-2", mission_id: "m", phase: "hold" })];
  const heard = () => {
    source.tell(hello(flights.length), ...flights, someStatus({ mission_id: "m", crafts }));
    source.tell(someTelemetry(), someTelemetry({ craft_id: "craft-2", battery_percent: 41, lat: 50.8 }));
    frame();
  };

  it("shows the first, and the one that is selected", () => {
    heard();
    expect([mission.value.craftId, mission.value.bearings.length, vehicle.value.at]).toEqual([CRAFT, 0, [7.1, 50.7]]);
    selectedCraft.value = "craft-2";
    selectedEmitter.value = "b";
    expect([mission.value.phase, mission.value.bearings.length]).toEqual(["hold", 1]);
    expect([telemetry.value?.value.battery_percent, craftStatus.value?.value.phase]).toEqual([41, "hold"]);
    expect(vehicle.value.at).toEqual([7.1, 50.8]);
  });

  it("asks for the belief about the emitter shown", () => {
    const asked: string[] = [];
    source.belief = (_mission, emitter, seq) => {
      asked.push(`${emitter} ${seq}`);
      return new Promise(() => undefined);
    };
    heard();
    selectedEmitter.value = "b";
    expect(asked).toEqual([`${EMITTER} 1`, "b 1"]);
    source.tell({ type: "belief", frame: someFrame(6) }, toldBelief(6));
    expect(shownBelief.value?.seq).not.toBe(6);
    selectedEmitter.value = null;
    expect(shownBelief.value?.seq).toBe(6);
    selectedEmitter.value = "b";
    expect(shownBelief.value).toBeNull();
  });

  it("shows the first again of another source", () => {
    selectedCraft.value = "craft-2";
    selectedEmitter.value = "b";
    open(new FakeSource("other"));
    expect([selectedCraft.value, selectedEmitter.value]).toEqual([null, null]);
  });
});

describe("the belief of an event", () => {
  const asked: number[] = [];
  beforeEach(() => {
    asked.length = 0;
    source.belief = (_mission, _emitter, seq) => {
      asked.push(seq);
      return Promise.resolve(someFrame(seq));
    };
  });

  it("is shown when it was sent ahead, and asked for when it was not", async () => {
    source.tell(hello(4), ...events, { type: "belief", frame: someFrame(5) }, toldBelief(5));
    expect([shownBelief.value?.seq, asked]).toEqual([5, []]);
    source.tell(toldBelief(6));
    expect(asked).toEqual([6]);
    await vi.advanceTimersByTimeAsync(0);
    expect(shownBelief.value?.seq).toBe(6);
  });

  it("is not asked for while the mission is read from its beginning", () => {
    source.tell(hello(6), ...events, toldBelief(5));
    expect(asked).toEqual([]);
    source.tell(toldBelief(6));
    expect(asked).toEqual([6]);
  });

  it("is the one of the moment looked at", async () => {
    source.tell(hello(6), ...events, { type: "belief", frame: someFrame(5) }, toldBelief(5), { type: "belief", frame: someFrame(6) });
    source.tell(toldBelief(6));
    look(5);
    expect(shownBelief.value?.seq).toBe(5);
    look(2);
    expect(asked).toEqual([1]);
    look(null);
    expect(shownBelief.value?.seq).toBe(6);
  });

  it("is asked for again after a new greeting", async () => {
    source.belief = (_mission, _emitter, seq) => {
      asked.push(seq);
      return Promise.reject(new Error("no link"));
    };
    source.tell(hello(4), ...events);
    frame();
    await vi.advanceTimersByTimeAsync(0);
    expect([shownBelief.value, asked]).toEqual([null, [1]]);
    source.tell(hello(4));
    frame();
    expect(asked).toEqual([1, 1]);
  });
});
