// Where bearings were right and where they were outliers: the places they were taken at, to scale, without a map below.
import { t } from "../i18n";
import type { Calibration } from "../sources/libraryApi";
import { beside, boundsOf, lonLat } from "../state/geometry";
import { formatNumber } from "../units/quantities";

const WIDTH = 320;
const HEIGHT = 160;
const MARGIN = 10;

export function ErrorMap({ bearings }: { bearings: Calibration["bearings"] }) {
  const [west, south, east, north] = boundsOf(bearings.map((b) => lonLat(b.place)))!;
  const squeeze = Math.cos((south * Math.PI) / 180);
  const span = Math.max((east - west) * squeeze, (north - south) * ((WIDTH - 2 * MARGIN) / (HEIGHT - 2 * MARGIN)), 1e-4);
  const scale = (WIDTH - 2 * MARGIN) / span;
  const at = (lat: number, lon: number) =>
    [MARGIN + (beside(lon, (west + east) / 2) - west) * squeeze * scale, HEIGHT - MARGIN - (lat - south) * scale] as const;
  const outliers = bearings.filter((b) => b.outlier).length;
  return (
    <figure class="error-map">
      <figcaption>{t("calibration.map", { outliers, bearings: bearings.length })}</figcaption>
      <svg viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={t("calibration.map", { outliers, bearings: bearings.length })}>
        {bearings.map((b, i) => {
          const [x, y] = at(b.place.lat, b.place.lon);
          const title = `${formatNumber(b.error_deg, 0)}°`;
          return b.outlier ? (
            <path class="error-outlier" d={`M${x - 4} ${y - 4}l8 8m0 -8l-8 8`} key={i}>
              <title>{title}</title>
            </path>
          ) : (
            <circle class="error-right" cx={x} cy={y} r="2.5" key={i}>
              <title>{title}</title>
            </circle>
          );
        })}
      </svg>
    </figure>
  );
}
