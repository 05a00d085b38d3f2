import { describe, expect, it } from "vitest";
import { type Coded, remedyIn, type Shown, textIn, type Words } from "./template";

const TABLE: Record<string, Words> = {
  windy: ["Wind of {speed_m_s} from {side?n=the north|*=elsewhere}{until?none=|*= until noon}."],
  far: ["{distance_m} away, {area_m2}, {near_m:1}.", "Fly to {lat_deg@lon_deg}."],
  many: ["{places|place|places}: {names}; {kinds?a=first|b=second}."],
  timed: ["{age_s}, {age_s:1}, {left_time_s}, {turn_deg}, {turn_deg_s}, {share_percent}."],
  heard: ["{carrier_hz}, {rate_hz}, {level_db}, {size_bytes}, {share}, {given:2}."],
  because: ["Not now. {because}", "{because!remedy}"],
};

const shown = (part: Partial<Shown> = {}): Shown => ({
  language: "en",
  units: "metric",
  coordinates: "dd",
  wordsOf: ({ code }) => TABLE[code]!,
  ...part,
});
const say = (reason: Coded & Record<string, unknown>, part: Partial<Shown> = {}) => textIn(shown(part), reason);
const german = { language: "de" } as const;
const imperial = { units: "imperial" } as const;

describe("a reason's sentence", () => {
  it("has values with their units, in the operator's", () => {
    const far = { code: "far", distance_m: 1234, area_m2: 250_000, near_m: 7.25, lat_deg: 50.7, lon_deg: -7.1 };
    expect(say(far)).toBe("1.2 km away, 0.25 km², 7.2 m.");
    expect(say(far, german)).toBe("1,2 km away, 0,25 km², 7,2 m.");
    expect(say(far, imperial)).toBe("4,049 ft away, 61.78 acres, 23.8 ft.");
    expect(remedyIn(shown(), far)).toBe("Fly to 50.70000 N 7.10000 W.");
    expect(remedyIn(shown({ coordinates: "dms" }), far)).toBe("Fly to 50°42′00.0″ N 007°06′00.0″ W.");
  });

  it("has times, angles and shares", () => {
    const timed = { code: "timed", age_s: 412.3, left_time_s: 236.4, turn_deg: 90, turn_deg_s: 30, share_percent: 12.5 };
    expect(say(timed)).toBe("7 min, 412.3 s, 3:56, 90 degrees, 30 degrees/s, 12 %.");
    expect(say({ ...timed, age_s: 4 }, german)).toBe("4 s, 4,0 s, 3:56, 90 Grad, 30 Grad/s, 12 %.");
  });

  it("has frequencies, levels, sizes and plain numbers", () => {
    const heard = { code: "heard", carrier_hz: 868.3e6, rate_hz: 250e3, level_db: 6, size_bytes: 2 ** 21, share: 0.125, given: 1 };
    expect(say(heard)).toBe("868.3000 MHz, 250.0 kHz, 6.0 dB, 2 MB, 0.125, 1.00.");
    expect(say(heard, german)).toBe("868,3000 MHz, 250,0 kHz, 6,0 dB, 2 MB, 0,125, 1,00.");
  });

  it("counts, lists and chooses", () => {
    expect(say({ code: "many", places: 1, names: ["A"], kinds: ["b"] })).toBe("1 place: A; second.");
    expect(say({ code: "many", places: 3, names: ["A", "B"], kinds: ["a", "b"] })).toBe("3 places: A, B; first, second.");
    expect(say({ code: "windy", speed_m_s: 8, side: "n", until: null })).toBe("Wind of 8.0 m/s from the north.");
    expect(say({ code: "windy", speed_m_s: 8, side: "s", until: null }, imperial)).toBe("Wind of 17.9 mph from elsewhere.");
  });

  it("holds other reasons and their remedies", () => {
    const inner = { code: "far", distance_m: 5, area_m2: 1, near_m: 1, lat_deg: 1, lon_deg: 2 };
    expect(say({ code: "because", because: inner })).toBe("Not now. 5 m away, 1 m², 1.0 m.");
    expect(remedyIn(shown(), { code: "because", because: [inner, inner] } as Coded)).toBe(
      "Fly to 1.00000 N 2.00000 E. Fly to 1.00000 N 2.00000 E.",
    );
  });
});
