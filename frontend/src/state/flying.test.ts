import { describe, expect, it } from "vitest";
import type { Phase } from "../wire";
import { missionToCommand } from "./flying";

const UP: readonly Phase[] = ["taking_off", "planning", "waiting", "flying", "measuring", "hold", "manual", "returning", "landing"];

/** A mission as its events tell it, with one craft. */
const shown = (id: string, phase: Phase, craft = "c") => ({ id, crafts: new Map([[craft, { engaged: phase !== "ground", phase }]]) });
const drafted = (id: string) => ({ id, crafts: new Map() });
/** What the server's status says of a craft. */
const served = (mission_id: string | null, phase: Phase, craft_id = "c") => ({ craft_id, mission_id, phase });
const air = (inAir: boolean | null, craft = "c") => new Map([[craft, inAir]]);
const ask = (picture: Partial<Parameters<typeof missionToCommand>[0]>) =>
  missionToCommand({ shown: null, served: [], inAir: new Map(), preferred: null, ...picture });

describe("the mission that abort, hold and return act on", () => {
  it("is the one in flight, whatever the page shows and the vehicle tells", () => {
    for (const inAir of [air(true), air(false), air(null), new Map()]) {
      expect(ask({ shown: shown("a", "flying"), inAir })).toEqual({ id: "a", craftId: "c", phase: "flying" });
      expect(ask({ served: [served("b", "manual")], inAir })).toMatchObject({ id: "b", phase: "manual" });
      expect(ask({ shown: drafted("a"), served: [served("b", "hold")], inAir })).toMatchObject({ id: "b", phase: "hold" });
      expect(ask({ shown: shown("a", "ground"), served: [served("b", "returning")], inAir })).toMatchObject({
        id: "b",
        phase: "returning",
      });
    }
  });

  it("knows from the mission's own events what the server's status does not say yet", () => {
    const inAir = air(true);
    expect(ask({ shown: shown("a", "hold"), served: [served("a", "flying")], inAir })).toMatchObject({ id: "a", phase: "hold" });
    expect(ask({ shown: shown("a", "taking_off"), served: [served(null, "ground")], inAir: air(false) })).toMatchObject({ id: "a" });
    expect(ask({ shown: shown("a", "ground"), served: [served("a", "landing")], inAir: air(false) })).toBeNull();
  });

  it("is still the mission that was aborted or has ended, until its craft are down", () => {
    for (const phase of UP) {
      expect(ask({ shown: shown("a", phase), served: [served("a", phase)], inAir: air(true) })).toMatchObject({ id: "a", phase });
      expect(ask({ served: [served("a", phase)], inAir: air(null) })).toMatchObject({ id: "a", phase });
    }
    const down = { shown: shown("a", "ground"), served: [served("a", "ground")] };
    expect(ask({ ...down, inAir: air(true) })).toMatchObject({ id: "a" });
    expect(ask({ ...down, inAir: air(null) })).toMatchObject({ id: "a" });
    expect(ask({ ...down, inAir: air(false) })).toBeNull();
  });

  it("is the one with a craft in the air when another one of it is down already", () => {
    const crafts = new Map([
      ["c", { engaged: false, phase: "ground" as Phase }],
      ["d", { engaged: true, phase: "hold" as Phase }],
    ]);
    const status = [served("a", "ground"), served("a", "hold", "d")];
    expect(ask({ shown: { id: "a", crafts }, served: status, inAir: air(false) })).toEqual({ id: "a", craftId: "d", phase: "hold" });
    expect(ask({ served: status, inAir: air(false) })).toEqual({ id: "a", craftId: "d", phase: "hold" });
  });

  it("names the craft that is shown, where several fly", () => {
    const status = [served("a", "flying"), served("a", "hold", "d")];
    expect(ask({ served: status })?.craftId).toBe("c");
    expect(ask({ served: status, preferred: "d" })).toEqual({ id: "a", craftId: "d", phase: "hold" });
  });

  it("is a craft in the air without a mission when no mission flies", () => {
    const loose = { id: null, craftId: "d", phase: "hold" };
    expect(ask({ served: [served(null, "hold", "d")] })).toEqual(loose);
    expect(ask({ shown: drafted("a"), served: [served(null, "hold", "d")], inAir: air(true, "d") })).toEqual(loose);
    expect(ask({ served: [served("b", "flying"), served(null, "hold", "d")] })).toMatchObject({ id: "b" });
  });

  it("is none when nothing of ours can fly", () => {
    expect(ask({})).toBeNull();
    expect(ask({ served: [served(null, "ground")], inAir: air(true) })).toBeNull();
    expect(ask({ shown: drafted("a"), served: [served(null, "ground")] })).toBeNull();
    expect(ask({ shown: shown("a", "ground"), served: [served(null, "ground")] })).toBeNull();
  });
});
