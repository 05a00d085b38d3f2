// The map of the editor: areas are drawn and their corners moved with Terra Draw; files may be dropped on it.
import { computed, effect } from "@preact/signals";
import type { GeoJSONSource, Map as GlMap } from "maplibre-gl";
import { useEffect, useRef } from "preact/hooks";
import { type GeoJSONStoreFeatures, TerraDraw, TerraDrawPolygonMode, TerraDrawRectangleMode, TerraDrawSelectMode } from "terra-draw";
import { TerraDrawMapLibreGLAdapter } from "terra-draw-maplibre-gl-adapter";
import { draft } from "../edit/draft";
import { add, polygonsOfKind, replace, tool, what } from "../edit/drawing";
import { outlook } from "../edit/outlook";
import { firstPlan, preview } from "../edit/preview";
import { t } from "../i18n";
import { type Ring, type Rings, ringsApart, ringsTogether } from "../state/areas";
import type { At } from "../state/emitter";
import { boundsOf, lonLat, together } from "../state/geometry";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { vehicle } from "../state/vehicle";
import type { MissionSpec, PlanChosen } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { addBasemap, basemap } from "./basemap";
import { createMap, fit, framed } from "./createMap";
import { areaPoints, candidateFeatures, collection, flightPoints, measuredFeatures, planFeatures } from "./features";
import { addSources, missionLayers } from "./layers";
import { type Palette, palettes } from "./palette";
import { showVehicle } from "./vehicleMarker";

type Hex = `#${string}`;

function makeDraw(map: GlMap, colours: Palette): TerraDraw {
  const accent = colours.accent as Hex;
  const styles = { fillColor: accent, fillOpacity: 0.15, outlineColor: accent, outlineWidth: 3 };
  return new TerraDraw({
    adapter: new TerraDrawMapLibreGLAdapter({ map }),
    modes: [
      new TerraDrawPolygonMode({ styles: { ...styles, closingPointColor: accent, closingPointWidth: 7 }, pointerDistance: 20 }),
      new TerraDrawRectangleMode({ styles }),
      new TerraDrawSelectMode({
        keyEvents: null,
        flags: { polygon: { feature: { draggable: true, coordinates: { midpoints: true, draggable: true, deletable: true } } } },
        styles: { selectedPolygonColor: accent, selectedPolygonOutlineColor: accent, selectionPointWidth: 8, selectionPointColor: accent },
      }),
    ],
  });
}

const ringsOf = (feature: GeoJSONStoreFeatures): Rings =>
  feature.geometry.type === "Polygon" ? (feature.geometry.coordinates as Rings) : [];

/** Terra Draw knows no holes: every ring is a polygon of its own while its corners are moved. It takes nine decimals, a
 * tenth of a millimetre, and none beyond 180 degrees. Returns the rings that it does not take. */
function addRings(draw: TerraDraw, polygons: readonly Rings[]): Ring[] {
  const rings = ringsApart(polygons);
  const added = draw.addFeatures(
    rings.map(({ polygon, ring, corners }) => ({
      type: "Feature",
      properties: { mode: "polygon", polygon, ring },
      geometry: { type: "Polygon", coordinates: [together(corners).map((corner) => corner.map((degrees) => Number(degrees.toFixed(9))))] },
    })),
  );
  const first = added.find(({ valid }) => valid)?.id;
  if (first !== undefined) draw.selectFeature(first);
  return rings.filter((_, i) => !added[i]!.valid);
}

const ringsBack = (draw: TerraDraw, others: readonly Ring[]): Rings[] =>
  ringsTogether([
    ...others,
    ...draw
      .getSnapshot()
      .filter((f) => f.properties.mode === "polygon" && typeof f.properties.ring === "number")
      .map((f) => ({ polygon: f.properties.polygon as number, ring: f.properties.ring as number, corners: ringsOf(f)[0] ?? [] })),
  ]);

/** Carries the chosen tool into Terra Draw, and what was drawn back into the draft. */
function bindTools(draw: TerraDraw): () => void {
  let others: Ring[] = [];
  const takeMoved = () => replace(what.peek(), ringsBack(draw, others));
  draw.on("finish", (id, context) => {
    if (context.action !== "draw") {
      takeMoved();
      return;
    }
    const drawn = draw.getSnapshotFeature(id);
    if (!drawn) return;
    add(what.peek(), [ringsOf(drawn)]);
    // Terra Draw still works on the feature while it tells of it.
    setTimeout(() => {
      draw.clear();
      tool.value = "none";
    });
  });
  return effect(() => {
    const chosen = tool.value;
    if (draw.getMode() === "select") {
      draw.clear();
    }
    if (chosen === "corners") {
      draw.setMode("select");
      others = addRings(draw, polygonsOfKind(what.value));
    } else draw.setMode(chosen === "none" ? "static" : chosen);
  });
}

const FALLBACK_START: LonLat = [7.1, 50.73];

/** Of a mission in flight: what its bearings say helps to draw where to search on. */
const flownSpec = computed(() => mission.value.spec);
const bearings = computed(() => mission.value.bearings);
const belief = computed(() => mission.value.belief);
const home = computed(() => mission.value.home);

/** What the planner would do: of a mission before its start, or of one that would search elsewhere. */
const proposed = computed<At<PlanChosen> | null>(() => {
  const found = preview.value?.found;
  const fact = found ? firstPlan(found) : outlook.value?.found?.plan;
  return fact ? { seq: 0, at: "", fact } : null;
});

/** To the metre, so that the map is not drawn again with every telemetry value. */
const parked = computed(() => vehicle.value.at?.map((degrees) => degrees.toFixed(5)).join() ?? null);

/** False as soon as the operator moves the map himself: then it stays where he put it. */
let framing = true;

function frameDraft(map: GlMap, spec: MissionSpec): void {
  const at = vehicle.peek().at;
  const bounds = boundsOf([...areaPoints(spec.area), ...flightPoints(spec), ...(at ? [at] : [])]);
  if (bounds) fit(map, bounds, false);
}

export function EditMap({ onFile }: { onFile: (file: File) => void }) {
  const box = useRef<HTMLDivElement>(null);
  const theme = settings.value.theme;
  const units = settings.value.units;
  useEffect(() => {
    const colours = palettes[theme];
    const spec = draft.peek()?.spec;
    const map = createMap(box.current!, colours, units, (spec && areaPoints(spec.area)[0]) ?? vehicle.peek().at ?? FALLBACK_START);
    map.doubleClickZoom.disable();
    const stops: (() => void)[] = [];
    map.on("load", () => {
      addSources(map);
      for (const layer of missionLayers(colours, basemap.peek() !== null)) map.addLayer(layer);
      const put = (name: string, data: GeoJSON.FeatureCollection) => map.getSource<GeoJSONSource>(name)?.setData(data);
      stops.push(
        effect(() => {
          const now = draft.value;
          const shown = now ? planFeatures(now.spec) : collection([]);
          put("plan", now?.hasArea ? shown : collection(shown.features.filter((f) => f.properties?.what !== "area")));
        }),
        effect(() => {
          const start = home.value;
          const at = start ? lonLat(start) : parked.value?.split(",").map(Number);
          put("home", collection(at ? [{ type: "Feature", properties: {}, geometry: { type: "Point", coordinates: at } }] : []));
        }),
        effect(() => {
          put("measured", measuredFeatures({ spec: flownSpec.value, bearings: bearings.value, belief: belief.value }));
        }),
        effect(() => (home.value ? showVehicle(map) : undefined)),
        effect(() => {
          put("candidates", candidateFeatures({ plan: proposed.value, bearings: [] }, null));
        }),
      );
      const draw = makeDraw(map, colours);
      draw.start();
      stops.push(() => draw.stop(), bindTools(draw));
      void addBasemap(map, theme === "indoor" ? "dark" : "light", "no-fly").catch(() => undefined);
      box.current?.setAttribute("data-ready", "true");
    });
    stops.push(
      effect(() => {
        const now = draft.value;
        if (!now || framed.what === `draft:${now.key}`) return;
        framed.what = `draft:${now.key}`;
        framing = true;
        frameDraft(map, now.spec);
      }),
    );
    map.on("movestart", (event) => {
      if ("originalEvent" in event && event.originalEvent) framing = false;
    });
    map.on("resize", () => {
      const now = draft.peek();
      if (framing && now) frameDraft(map, now.spec);
    });
    return () => {
      for (const stop of stops.toReversed()) stop();
      map.remove();
      tool.value = "none";
    };
  }, [theme, units, basemap.value]);
  return (
    <div
      class={`map tool-${tool.value}`}
      ref={box}
      data-testid="edit-map"
      role="application"
      aria-label={t("map.label")}
      onDragOver={(e) => e.preventDefault()}
      onDrop={(e) => {
        e.preventDefault();
        const file = e.dataTransfer?.files[0];
        if (file) onFile(file);
      }}
    />
  );
}
