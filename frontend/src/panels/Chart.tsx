// A value over the last minutes as a line, with the values and the whole minutes along its edges.
import { formatClock, formatNumber } from "../units/quantities";

type Span = readonly [low: number, high: number];

/** At least ten units high, so that a steady value is a steady line and not noise over the whole height. */
export function spread(values: readonly (number | null)[]): Span {
  const known = values.filter((v) => v !== null);
  if (known.length === 0) return [0, 10];
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const more = Math.max(1, (10 - (high - low)) / 2);
  return [low - more, high + more];
}

/** Two to five round values within the span: multiples of 1, 2 or 5 times a power of ten. */
export function ticks([low, high]: Span): number[] {
  const wanted = (high - low) / 4;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const step = power * ([1, 2, 5, 10].find((n) => n * power >= wanted) ?? 10);
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, i) => (first + i) * step);
}

const share = (value: number, [low, high]: Span) => (100 * (value - low)) / Math.max(high - low, 1e-9);

/** An SVG path over 100 x 100, y downwards; what was not heard is a gap. */
export function linePath(t: readonly number[], values: readonly (number | null)[], over: Span, span: Span): string {
  let drawing = false;
  return t
    .map((at, i) => {
      const value = values[i] ?? null;
      const command = drawing ? "L" : "M";
      drawing = value !== null;
      return value === null ? "" : `${command}${share(at, over).toFixed(2)} ${(100 - share(value, span)).toFixed(2)}`;
    })
    .join("");
}

const MINUTE_S = 60;
/** The last whole minutes stand this far from the edge, % of the width, or their time would be cut. */
const EDGE = 6;

export function Chart({ t, values, label }: { t: readonly number[]; values: readonly (number | null)[]; label: string }) {
  const over: Span = [t[0] ?? 0, t.at(-1) ?? 0];
  const span = spread(values);
  const minutes = t
    .filter((at, i) => i > 0 && Math.floor(at / MINUTE_S) > Math.floor(t[i - 1]! / MINUTE_S))
    .map((at) => Math.floor(at / MINUTE_S) * MINUTE_S);
  const heights = ticks(span).map((value) => ({ value, top: 100 - share(value, span) }));
  return (
    <figure class="chart">
      <figcaption>{label}</figcaption>
      <div class="chart-box">
        <svg viewBox="0 0 100 100" preserveAspectRatio="none" role="img" aria-label={label}>
          <path
            class="chart-grid"
            d={heights.map(({ top }) => `M0 ${top}H100`).join("") + minutes.map((at) => `M${share(at, over)} 0V100`).join("")}
          />
          <path class="chart-line" d={linePath(t, values, over, span)} />
        </svg>
        {heights.map(({ value, top }) => (
          <span class="chart-value" style={{ top: `${top}%` }} key={value}>
            {formatNumber(value)}
          </span>
        ))}
        {minutes
          .map((at) => ({ at, left: share(at, over) }))
          .filter(({ left }) => left > EDGE && left < 100 - EDGE)
          .map(({ at, left }) => (
            <span class="chart-time" style={{ left: `${left}%` }} key={at}>
              {formatClock(new Date(at * 1000).toISOString())}
            </span>
          ))}
      </div>
    </figure>
  );
}
