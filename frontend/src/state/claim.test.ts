import { describe, expect, it } from "vitest";
import { claimOf, wayM } from "./claim";
import { emptyEmitter } from "./emitter";

const animal = { kind: "animal", speed_m_s: 0.4 } as const;
const claimed = (rmse: number) => ({
  ...emptyEmitter("a"),
  claim: { fact: { estimate: { expected_rmse_m: rmse } } as never, seq: 3, at: "2026-05-01T14:02:00Z" },
});
const at = (clock: string) => Date.parse(`2026-05-01T${clock}Z`);

describe("what a claim is worth by now", () => {
  it("grows with time, straight at first and as a random walk later", () => {
    expect(wayM(animal, 3)).toBeCloseTo(1.2, 1);
    expect(wayM(animal, 3000) / wayM(animal, 750)).toBeCloseTo(2, 1);
    expect(wayM({ kind: "drifting", speed_m_s: 0.4 }, 90)).toBeGreaterThan(wayM(animal, 90));
  });
  it("says both", () => {
    const claim = claimOf(claimed(9), animal, at("14:12:00"))!;
    expect(claim.thenM).toBe(9);
    // 0.4 x 30 x sqrt(2 x 19) = 74
    expect(claim.nowM).toBeCloseTo(Math.hypot(9, 74), 0);
    expect(claimOf(claimed(9), animal, at("14:02:00"))!.nowM).toBe(9);
  });
  it("is silent about what stands still or was not found", () => {
    expect(claimOf(claimed(9), { kind: "still", speed_m_s: 0.2 }, at("14:12:00"))).toBeNull();
    expect(claimOf(emptyEmitter("a"), animal, at("14:12:00"))).toBeNull();
    expect(claimOf(undefined, animal, at("14:12:00"))).toBeNull();
  });
});
