// The geofence of a QGroundControl .plan file: inclusion polygons and circles as fence, exclusions as no-fly areas.

import { closeRing, type Rings } from "../state/areas";
import { circle } from "../state/geometry";
import type { LonLat } from "../wire/beliefFrame";

export interface PlanFence {
  inclusions: Rings[];
  exclusions: Rings[];
}

export class NotAPlan extends Error {}

interface PlanFile {
  fileType?: string;
  geoFence?: {
    polygons?: { inclusion?: boolean; polygon?: [number, number][] }[];
    circles?: { inclusion?: boolean; circle?: { center?: [number, number]; radius?: number } }[];
  };
}

/** .plan writes latitude first. */
const swap = ([lat, lon]: [number, number]): LonLat => [lon, lat];

export function readPlan(text: string): PlanFence {
  let plan: PlanFile;
  try {
    plan = JSON.parse(text) as PlanFile;
  } catch {
    throw new NotAPlan("it is not JSON");
  }
  if (plan.fileType !== "Plan") throw new NotAPlan('its fileType is not "Plan"');
  const found: PlanFence = { inclusions: [], exclusions: [] };
  for (const { inclusion, polygon } of plan.geoFence?.polygons ?? []) {
    if (!polygon || polygon.length < 3) throw new NotAPlan("one of its fence polygons has fewer than three corners");
    (inclusion === false ? found.exclusions : found.inclusions).push([closeRing(polygon.map(swap))]);
  }
  for (const { inclusion, circle: round } of plan.geoFence?.circles ?? []) {
    if (!round?.center || !(Number(round.radius) > 0)) throw new NotAPlan("one of its fence circles has no centre or radius");
    (inclusion === false ? found.exclusions : found.inclusions).push([circle(swap(round.center), round.radius!, 48)]);
  }
  if (found.inclusions.length + found.exclusions.length === 0) throw new NotAPlan("it holds no fence");
  return found;
}
