// The geofence of a QGroundControl .plan file: inclusion polygons and circles as fence, exclusions as no-fly areas.

import type { MessageKey } from "../i18n";
import { closeRing, type Rings } from "../state/areas";
import { circle } from "../state/geometry";
import type { LonLat } from "../wire/beliefFrame";

export interface PlanFence {
  inclusions: Rings[];
  exclusions: Rings[];
}

const MOST_RADIUS_M = 100_000;

/** flaw: what is wrong with the file, in the page's words. */
export class NotAPlan extends Error {
  constructor(readonly flaw: Extract<MessageKey, `edit.plan.${string}`>) {
    super(flaw);
  }
}

/** As far as it is what it should be. */
interface PlanFile {
  fileType?: unknown;
  geoFence?: { polygons?: unknown; circles?: unknown } | null;
}
type Polygon = { inclusion?: unknown; polygon?: unknown } | null;
type Circle = { inclusion?: unknown; circle?: { center?: unknown; radius?: unknown } | null } | null;

const listOf = <T>(value: unknown): T[] => (Array.isArray(value) ? (value as T[]) : []);

const isWithin = (value: unknown, most: number): value is number => typeof value === "number" && Math.abs(value) <= most;

/** .plan writes latitude first. */
function placeOf(value: unknown): LonLat {
  const [lat, lon] = listOf<unknown>(value);
  if (!isWithin(lat, 90) || !isWithin(lon, 180)) throw new NotAPlan("edit.plan.noPlace");
  return [lon, lat];
}

export function readPlan(text: string): PlanFence {
  let plan: PlanFile | null;
  try {
    plan = JSON.parse(text) as PlanFile | null;
  } catch {
    throw new NotAPlan("edit.plan.notJson");
  }
  if (plan?.fileType !== "Plan") throw new NotAPlan("edit.plan.otherFile");
  const found: PlanFence = { inclusions: [], exclusions: [] };
  const put = (inclusion: unknown, ring: LonLat[]) => (inclusion === false ? found.exclusions : found.inclusions).push([closeRing(ring)]);
  for (const polygon of listOf<Polygon>(plan.geoFence?.polygons)) {
    const corners = listOf<unknown>(polygon?.polygon);
    if (corners.length < 3) throw new NotAPlan("edit.plan.tooFewCorners");
    put(polygon?.inclusion, corners.map(placeOf));
  }
  for (const round of listOf<Circle>(plan.geoFence?.circles)) {
    const { center, radius } = round?.circle ?? {};
    if (!center || !isWithin(radius, MOST_RADIUS_M) || radius <= 0) throw new NotAPlan("edit.plan.noCircle");
    put(round?.inclusion, circle(placeOf(center), radius, 48));
  }
  if (found.inclusions.length + found.exclusions.length === 0) throw new NotAPlan("edit.plan.noFence");
  return found;
}
