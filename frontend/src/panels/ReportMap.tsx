// The map of the report: drawn as lines, so that it prints sharp, needs no graphics card and no map package.
import { t } from "../i18n";
import { polygonsOf } from "../state/areas";
import { beside, boundsOf, destination, distanceM, lonLat } from "../state/geometry";
import { settings } from "../state/settings";
import type { MissionView } from "../state/view";
import { formatLength } from "../units/quantities";
import type { Area } from "../wire";
import type { LonLat } from "../wire/beliefFrame";

const WIDTH = 840;
const HEIGHT = 420;
const MARGIN = 24;
const STEPS_M = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000];

export function ReportMap({ view }: { view: MissionView }) {
  const { spec, bearings, belief, truth } = view;
  if (!spec) return null;
  const rings = polygonsOf(spec.area as Area).flat();
  const places = bearings.map((b) => lonLat(b.fact.place));
  const known = truth?.fact.place;
  const estimate = belief && belief.fact.bearings > 0 ? belief.fact.estimate : null;
  const box = boundsOf([...rings.flat(), ...places, ...(known ? [lonLat(known)] : [])]);
  if (!box) return null;
  const [west, south, east, north] = box;
  const squeeze = Math.cos((south * Math.PI) / 180);
  const scale = Math.min((WIDTH - 2 * MARGIN) / ((east - west) * squeeze), (HEIGHT - 2 * MARGIN) / (north - south));
  const left = (WIDTH - (east - west) * squeeze * scale) / 2;
  const top = (HEIGHT - (north - south) * scale) / 2;
  const at = ([lon, lat]: LonLat) => [left + (beside(lon, west) - west) * squeeze * scale, top + (north - lat) * scale] as const;
  const path = (ring: readonly LonLat[]) =>
    `M${ring
      .map((p) =>
        at(p)
          .map((v) => v.toFixed(1))
          .join(" "),
      )
      .join("L")}`;
  const reach = distanceM([west, south], [east, north]);
  const metre = (at([west, north])[1] - at([west, south])[1]) / -distanceM([west, south], [west, north]);
  const step = STEPS_M.findLast((s) => s * metre < WIDTH / 4) ?? STEPS_M[0]!;
  return (
    <svg class="report-map" viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={t("report.picture")} data-testid="report-map">
      {rings.map((ring, i) => (
        <path class="report-area" d={`${path(ring)}Z`} key={i} />
      ))}
      {estimate &&
        polygonsOf(estimate.c95 as Area)
          .flat()
          .map((ring, i) => <path class="report-region" d={`${path(ring)}Z`} key={i} />)}
      {bearings
        .filter((b) => !b.excluded)
        .map(({ fact }) => (
          <path
            class="report-line"
            d={path([lonLat(fact.place), destination(lonLat(fact.place), fact.bearing_deg, reach)])}
            key={fact.bearing_id}
          />
        ))}
      {bearings.map(({ fact }) => {
        const [x, y] = at(lonLat(fact.place));
        const below = y < 2 * MARGIN; // there is no room above it for the large letters of a phone
        return (
          <g key={fact.bearing_id}>
            <circle class="mini-place" cx={x} cy={y} r="4" />
            <text x={x + 7} y={below ? y + 7 : y - 7} font-size="13" dominant-baseline={below ? "hanging" : "auto"}>
              {fact.source.kind === "person" ? fact.source.name : fact.place_number}
            </text>
          </g>
        );
      })}
      {estimate && <circle class="mini-found" cx={at(lonLat(estimate))[0]} cy={at(lonLat(estimate))[1]} r="6" />}
      {known && <circle class="mini-truth" cx={at(lonLat(known))[0]} cy={at(lonLat(known))[1]} r="9" />}
      <path class="report-line" d={`M${MARGIN} ${HEIGHT - 14}h${step * metre}`} />
      <text x={MARGIN} y={HEIGHT - 20} font-size="12">
        {formatLength(step, settings.value.units)}
      </text>
      <text x={WIDTH - MARGIN} y={14} font-size="13" text-anchor="end" dominant-baseline="hanging">
        {t("report.north")}
      </text>
    </svg>
  );
}
