// Where somebody on foot or in a car listens next.
import type { Place } from "../wire";
import type { components } from "../wire/generated";
import { json, withBody } from "./api";

export type Advice = components["schemas"]["AdviceAnswer"];

export const askAdvice = (missionId: string, place: Place, speedMS: number, emitterId: string | null, hops: boolean, onRoads: boolean) =>
  json<Advice>(
    `/missions/${encodeURIComponent(missionId)}/advice`,
    withBody("POST", { place, speed_m_s: speedMS, emitter_id: emitterId, hops, on_roads: onRoads }),
  );
