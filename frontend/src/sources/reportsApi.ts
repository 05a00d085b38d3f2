// Bearings that a person takes with an antenna in their hand.
import type { components } from "../wire/generated";
import { json, requestEmpty, withBody } from "./api";

export type BearingReport = components["schemas"]["BearingReport"];
export type BearingTaken = components["schemas"]["BearingTaken"];

const path = (missionId: string) => `/missions/${encodeURIComponent(missionId)}/bearings`;

export const reportBearing = (missionId: string, report: BearingReport) => json<BearingTaken>(path(missionId), withBody("POST", report));
export const takeBackBearing = (missionId: string, bearingId: string) =>
  requestEmpty(`${path(missionId)}/${encodeURIComponent(bearingId)}`, { method: "DELETE" });
