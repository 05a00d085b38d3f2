// Received power against heading as points in a unit circle: north up, clockwise, loud outside.

export interface PolarScale {
  topDb: number;
  spanDb: number;
}

const LEAST_SPAN_DB = 12;
const INNER = 0.12;

/** Outer rim: the loudest value; centre region: the quietest, but never less than 12 dB below. null: nothing heard. */
export function polarScale(values: readonly (number | null)[]): PolarScale | null {
  const heard = values.filter((v): v is number => v !== null && Number.isFinite(v));
  if (heard.length === 0) return null;
  const top = Math.max(...heard);
  return { topDb: top, spanDb: Math.max(LEAST_SPAN_DB, top - Math.min(...heard)) };
}

export function radius(db: number, scale: PolarScale): number {
  const share = 1 - (scale.topDb - db) / scale.spanDb;
  return INNER + (1 - INNER) * Math.min(1, Math.max(0, share));
}

/** x to the right, y down (as in SVG), heading 0 up. */
export function polarPoint(headingDeg: number, r: number): [number, number] {
  const a = (headingDeg * Math.PI) / 180;
  return [r * Math.sin(a), -r * Math.cos(a)];
}

/** An arc on the circle of radius r, clockwise from `beginDeg`; a whole circle for 360 degrees or more. */
export function arcPath(beginDeg: number, widthDeg: number, r: number): string {
  const [x0, y0] = polarPoint(beginDeg, r);
  if (widthDeg >= 359.5) return `M${x0} ${y0}A${r} ${r} 0 1 1 ${-x0} ${-y0}A${r} ${r} 0 1 1 ${x0} ${y0}`;
  const [x1, y1] = polarPoint(beginDeg + widthDeg, r);
  return `M${x0} ${y0}A${r} ${r} 0 ${widthDeg > 180 ? 1 : 0} 1 ${x1} ${y1}`;
}

/**
 * One path over the bins (bin i covers headings i * 360/n .. (i+1) * 360/n); bins where nothing was heard are gaps. One
 * heard alone, as of a pulsed tag, is a line without length: a dot under round caps.
 */
export function binnedPath(binned: readonly (number | null)[], scale: PolarScale): string {
  const width = 360 / binned.length;
  const closed = binned.every((v) => v !== null);
  let drawing = false;
  let out = "";
  binned.forEach((db, i) => {
    if (db === null) {
      drawing = false;
      return;
    }
    const [x, y] = polarPoint((i + 0.5) * width, radius(db, scale));
    const alone = binned.at(i - 1) === null && binned[(i + 1) % binned.length] === null;
    out += `${drawing ? "L" : "M"}${x.toFixed(4)} ${y.toFixed(4)}${alone ? "h0" : ""}`;
    drawing = true;
  });
  return closed && out ? `${out}Z` : out;
}
