// A mission as a small map: its area, where bearings were taken, what was found, what is known since.
import { t } from "../i18n";
import { beside, boundsOf } from "../state/geometry";
import type { MissionSummary } from "../wire";
import type { LonLat } from "../wire/beliefFrame";

const WIDTH = 84;
const HEIGHT = 56;
const MARGIN = 6;

export function MiniMap({ sketch }: { sketch: MissionSummary["sketch"] }) {
  const [outline, places] = [sketch.outline as LonLat[][], sketch.places as LonLat[]];
  const found = Object.values(sketch.found) as LonLat[];
  const truth = Object.values(sketch.truth).filter((at) => at !== null) as LonLat[];
  const box = boundsOf([...outline.flat(), ...places]);
  if (!box) return null;
  const [west, south, east, north] = box;
  const squeeze = Math.cos((south * Math.PI) / 180);
  const [across, up] = [Math.max((east - west) * squeeze, 1e-5), Math.max(north - south, 1e-5)];
  const scale = Math.min((WIDTH - 2 * MARGIN) / across, (HEIGHT - 2 * MARGIN) / up);
  const [left, top] = [(WIDTH - across * scale) / 2, (HEIGHT - up * scale) / 2];
  const at = ([lon, lat]: LonLat): [number, number] => [left + (beside(lon, west) - west) * squeeze * scale, top + (north - lat) * scale];
  return (
    <svg class="mini-map" viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={t("missions.map")} data-testid="mini-map">
      {outline.map((ring, i) => (
        <path
          class="mini-area"
          d={`M${ring
            .map((p) =>
              at(p)
                .map((v) => v.toFixed(1))
                .join(" "),
            )
            .join("L")}Z`}
          key={i}
        />
      ))}
      {places.map((place, i) => (
        <circle class="mini-place" cx={at(place)[0]} cy={at(place)[1]} r="1.6" key={i} />
      ))}
      {found.map((place, i) => (
        <circle class="mini-found" cx={at(place)[0]} cy={at(place)[1]} r="3.2" key={i} />
      ))}
      {truth.map((place, i) => (
        <circle class="mini-truth" cx={at(place)[0]} cy={at(place)[1]} r="3.6" key={i} />
      ))}
    </svg>
  );
}
