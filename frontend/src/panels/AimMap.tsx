// A plain map for one thumb: the area, the craft's and others' bearings, where one stands and the direction one hears.
// Drawn without WebGL and without tiles, so that it is there at once on any phone. North is up.
import { useMemo } from "preact/hooks";
import { t } from "../i18n";
import type { Bearing } from "../state/emitter";
import { bearingDeg, beside, boundsOf, destination, distanceM, metresPerDegree } from "../state/geometry";
import type { Drawn } from "../state/ways";
import type { Area, Place } from "../wire";
import type { LonLat } from "../wire/beliefFrame";

const SIZE = 360;
const MARGIN = 0.35;
const LEAST_M = 100;

export interface Aim {
  area: Area | null;
  others: readonly Bearing[];
  advised: LonLat | null;
  way: readonly LonLat[];
  ways: readonly Drawn[];
  here: LonLat | null;
  bearing: number | null;
  sigma: number;
  /** What a tap sets. */
  mode: "here" | "direction";
  onHere: (place: Place) => void;
  onDirection: (bearing: number) => void;
}

const ringsOf = (area: Area): LonLat[][] => (area.type === "Polygon" ? area.coordinates : area.coordinates.flat()) as LonLat[][];

interface Frame {
  at: (point: LonLat) => [number, number];
  back: (x: number, y: number) => LonLat;
  /** Diagonal, metres. */
  reach: number;
  middle: LonLat;
  /** Of the picture a metre. */
  scale: number;
}

function frameOf(points: readonly LonLat[]): Frame {
  const [west, south, east, north] = boundsOf(points) ?? [0, 0, 0, 0];
  const middle: LonLat = [(west + east) / 2, (south + north) / 2];
  const [mx, my] = metresPerDegree(middle[1]);
  const side = Math.max((east - west) * mx, (north - south) * my, LEAST_M) * (1 + MARGIN);
  const scale = SIZE / side;
  return {
    at: ([lon, lat]) => [SIZE / 2 + (beside(lon, middle[0]) - middle[0]) * mx * scale, SIZE / 2 - (lat - middle[1]) * my * scale],
    back: (x, y) => [middle[0] + (x - SIZE / 2) / scale / mx, middle[1] - (y - SIZE / 2) / scale / my],
    reach: side * 1.5,
    middle,
    scale,
  };
}

const pathOf = (points: readonly [number, number][]) =>
  points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

const inView = (points: readonly [number, number][]) =>
  [0, 1].every((axis) => points.some((p) => p[axis]! > -SIZE) && points.some((p) => p[axis]! < 2 * SIZE));

/** Of thousands of lines those that can be seen. */
const pathOfWays = ({ lines, area }: Drawn, at: Frame["at"]) =>
  lines
    .map((points) => points.map(at))
    .filter(inView)
    .map((points) => pathOf(points) + (area ? "Z" : ""))
    .join("");

export function AimMap({ area, others, advised, way, ways, here, bearing, sigma, mode, onHere, onDirection }: Aim) {
  const known: LonLat[] = [...(area ? ringsOf(area).flat() : []), ...(here ? [here] : []), ...(advised ? [advised] : [])];
  const frame = frameOf(known);
  const ground = useMemo(
    () =>
      ways.map((one) => (
        <path key={`${one.kind}-${one.area}`} class={`aim-${one.kind}`} data-area={one.area} d={pathOfWays(one, frame.at)} />
      )),
    [ways, frame.middle[0], frame.middle[1], frame.scale],
  );
  const isKnown = known.length > 0;
  const tap = (event: MouseEvent & { currentTarget: SVGSVGElement }) => {
    if (!isKnown) return; // nobody can mean a place on a map of nothing
    const toPicture = event.currentTarget.getScreenCTM()!.inverse(); // a low screen shows the square with ground on both sides
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(toPicture);
    const point = frame.back(x, y);
    if (mode === "here") onHere({ lon: point[0], lat: point[1] });
    else if (here && distanceM(here, point) > 0.5) onDirection(bearingDeg(here, point));
  };
  const ray = (from: LonLat, degrees: number) => pathOf([frame.at(from), frame.at(destination(from, degrees, frame.reach))]);
  return (
    // biome-ignore lint/a11y/useKeyWithClickEvents: place and direction can be typed as well
    <svg
      class="aim-map"
      viewBox={`0 0 ${SIZE} ${SIZE}`}
      role="img"
      aria-label={t("report.map")}
      data-testid="aim-map"
      data-mode={mode}
      aria-busy={!isKnown}
      onClick={tap}
    >
      {area && (
        <path
          class="aim-area"
          d={ringsOf(area)
            .map((ring) => `${pathOf(ring.map(frame.at))}Z`)
            .join("")}
        />
      )}
      {ground}
      {others.map(({ fact, excluded }) => (
        <path
          class={excluded ? "aim-other left-out" : "aim-other"}
          key={fact.bearing_id}
          d={ray([fact.place.lon, fact.place.lat], fact.bearing_deg)}
        />
      ))}
      {way.length > 1 && <path class="aim-way" d={pathOf(way.map(frame.at))} data-testid="aim-way" />}
      {advised && <circle class="aim-advised" cx={frame.at(advised)[0]} cy={frame.at(advised)[1]} r={14} />}
      {here && bearing !== null && (
        <>
          <path
            class="aim-wedge"
            d={`${pathOf([frame.at(here), frame.at(destination(here, bearing - sigma, frame.reach)), frame.at(destination(here, bearing + sigma, frame.reach))])}Z`}
          />
          <path class="aim-own" d={ray(here, bearing)} />
        </>
      )}
      {here && <circle class="aim-here" cx={frame.at(here)[0]} cy={frame.at(here)[1]} r={8} data-testid="aim-here" />}
      <text x={SIZE - 16} y={22} class="aim-north">
        N
      </text>
    </svg>
  );
}
