// The plain grid that stands in for a map: lines every 1, 2 or 5 times a power of ten metres, about 80 pixels apart.
import { metresPerDegree } from "../state/geometry";

const LEAST_PIXELS = 70;
const MOST_LINES = 200;

export function niceStep(metres: number): number {
  const power = 10 ** Math.floor(Math.log10(metres));
  const lead = metres / power;
  return (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10) * power;
}

export interface Box {
  west: number;
  south: number;
  east: number;
  north: number;
}

/** Lines anchored to a fixed point, so that they stay put while the map moves. */
export function gridLines(box: Box, metresPerPixel: number, anchor: [number, number]): { stepM: number; lines: GeoJSON.FeatureCollection } {
  const stepM = niceStep(metresPerPixel * LEAST_PIXELS);
  const [mx, my] = metresPerDegree(anchor[1]);
  const [dx, dy] = [stepM / mx, stepM / my];
  const features: GeoJSON.Feature[] = [];
  const line = (coordinates: [number, number][], major: boolean) =>
    features.push({ type: "Feature", properties: { major }, geometry: { type: "LineString", coordinates } });
  const first = (low: number, origin: number, step: number) => Math.ceil((low - origin) / step);
  const columns = Math.min(MOST_LINES, Math.floor((box.east - box.west) / dx) + 1);
  const rows = Math.min(MOST_LINES, Math.floor((box.north - box.south) / dy) + 1);
  for (let n = 0, i = first(box.west, anchor[0], dx); n < columns; n++, i++) {
    const x = anchor[0] + i * dx;
    line(
      [
        [x, box.south],
        [x, box.north],
      ],
      i % 5 === 0,
    );
  }
  for (let n = 0, i = first(box.south, anchor[1], dy); n < rows; n++, i++) {
    const y = anchor[1] + i * dy;
    line(
      [
        [box.west, y],
        [box.east, y],
      ],
      i % 5 === 0,
    );
  }
  return { stepM, lines: { type: "FeatureCollection", features } };
}
