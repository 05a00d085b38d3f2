import type { Map as GlMap } from "maplibre-gl";
import { beforeEach, expect, it, vi } from "vitest";
import { palettes } from "./palette";
import { addRelief, showRelief } from "./relief";

type Layer = { id: string; type: string; source: string };

const answers = vi.hoisted(() => ({ terrains: [] as { bounds: number[] }[], asked: [] as unknown[] }));

vi.mock("../sources/terrainApi", () => ({
  HEIGHTS: "heights://",
  listTerrain: async () => ({ terrains: answers.terrains }),
  contours: async (place: unknown) => {
    answers.asked.push(place);
    return { type: "FeatureCollection", features: [] };
  },
}));

class FakeMap {
  sources = new Map<string, Record<string, unknown>>();
  layers: (Layer & { below: string })[] = [];
  visibility = new Map<string, string>();
  getSource = (id: string) => this.sources.get(id);
  addSource = (id: string, source: Record<string, unknown>) => this.sources.set(id, source);
  getLayer = (id: string) => this.layers.find((layer) => layer.id === id);
  addLayer = (layer: Layer, below: string) => this.layers.push({ ...layer, below });
  setLayoutProperty = (id: string, _: string, value: string) => this.visibility.set(id, value);
  getCenter = () => ({ lat: 50, lng: 7 });
}

const added = async (map: FakeMap) => addRelief(map as unknown as GlMap, palettes.outdoor, "belief");

beforeEach(() => {
  answers.terrains = [{ bounds: [7, 50, 8, 51] }, { bounds: [6, 49.5, 7.5, 50.5] }];
  answers.asked = [];
});

it("lies under the belief as shading, contour lines and their heights, over all uploaded terrain", async () => {
  const map = new FakeMap();
  await added(map);

  expect(map.sources.get("relief")).toMatchObject({
    type: "raster-dem",
    encoding: "terrarium",
    tiles: ["heights://{z}/{x}/{y}"],
    bounds: [6, 49.5, 8, 51],
  });
  expect(map.layers.map(({ type, source, below }) => [type, source, below])).toEqual([
    ["hillshade", "relief", "belief"],
    ["line", "contours", "belief"],
    ["symbol", "contours", "belief"],
  ]);
  expect(answers.asked).toEqual([{ lat: 50, lon: 7 }]);
});

it("is not there without terrain, and there once however often it is added", async () => {
  const map = new FakeMap();
  answers.terrains = [];
  await added(map);
  expect(map.layers).toEqual([]);

  answers.terrains = [{ bounds: [7, 50, 8, 51] }];
  await added(map);
  await added(map);
  expect(map.layers).toHaveLength(3);
});

it("is hidden and shown as a whole", async () => {
  const map = new FakeMap();
  showRelief(map as unknown as GlMap, false);
  expect(map.visibility.size).toBe(0);

  await added(map);
  showRelief(map as unknown as GlMap, false);
  expect([...map.visibility.values()]).toEqual(["none", "none", "none"]);
});
