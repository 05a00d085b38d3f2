// The sweep by hand: power against heading, the pattern's fit, the bearing with its sigma, other peaks.
import { t } from "../i18n";
import { arcPath, binnedPath, type PolarScale, polarPoint, polarScale, radius } from "../state/polar";
import { formatBearing } from "../units/quantities";

export interface PolarData {
  binnedDb: readonly (number | null)[];
  fittedDb: readonly (number | null)[];
  samples: { headingDeg: number; db: number }[];
  bearing: { deg: number; sigmaDeg: number } | null;
  peaks: { deg: number; weight: number }[];
  rejected: boolean;
  /** What of the circle was turned through; goalDeg: what is meant to be. null: all of it, as ever. */
  sector: { beginDeg: number; turnedDeg: number; goalDeg: number } | null;
}

const RIM = 1.04;

function wedgePath(deg: number, sigma: number): string {
  const [x0, y0] = polarPoint(deg - sigma, 1);
  const [x1, y1] = polarPoint(deg + sigma, 1);
  return `M0 0L${x0} ${y0}A1 1 0 0 1 ${x1} ${y1}Z`;
}

/** Where the levels are written: in the corners, outside the circle, each with a line from its ring. */
const LEVELS_AT = [
  { headingDeg: 45, y: -1.13 },
  { headingDeg: 135, y: 1.19 },
];

function Rings({ scale }: { scale: PolarScale | null }) {
  const middleDb = scale && scale.topDb - Math.round(scale.spanDb / 2);
  const rings = [1, scale ? radius(middleDb!, scale) : 0.56];
  return (
    <g class="polar-rings">
      {rings.map((r) => (
        <circle r={r} key={r} />
      ))}
      <path d="M-1 0H1M0-1V1" />
      {["N", "E", "S", "W"].map((name, i) => {
        const [x, y] = polarPoint(90 * i, 1.16);
        return (
          <text x={x} y={y} key={name}>
            {name}
          </text>
        );
      })}
      {scale &&
        [scale.topDb, middleDb!].map((db, i) => {
          const { headingDeg, y } = LEVELS_AT[i]!;
          return (
            <g class="polar-level" key={y}>
              <path d={`M${polarPoint(headingDeg, rings[i]!).join(" ")}L${polarPoint(headingDeg, 1.42).join(" ")}`} />
              <text x={1.3} y={y}>
                {db.toFixed(0)} dB
              </text>
            </g>
          );
        })}
    </g>
  );
}

export function PolarPlot({ data }: { data: PolarData }) {
  const scale = polarScale([...data.binnedDb, ...data.samples.map((s) => s.db)]);
  const words =
    data.bearing && data.binnedDb.length > 0 ? t("sweep.plot", { bearing: formatBearing(data.bearing.deg) }) : t("sweep.plotEmpty");
  return (
    <svg class="polar" viewBox="-1.3 -1.3 2.6 2.6" role="img" aria-label={words} data-testid="polar">
      <Rings scale={scale} />
      {data.sector && (
        <g class="polar-sector" data-testid="polar-sector">
          <path class="polar-sector-goal" d={arcPath(data.sector.beginDeg, data.sector.goalDeg, RIM)} />
          <path class="polar-sector-turned" d={arcPath(data.sector.beginDeg, data.sector.turnedDeg, RIM)} />
        </g>
      )}
      {data.bearing && <path class="polar-wedge" d={wedgePath(data.bearing.deg, data.bearing.sigmaDeg)} />}
      {scale && data.fittedDb.length > 0 && <path class="polar-fit" d={binnedPath(data.fittedDb, scale)} data-testid="polar-fit" />}
      {scale && data.binnedDb.length > 0 && (
        <path
          class={`polar-power ${data.rejected ? "polar-rejected" : ""}`}
          d={binnedPath(data.binnedDb, scale)}
          data-testid="polar-power"
        />
      )}
      {scale && (
        <path class="polar-samples" d={data.samples.map((s) => `M${polarPoint(s.headingDeg, radius(s.db, scale)).join(" ")}h0`).join("")} />
      )}
      {data.peaks.map((peak) => {
        const [x, y] = polarPoint(peak.deg, 0.35 + 0.65 * Math.min(1, peak.weight));
        return <line class="polar-peak" x1="0" y1="0" x2={x} y2={y} key={peak.deg} />;
      })}
      {data.bearing && (
        <line class="polar-bearing" x1="0" y1="0" x2={polarPoint(data.bearing.deg, 1)[0]} y2={polarPoint(data.bearing.deg, 1)[1]} />
      )}
    </svg>
  );
}
