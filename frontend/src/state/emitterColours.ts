// Eight colours that people tell apart who do not tell red from green (P. Tol, "Muted", without its rose: red is for
// alerts). Each stands with the emitter's number, since a ninth emitter has the first one's colour again.

const COLOURS = ["#332288", "#117733", "#88ccee", "#aa4499", "#999933", "#44aa99", "#882255", "#ddcc77"] as const;
const DARK_INK: ReadonlySet<string> = new Set(["#88ccee", "#999933", "#44aa99", "#ddcc77"]);

export interface EmitterColour {
  fill: string;
  /** Readable on it. */
  ink: string;
}

export function emitterColour(index: number): EmitterColour {
  const fill = COLOURS[index % COLOURS.length]!;
  return { fill, ink: DARK_INK.has(fill) ? "#000000" : "#ffffff" };
}
