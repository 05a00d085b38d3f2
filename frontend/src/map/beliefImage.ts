// The belief as a picture: cividis (safe for colour-blind eyes), fading to nothing where nothing is.
import { together } from "../state/geometry";
import type { BeliefFrame, LonLat } from "../wire/beliefFrame";

/** Every sixteenth colour of cividis (Nunez, Anderton, Renslow 2018), linear in between. */
const CIVIDIS: readonly (readonly [number, number, number])[] = [
  [0, 34, 78],
  [0, 46, 106],
  [26, 56, 111],
  [50, 67, 109],
  [67, 78, 108],
  [83, 90, 109],
  [97, 101, 111],
  [111, 112, 115],
  [125, 124, 120],
  [140, 136, 120],
  [155, 148, 118],
  [171, 160, 114],
  [188, 174, 108],
  [205, 187, 99],
  [222, 201, 88],
  [240, 216, 70],
  [254, 232, 56],
];

export function cividis(share: number): [number, number, number] {
  const position = Math.min(1, Math.max(0, share)) * (CIVIDIS.length - 1);
  const i = Math.min(CIVIDIS.length - 2, Math.floor(position));
  const f = position - i;
  const [a, b] = [CIVIDIS[i]!, CIVIDIS[i + 1]!];
  return [a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]), a[2] + f * (b[2] - a[2])];
}

/** Alpha of a probability relative to the peak: 0 at 0, a tenth already well visible. */
export const opacity = (share: number): number => Math.min(1, 2.2 * Math.max(0, share) ** 0.8) * 0.85;

/** The likeliest cell counts as full only when it stands out: 6 times the grid's mean. */
const STANDS_OUT = 6;

/** Factor from `cells` (relative to the peak) to the share that is coloured: about a sixth everywhere when nothing is known. */
export function contrast(cells: Float32Array): number {
  let sum = 0;
  for (let i = 0; i < cells.length; i++) sum += cells[i]!;
  return 1 / Math.max(1, (STANDS_OUT * sum) / cells.length);
}

const LEVELS = 1024;

/** RGBA by the square root of the share: what is faint has the finer steps. */
const COLOURS = Uint8ClampedArray.from({ length: 4 * LEVELS }, (_, i) => {
  const root = Math.floor(i / 4) / (LEVELS - 1);
  return [...cividis(root), 255 * opacity(root * root)][i % 4]!;
});

/** RGBA bytes, row 0 in the north (as pictures are); cells come from the south. */
export function beliefPixels({ nx, ny, cells }: Pick<BeliefFrame, "nx" | "ny" | "cells">): Uint8ClampedArray<ArrayBuffer> {
  const picture = new Uint8ClampedArray(4 * nx * ny);
  const pixels = new Uint32Array(picture.buffer);
  const colours = new Uint32Array(COLOURS.buffer);
  const factor = contrast(cells);
  for (let row = 0; row < ny; row++) {
    for (let column = 0; column < nx; column++) {
      const share = factor * cells[(ny - 1 - row) * nx + column]!;
      if (!(share > 0)) continue;
      pixels[row * nx + column] = colours[Math.min(LEVELS - 1, Math.ceil(Math.sqrt(share) * (LEVELS - 1)))]!;
    }
  }
  return picture;
}

/** NW, NE, SE, SW: the order in which MapLibre wants an image's corners. In one piece across the antimeridian; MapLibre
 * takes only images whose middle is within -180 to 180 degrees. */
export function imageCorners({ bounds }: Pick<BeliefFrame, "bounds">): [LonLat, LonLat, LonLat, LonLat] {
  const [sw, se, ne, nw] = together(bounds) as BeliefFrame["bounds"];
  const turns = Math.floor((sw[0] + ne[0] + 360) / 720);
  const back = ([lon, lat]: LonLat): LonLat => [lon - 360 * turns, lat];
  return [back(nw), back(ne), back(se), back(sw)];
}
