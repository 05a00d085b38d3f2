import { describe, expect, it } from "vitest";
import { steady, unseen, type VehicleView } from "./vehicleView";

const drawn: VehicleView = { at: [7.2, 50.6], headingDeg: 359, speedMs: 0 };
const METRE = 1 / 111_195;

describe("steady", () => {
  it("keeps what is drawn while the vehicle trembles, across north too", () => {
    expect(steady(drawn, { at: [7.2, 50.6 + 0.2 * METRE], headingDeg: 2, speedMs: 0.1 })).toBe(drawn);
  });
  it("follows a step of place, heading or speed", () => {
    for (const step of [{ at: [7.2, 50.6 + 0.4 * METRE] as [number, number] }, { headingDeg: 4 }, { headingDeg: 354 }, { speedMs: 0.5 }]) {
      const now = { ...drawn, ...step };
      expect(steady(drawn, now)).toBe(now);
    }
  });
  it("does not lag behind a slow turn by more than a step", () => {
    let shown = drawn;
    for (let deg = 0; deg < 720; deg++) {
      shown = steady(shown, { ...drawn, headingDeg: deg % 360 });
      expect((deg - shown.headingDeg! + 720) % 360).toBeLessThan(4);
    }
  });
  it("shows at once what appears and what is gone", () => {
    expect(steady(unseen, drawn)).toBe(drawn);
    expect(steady(drawn, unseen)).toBe(unseen);
    expect(steady(unseen, { ...unseen })).toBe(unseen);
  });
});
