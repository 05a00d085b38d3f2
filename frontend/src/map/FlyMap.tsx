// The mission on the map: everything follows the page's signals; clicks and drags propose a place, never fly there.
import { computed, effect, signal } from "@preact/signals";
import { type GeoJSONSource, type Map as GlMap, type ImageSource, type MapMouseEvent, Marker } from "maplibre-gl";
import { useEffect, useRef } from "preact/hooks";
import { proposal, propose } from "../commands/proposal";
import { tapping, tell } from "../commands/truth";
import { type MessageKey, reasonText, t } from "../i18n";
import { bannerPx } from "../panels/AlertBanner";
import { Icon } from "../panels/Icon";
import { advisedWay } from "../state/advice";
import { shownBelief } from "../state/belief";
import { isChoosing } from "../state/candidates";
import { source } from "../state/connection";
import { boundsOf, lonLat } from "../state/geometry";
import { highlighted } from "../state/highlight";
import { inFlight, isHomeward } from "../state/mission";
import { cursor, emittersThen } from "../state/moment";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { path, vehicle } from "../state/vehicle";
import { ways } from "../state/ways";
import { formatPlace } from "../units/coordinates";
import { formatDuration, formatLength } from "../units/quantities";
import type { LonLat } from "../wire/beliefFrame";
import { addBasemap, basemap } from "./basemap";
import { beliefPixels, imageCorners } from "./beliefImage";
import { createMap, fit, framed, gridStepM } from "./createMap";
import {
  areaPoints,
  candidateFeatures,
  collection,
  type Features,
  flightPoints,
  measuredFeatures,
  pathFeatures,
  planFeatures,
  wayFeatures,
} from "./features";
import { hover, watchHover } from "./hover";
import { addSources, missionLayers, type SourceName, SWITCHES, type Switch } from "./layers";
import { shownOverlays } from "./overlays";
import { palettes } from "./palette";
import { placeOn } from "./placeOn";
import { addRelief, showRelief } from "./relief";
import { showVehicle } from "./vehicleMarker";

const hidden = signal<ReadonlySet<Switch>>(new Set());
const follow = signal(false);

/** Of the last belief drawn: when the map was given its picture and when it had drawn it, for tests and measurements. */
declare global {
  interface Window {
    crossfixBeliefPainted?: { bearings: number; givenMs: number; atMs: number };
  }
}

function put(map: GlMap, name: SourceName, data: Features): void {
  map.getSource<GeoJSONSource>(name)?.setData(data);
}

/** Share of its strength at which a belief is drawn while no bearing has told anything: the outline says as much. */
const BEFOREHAND = 0.4;

function paintBelief(map: GlMap): void {
  const frame = shownBelief.value;
  const visible = frame !== null && !hidden.value.has("belief");
  map.setLayoutProperty("belief", "visibility", visible ? "visible" : "none");
  if (!frame) return;
  map.setPaintProperty("belief", "raster-opacity", frame.bearings === 0 ? BEFOREHAND : 1);
  const image = new ImageData(beliefPixels(frame), frame.nx, frame.ny);
  map.getSource<ImageSource>("belief")!.updateImage({ image, coordinates: imageCorners(frame) });
  const givenMs = performance.now();
  map.once("render", () => {
    window.crossfixBeliefPainted = { bearings: frame.bearings, givenMs, atMs: performance.now() };
  });
}

/** Empty at first; every belief is put into it. */
function addBelief(map: GlMap): void {
  const anywhere = imageCorners({
    bounds: [
      [0, 0],
      [1, 0],
      [1, 1],
      [0, 1],
    ],
  });
  map.addSource("belief", { type: "image", coordinates: anywhere });
  map.addLayer(
    { id: "belief", type: "raster", source: "belief", paint: { "raster-fade-duration": 0, "raster-resampling": "linear" } },
    "no-fly",
  );
}

function nextElement(): HTMLElement {
  const element = document.createElement("div");
  element.className = "next-place";
  element.dataset.testid = "next-place";
  return element;
}

/** Parts of the mission that keep their identity while another part changes: each is drawn again only when it changed. */
const spec = computed(() => mission.value.spec);
const bearings = computed(() => mission.value.bearings);
const estimated = computed(() => mission.value.belief);
const truth = computed(() => mission.value.truth);
const emitterId = computed(() => mission.value.emitterId);
const plan = computed(() => (isHomeward(mission.value) ? null : mission.value.plan));
const choice = computed(() => (isChoosing(mission.value) ? plan.value : null));
const home = computed(() => mission.value.home);
const phase = computed(() => mission.value.phase);

function putOverlays(map: GlMap): void {
  const overlays = shownOverlays.value;
  put(map, "overlays", overlays);
  for (const { id } of map.getStyle().layers.filter((layer) => "source" in layer && layer.source === "overlays")) {
    map.setLayoutProperty(id, "visibility", overlays.features.length > 0 ? "visible" : "none");
  }
}

function canPropose(): boolean {
  const { missionId, phase } = mission.peek();
  return cursor.peek() === null && missionId !== null && inFlight(phase) && !isHomeward(mission.peek());
}

/** Everything that follows a signal, each in its own effect so that telemetry never redraws the plan. */
function bind(map: GlMap): () => void {
  const nextMarker = new Marker({ element: nextElement(), draggable: true });
  nextMarker.on("dragend", () => {
    propose(placeOn(nextMarker.getLngLat()));
  });
  let nextShown = false;
  const stops = [
    showVehicle(map),
    effect(() => put(map, "plan", planFeatures(spec.value))),
    effect(() => put(map, "candidates", candidateFeatures({ plan: choice.value, bearings: bearings.value }, highlighted.value))),
    effect(() => put(map, "path", pathFeatures(path.value))),
    effect(() => putOverlays(map)),
    effect(() => put(map, "ways", wayFeatures(ways.value, advisedWay.value))),
    effect(() => {
      const at = home.value;
      put(map, "home", collection(at ? [{ type: "Feature", properties: {}, geometry: { type: "Point", coordinates: lonLat(at) } }] : []));
    }),
    effect(() => paintBelief(map)),
    effect(() => {
      const shown = { spec: spec.value, bearings: bearings.value, belief: estimated.value, emitterId: emitterId.value, truth: truth.value };
      put(map, "measured", measuredFeatures(shown, emittersThen.value));
    }),
    effect(() => {
      for (const layer of missionLayers(palettes[settings.value.theme], basemap.value !== null)) {
        const by = layer.metadata?.switch;
        if (by) map.setLayoutProperty(layer.id, "visibility", hidden.value.has(by) ? "none" : "visible");
      }
      showRelief(map, !hidden.value.has("relief"));
    }),
    effect(() => {
      const { at } = vehicle.value;
      if (follow.value && at) map.easeTo({ center: at, duration: 300 });
    }),
    effect(() => {
      const proposed = proposal.value;
      const at = proposed?.place ?? plan.value?.fact.place;
      nextMarker.getElement().classList.toggle("proposed", proposed !== null);
      nextMarker.getElement().title = t("plan.title");
      if (!at) {
        nextMarker.remove();
        nextShown = false;
        return;
      }
      nextMarker.setLngLat(lonLat(at)).setDraggable(cursor.value === null && inFlight(phase.value));
      if (!nextShown) nextMarker.addTo(map);
      nextShown = true;
    }),
  ];
  return () => {
    for (const stop of stops) stop();
    nextMarker.remove();
  };
}

/** False as soon as the operator moves the map himself: then it stays where he put it. */
let framing = true;

function frameAll(map: GlMap, animate: boolean): void {
  framing = true;
  const searched = spec.peek();
  const at = vehicle.peek().at;
  const start = home.peek();
  const points: LonLat[] = [
    ...(searched ? [...areaPoints(searched.area), ...flightPoints(searched)] : []),
    ...(start ? [lonLat(start)] : []),
    ...(at && inFlight(mission.peek().phase) ? [at] : []),
  ];
  const box = boundsOf(points);
  if (box) fit(map, box, animate, bannerPx.peek());
}

/** Its middle on the screen and its size, px. */
function placeOf(element: HTMLElement) {
  const { left, top, width, height } = element.getBoundingClientRect();
  return { x: left + width / 2, y: top + height / 2, width, height };
}

/** What the colours mean, beside the switches that show them: a legend of its own would lie over the map. */
function Legend() {
  const colours = palettes[settings.value.theme].rounds;
  return (
    <div class="map-legend" data-testid="legend">
      <span>
        <i class="legend-belief" /> {t("map.legend.belief")}
      </span>
      <span>
        {colours.map((c) => (
          <i class="legend-dot" style={{ background: c }} key={c} />
        ))}{" "}
        {t("map.legend.rounds")}
      </span>
    </div>
  );
}

function MapTools({ map }: { map: { current: GlMap | null } }) {
  const flip = (which: Switch) => {
    const next = new Set(hidden.value);
    if (!next.delete(which)) next.add(which);
    hidden.value = next;
  };
  return (
    <div class="map-tools">
      <button
        type="button"
        class="icon"
        data-testid="map-fit"
        title={t("map.fit")}
        aria-label={t("map.fit")}
        onClick={() => map.current && frameAll(map.current, true)}
      >
        <Icon name="fit" />
      </button>
      <button
        type="button"
        class="icon"
        title={t("map.follow")}
        aria-label={t("map.follow")}
        aria-pressed={follow.value}
        onClick={() => (follow.value = !follow.value)}
      >
        <Icon name="follow" />
      </button>
      <details>
        <summary title={t("map.layers")}>
          <Icon name="layers" />
          <span class="visually-hidden">{t("map.layers")}</span>
        </summary>
        <div class="map-layers">
          {SWITCHES.map((name) => (
            <label class="check" key={name}>
              <input type="checkbox" checked={!hidden.value.has(name)} onChange={() => flip(name)} />
              {t(`map.layer.${name}` satisfies MessageKey)}
            </label>
          ))}
        </div>
        <Legend />
      </details>
    </div>
  );
}

function Readout() {
  const { place, expected } = hover.value;
  const units = settings.value.units;
  return (
    <div class="readout" data-testid="readout">
      {place && <span data-testid="cursor-coordinates">{formatPlace(place, settings.value.coordinates)}</span>}
      {expected?.allowed && expected.expected_time_s !== null && (
        <strong data-testid="hover-time">{t("map.hover", { time: formatDuration(expected.expected_time_s) })}</strong>
      )}
      {expected?.reason && !expected.allowed && <span>{t("map.hoverNo", { reason: reasonText(expected.reason) })}</span>}
      {basemap.value === null && gridStepM.value !== null && (
        <span class="muted">{t("map.grid", { length: formatLength(gridStepM.value, units) })}</span>
      )}
    </div>
  );
}

const FALLBACK_START: LonLat = [7.1, 50.73];

export function FlyMap() {
  const box = useRef<HTMLDivElement>(null);
  const map = useRef<GlMap | null>(null);
  const theme = settings.value.theme;
  const units = settings.value.units;
  useEffect(() => {
    const start = vehicle.peek().at ?? (mission.peek().spec ? areaPoints(mission.peek().spec!.area)[0] : undefined) ?? FALLBACK_START;
    const created = createMap(box.current!, palettes[theme], units, start);
    map.current = created;
    let unbind: () => void = () => undefined;
    const stopFraming = effect(() => {
      const id = mission.value.spec ? mission.value.missionId : null;
      if (id === null || framed.what === id) return;
      framed.what = id;
      frameAll(created, false);
    });
    created.on("load", () => {
      addSources(created);
      for (const layer of missionLayers(palettes[theme], basemap.peek() !== null)) created.addLayer(layer);
      addBelief(created);
      unbind = bind(created);
      void addBasemap(created, theme === "indoor" ? "dark" : "light", "belief")
        .catch(() => undefined)
        .then(() => addRelief(created, palettes[theme], "belief"))
        .then(
          () => showRelief(created, !hidden.peek().has("relief")),
          () => undefined,
        );
      box.current?.setAttribute("data-ready", "true");
    });
    created.on("click", (event: MapMouseEvent) => {
      if (tapping.peek()) void tell(placeOn(event.lngLat), "map");
      else if (canPropose()) propose(placeOn(event.lngLat));
    });
    created.on("mousemove", "candidates", ({ features }) => {
      highlighted.value = (features?.[0]?.properties.index as number | undefined) ?? null;
    });
    created.on("mouseleave", "candidates", () => {
      highlighted.value = null;
    });
    created.on("movestart", (event) => {
      if ("originalEvent" in event && event.originalEvent) framing = false;
    });
    let size = placeOf(box.current!);
    created.on("resize", () => {
      const before = size;
      size = placeOf(box.current!);
      const grown = Math.abs(size.height - before.height) > 0.25 * before.height;
      if (framing && (grown || size.width !== before.width)) frameAll(created, false);
      else created.panBy([size.x - before.x, size.y - before.y], { duration: 0 }); // the ground stays where it is on the screen
    });
    const stopBanner = bannerPx.subscribe(() => {
      if (framing && framed.what !== null) frameAll(created, false);
    });
    const stopHover = watchHover(created, (place, aborted) => {
      const id = mission.peek().missionId;
      const from = source.peek();
      return id && from && canPropose() ? from.expectedTime(id, place, aborted) : null;
    });
    return () => {
      stopFraming();
      stopBanner();
      stopHover();
      unbind();
      created.remove();
      map.current = null;
    };
  }, [theme, units, basemap.value]);
  return (
    <>
      <div class="map" ref={box} data-testid="map" />
      <MapTools map={map} />
      <Readout />
    </>
  );
}
