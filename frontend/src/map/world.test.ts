import { describe, expect, it } from "vitest";
import { worldFeatures } from "./world";

describe("the small basemap", () => {
  it("is read from steps in parts of a degree", () => {
    const { features } = worldFeatures({
      scale: 100,
      land: [[[700, 5000, 100, 0, 0, 50, -100, -50]]],
      lakes: [],
      rivers: [[-150, -20, 1, 2]],
      towns: [[711, 5073, 3, "Bonn"]],
    });
    expect(features.map(({ geometry }) => geometry)).toEqual([
      {
        type: "Polygon",
        coordinates: [
          [
            [7, 50],
            [8, 50],
            [8, 50.5],
            [7, 50],
          ],
        ],
      },
      {
        type: "LineString",
        coordinates: [
          [-1.5, -0.2],
          [-1.49, -0.18],
        ],
      },
      { type: "Point", coordinates: [7.11, 50.73] },
    ]);
    expect(features[2]!.properties).toEqual({ what: "town", rank: 3, name: "Bonn" });
  });
});
