import { describe, expect, it } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { advice, freshness } from "./advice";
import { open } from "./open";

const given = {
  emitter_id: "a",
  localized: false,
  given_at_utc: "2026-05-01T12:00:00Z",
  bearings: 2,
  place: { lat: 50, lon: 7 },
  away_m: 390,
  bearing_deg: 40,
  along: "straight" as const,
  way: [],
  way_m: 390,
  move_s: 300,
  places: 0,
  unreached: 0,
  error_now_m: 80,
  error_then_m: 30,
  expected_time_s: 900,
  time_90_s: 1500,
  reason: null,
  hop: null,
};
const later = (seconds: number) => Date.parse(given.given_at_utc) + 1000 * seconds;

describe("advice", () => {
  it("holds while nobody has heard anything since, for as long as the way may take", () => {
    expect(freshness(given, 2, later(0))).toBe("holds");
    expect(freshness(given, 2, later(599))).toBe("holds");
    expect(freshness(given, 2, later(601))).toBe("old");
    expect(freshness({ ...given, move_s: 10 }, 2, later(299))).toBe("holds");
  });
  it("is outrun by a bearing that came, or was taken back", () => {
    expect(freshness(given, 3, later(1))).toBe("outrun");
    expect(freshness(given, 1, later(1))).toBe("outrun");
  });
  it("is of one search, and forgotten when another opens", () => {
    open(new FakeSource("m"));
    advice.value = given;
    open(new FakeSource("other"));
    expect(advice.value).toBeNull();
  });
});
