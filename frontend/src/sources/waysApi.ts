// Roads, paths and barriers of a mission, as they were uploaded and cut to its search.
import type { components } from "../wire/generated";
import { json, requestEmpty } from "./api";

export type MissionWays = components["schemas"]["MissionWays"];

export const waysPath = (missionId: string) => `/missions/${encodeURIComponent(missionId)}/ways`;
export const missionWays = (missionId: string) => json<MissionWays>(waysPath(missionId));
export const forgetWays = (missionId: string) => requestEmpty(waysPath(missionId), { method: "DELETE" });
