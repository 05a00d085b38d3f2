import { describe, expect, it } from "vitest";
import { unseen, type VehicleView, withoutTremble } from "./vehicleView";

const drawn: VehicleView = { at: [7.2, 50.6], headingDeg: 359, speedMs: 0 };
const METRE = 1 / 111_195;

describe("steady", () => {
  it("keeps what is drawn while the vehicle trembles, across north too", () => {
    expect(withoutTremble(drawn, { at: [7.2, 50.6 + 0.2 * METRE], headingDeg: 2, speedMs: 0.1 })).toBe(drawn);
  });
  it("follows a step of place, heading or speed", () => {
    for (const step of [{ at: [7.2, 50.6 + 0.4 * METRE] as [number, number] }, { headingDeg: 4 }, { headingDeg: 354 }, { speedMs: 0.5 }]) {
      const now = { ...drawn, ...step };
      expect(withoutTremble(drawn, now)).toBe(now);
    }
  });
  it("does not lag behind a slow turn by more than a step", () => {
    let shown = drawn;
    for (let deg = 0; deg < 720; deg++) {
      shown = withoutTremble(shown, { ...drawn, headingDeg: deg % 360 });
      expect((deg - shown.headingDeg! + 720) % 360).toBeLessThan(4);
    }
  });
  it("shows at once what appears and what is gone", () => {
    expect(withoutTremble(unseen, drawn)).toBe(drawn);
    expect(withoutTremble(drawn, unseen)).toBe(unseen);
    expect(withoutTremble(unseen, { ...unseen })).toBe(unseen);
  });
});
