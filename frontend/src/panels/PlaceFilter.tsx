// A rectangle drawn over the missions shown: only those whose area it meets are listed.
import { useRef, useState } from "preact/hooks";
import { t } from "../i18n";
import { beside } from "../state/geometry";
import type { MissionSummary } from "../wire";
import type { LonLat } from "../wire/beliefFrame";

const WIDTH = 640;
const HEIGHT = 240;

type Box = [number, number, number, number];

interface Properties {
  around: Box | null;
  missions: readonly MissionSummary[];
  box: string;
  onBox: (box: string) => void;
}

/** Around what is shown with room beside it; it keeps still while a rectangle is chosen. */
function frameOf([west, south, east, north]: Box): Box {
  const [wide, high] = [Math.max(east - west, 0.002), Math.max(north - south, 0.002)];
  return [west - wide / 4, Math.max(-90, south - high / 4), east + wide / 4, Math.min(90, north + high / 4)];
}

export function PlaceFilter({ around, missions, box, onBox }: Properties) {
  const kept = useRef<Box | null>(null);
  const [from, setFrom] = useState<[number, number] | null>(null);
  const [to, setTo] = useState<[number, number] | null>(null);
  if (box === "" && around) kept.current = frameOf(around);
  const frame = kept.current;
  if (!frame) return null;
  const [west, south, east, north] = frame;
  const xy = ([lon, lat]: LonLat): [number, number] => [(WIDTH * (lon - west)) / (east - west), (HEIGHT * (north - lat)) / (north - south)];
  const at = (e: PointerEvent): [number, number] => {
    const size = (e.currentTarget as Element).getBoundingClientRect();
    return [(WIDTH * (e.clientX - size.left)) / size.width, (HEIGHT * (e.clientY - size.top)) / size.height];
  };
  const place = ([x, y]: [number, number]) => [west + (x / WIDTH) * (east - west), north - (y / HEIGHT) * (north - south)] as const;
  const drawn = from && to ? [from, to] : box === "" ? null : chosen(box, xy);
  return (
    <div class="place-filter">
      <p class="muted">{t("missions.filter.place")}</p>
      <svg
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        role="img"
        aria-label={t("missions.filter.place")}
        data-testid="filter-place"
        onPointerDown={(e) => {
          e.currentTarget.setPointerCapture(e.pointerId);
          setFrom(at(e));
          setTo(null);
        }}
        onPointerMove={(e) => from && setTo(at(e))}
        onPointerUp={(e) => {
          if (from) {
            const [a, b] = [place(from), place(at(e))];
            const corners = [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[0], b[0]), Math.max(a[1], b[1])];
            const tapped = Math.hypot(at(e)[0] - from[0], at(e)[1] - from[1]) < 6;
            onBox(tapped ? "" : corners.map((v) => v.toFixed(6)).join(","));
          }
          setFrom(null);
          setTo(null);
        }}
      >
        {missions.flatMap((mission) =>
          (mission.sketch.outline as LonLat[][]).map((ring, i) => (
            <path
              class="mini-area"
              d={`M${ring.map(([lon, lat]) => xy([beside(lon, (west + east) / 2), lat]).join(" ")).join("L")}Z`}
              key={`${mission.mission_id} ${i}`}
            >
              <title>{mission.name}</title>
            </path>
          )),
        )}
        {drawn && (
          <rect
            class="place-box"
            x={Math.min(drawn[0]![0], drawn[1]![0])}
            y={Math.min(drawn[0]![1], drawn[1]![1])}
            width={Math.abs(drawn[1]![0] - drawn[0]![0])}
            height={Math.abs(drawn[1]![1] - drawn[0]![1])}
          />
        )}
      </svg>
    </div>
  );
}

function chosen(box: string, xy: (at: LonLat) => [number, number]): [number, number][] {
  const [w, s, e, n] = box.split(",").map(Number) as Box;
  return [xy([w, n]), xy([e, s])];
}
