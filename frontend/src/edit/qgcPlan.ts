// The geofence of a QGroundControl .plan file: inclusion polygons and circles as fence, exclusions as no-fly areas.

import type { MessageKey } from "../i18n";
import { closeRing, type Rings } from "../state/areas";
import { circle } from "../state/geometry";
import type { LonLat } from "../wire/beliefFrame";

export interface PlanFence {
  inclusions: Rings[];
  exclusions: Rings[];
}

/** flaw: what is wrong with the file, in the page's words. */
export class NotAPlan extends Error {
  constructor(readonly flaw: Extract<MessageKey, `edit.plan.${string}`>) {
    super(flaw);
  }
}

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
  let plan: PlanFile | null;
  try {
    plan = JSON.parse(text) as PlanFile | null;
  } catch {
    throw new NotAPlan("edit.plan.notJson");
  }
  if (plan?.fileType !== "Plan") throw new NotAPlan("edit.plan.otherFile");
  const found: PlanFence = { inclusions: [], exclusions: [] };
  for (const { inclusion, polygon } of plan.geoFence?.polygons ?? []) {
    if (!polygon || polygon.length < 3) throw new NotAPlan("edit.plan.tooFewCorners");
    (inclusion === false ? found.exclusions : found.inclusions).push([closeRing(polygon.map(swap))]);
  }
  for (const { inclusion, circle: round } of plan.geoFence?.circles ?? []) {
    if (!round?.center || !(Number(round.radius) > 0)) throw new NotAPlan("edit.plan.noCircle");
    (inclusion === false ? found.exclusions : found.inclusions).push([circle(swap(round.center), round.radius!, 48)]);
  }
  if (found.inclusions.length + found.exclusions.length === 0) throw new NotAPlan("edit.plan.noFence");
  return found;
}
