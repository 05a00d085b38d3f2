// The last minutes of what the instruments said, thinned to one value a second.

export interface Series {
  /** UTC seconds. */
  t: number[];
  powerDb: (number | null)[];
  altitudeM: (number | null)[];
  batteryPercent: (number | null)[];
}

export const emptySeries: Series = { t: [], powerDb: [], altitudeM: [], batteryPercent: [] };

const STEP_S = 1;
const KEPT = 300;

export type Sample = { t: number; powerDb: number | null; altitudeM: number | null; batteryPercent: number | null };

/** A sample within the second of the last one, or before it, changes nothing. */
export function extend(series: Series, sample: Sample): Series {
  const last = series.t.at(-1);
  if (last !== undefined && sample.t < last + STEP_S) return series;
  return {
    t: [...series.t, sample.t].slice(-KEPT),
    powerDb: [...series.powerDb, sample.powerDb].slice(-KEPT),
    altitudeM: [...series.altitudeM, sample.altitudeM].slice(-KEPT),
    batteryPercent: [...series.batteryPercent, sample.batteryPercent].slice(-KEPT),
  };
}
