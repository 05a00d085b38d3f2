// The missions of the list on one map: from afar a dot each, together where they lie close; from near their areas. A click opens.
import { type GeoJSONSource, type Map as GlMap, type MapMouseEvent, Popup } from "maplibre-gl";
import { useEffect, useRef } from "preact/hooks";
import { beside, boundsOf, together } from "../state/geometry";
import { go, missionAddress } from "../state/route";
import { settings } from "../state/settings";
import type { MissionSummary } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { addBasemap, basemap } from "./basemap";
import { createMap, framed } from "./createMap";
import { palettes } from "./palette";
import { addRelief } from "./relief";

/** Its rivers and towns still say where that is. */
const FRAMED_ZOOM = 5.2;
const AREAS_FROM_ZOOM = 10;
const EVERYWHERE: [number, number, number, number] = [-150, -50, 170, 70];
const MARGIN_PX = 60;
const EUROPE: LonLat = [7.1, 50.73];

const outlineOf = ({ sketch }: MissionSummary) => (sketch.outline as LonLat[][]).map(together);

function middleOf(mission: MissionSummary): LonLat | null {
  const box = boundsOf(outlineOf(mission).flat());
  return box && [beside((box[0] + box[2]) / 2, 0), (box[1] + box[3]) / 2];
}

const collection = (features: GeoJSON.Feature[]): GeoJSON.FeatureCollection => ({ type: "FeatureCollection", features });

const dots = (missions: readonly MissionSummary[]) =>
  collection(
    missions.flatMap((mission) => {
      const at = middleOf(mission);
      if (!at) return [];
      const properties = { id: mission.mission_id, name: mission.name, found: mission.outcome === "localized" };
      return [{ type: "Feature", properties, geometry: { type: "Point", coordinates: at } }];
    }),
  );

const areas = (missions: readonly MissionSummary[]) =>
  collection(
    missions.flatMap((mission) =>
      outlineOf(mission).map((ring) => ({
        type: "Feature",
        properties: { id: mission.mission_id },
        geometry: { type: "Polygon", coordinates: [ring] },
      })),
    ),
  );

function addMissions(map: GlMap, missions: readonly MissionSummary[]): void {
  const colours = palettes[settings.peek().theme];
  map.addSource("areas", { type: "geojson", data: areas(missions) });
  map.addSource("missions", { type: "geojson", data: dots(missions), cluster: true, clusterRadius: 34, clusterMaxZoom: 13 });
  map.addLayer({ id: "areas", type: "fill", source: "areas", paint: { "fill-color": colours.accent, "fill-opacity": 0.14 } });
  map.addLayer({
    id: "area-lines",
    type: "line",
    source: "areas",
    minzoom: AREAS_FROM_ZOOM,
    paint: { "line-color": colours.accent, "line-width": 1.5 },
  });
  map.addLayer({
    id: "missions",
    type: "circle",
    source: "missions",
    paint: {
      "circle-radius": ["step", ["coalesce", ["get", "point_count"], 1], 7, 2, 13, 20, 18],
      "circle-color": ["case", ["any", ["has", "point_count"], ["get", "found"]], colours.accent, colours.ground],
      "circle-stroke-color": ["case", ["any", ["has", "point_count"], ["get", "found"]], colours.ground, colours.accent],
      "circle-stroke-width": 3,
    },
  });
  map.addLayer({
    id: "mission-counts",
    type: "symbol",
    source: "missions",
    filter: ["has", "point_count"],
    layout: { "text-field": ["get", "point_count_abbreviated"], "text-font": ["sans-serif"], "text-size": 13, "text-allow-overlap": true },
    paint: { "text-color": colours.ground },
  });
}

/** Seen from where they are recognized; the whole world while there are none. */
function frame(map: GlMap, missions: readonly MissionSummary[]): void {
  const box = boundsOf(missions.flatMap((mission) => outlineOf(mission).flat()));
  map.fitBounds(box ?? EVERYWHERE, { padding: box ? MARGIN_PX : 0, maxZoom: FRAMED_ZOOM, duration: 0 });
}

/** A dot of several comes nearer; one alone is opened. */
async function open(map: GlMap, { point }: MapMouseEvent): Promise<void> {
  const [hit] = map.queryRenderedFeatures(point, { layers: ["missions", "areas"] });
  if (!hit) return;
  const { id, cluster_id: cluster } = hit.properties as { id?: string; cluster_id?: number };
  if (id !== undefined) return go(missionAddress(id));
  const source = map.getSource<GeoJSONSource>("missions");
  if (cluster === undefined || !source) return;
  const inside = await source.getClusterLeaves(cluster, 500, 0);
  const at = inside.map(({ geometry }) => (geometry as GeoJSON.Point).coordinates as LonLat);
  const box = boundsOf(at);
  if (box) map.fitBounds(box, { padding: 2 * MARGIN_PX, maxZoom: 14.5, duration: 600 });
}

export function LibraryMap({ missions }: { missions: readonly MissionSummary[] }) {
  const box = useRef<HTMLDivElement>(null);
  const map = useRef<GlMap | null>(null);
  const { theme, units } = settings.value;
  const shown = useRef(missions);
  shown.current = missions;
  useEffect(() => {
    const made = createMap(box.current!, palettes[theme], units, EUROPE);
    framed.what = "library";
    map.current = made;
    frame(made, missions);
    const named = new Popup({ closeButton: false, closeOnClick: false, className: "map-name", offset: 12 });
    made.on("load", () => {
      addMissions(made, shown.current);
      void addBasemap(made, theme === "indoor" ? "dark" : "light", "areas")
        .catch(() => undefined)
        .then(() => addRelief(made, palettes[theme], "areas"))
        .catch(() => undefined);
      made.once("idle", () => box.current?.setAttribute("data-ready", "true"));
    });
    made.on("click", (event) => void open(made, event));
    made.on("mousemove", "missions", ({ features, lngLat }) => {
      const name = features?.[0]?.properties.name as string | undefined;
      made.getCanvas().style.cursor = "pointer";
      if (name) named.setLngLat(lngLat).setText(name).addTo(made);
    });
    made.on("mouseleave", "missions", () => {
      made.getCanvas().style.cursor = "";
      named.remove();
    });
    return () => {
      made.remove();
      map.current = null;
    };
  }, [theme, units, basemap.value]);
  useEffect(() => {
    const made = map.current;
    made?.getSource<GeoJSONSource>("missions")?.setData(dots(missions));
    made?.getSource<GeoJSONSource>("areas")?.setData(areas(missions));
  }, [missions]);
  return <div class="map" ref={box} data-testid="library-map" />;
}
