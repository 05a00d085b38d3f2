import { describe, expect, it } from "vitest";
import { headingOf } from "./phoneCompass";

describe("the phone's compass", () => {
  it("turns clockwise, whichever way the browser counts", () => {
    expect(headingOf({ webkitCompassHeading: 90 }, 0)).toBe(90);
    expect(headingOf({ absolute: true, alpha: 270 }, 0)).toBe(90);
    expect(headingOf({ absolute: true, alpha: 0 }, 0)).toBe(0);
  });
  it("takes a phone held sideways into account", () => {
    expect(headingOf({ absolute: true, alpha: 270 }, 90)).toBe(180);
    expect(headingOf({ webkitCompassHeading: 350 }, 90)).toBe(80);
  });
  it("says nothing where north is not known", () => {
    expect(headingOf({ absolute: false, alpha: 20 }, 0)).toBeNull();
    expect(headingOf({ absolute: true, alpha: null }, 0)).toBeNull();
  });
});
