// Bearings that a person takes with an antenna in their hand.
import type { components } from "../wire/generated";
import { json, requestEmpty, withBody } from "./api";

export type BearingReport = components["schemas"]["BearingReport"];
export type BearingTaken = components["schemas"]["BearingTaken"];

const path = (missionId: string) => `/missions/${encodeURIComponent(missionId)}/bearings`;

export const reportBearing = (missionId: string, report: BearingReport) => json<BearingTaken>(path(missionId), withBody("POST", report));
export const takeBackBearing = (missionId: string, bearingId: string) =>
  requestEmpty(`${path(missionId)}/${encodeURIComponent(bearingId)}`, { method: "DELETE" });
export const restoreBearing = (missionId: string, bearingId: string) =>
  requestEmpty(`${path(missionId)}/${encodeURIComponent(bearingId)}/restore`, { method: "POST" });
/** by: whose, where there are no accounts. */
export const muteReporter = (missionId: string, by: string | null, muted: boolean) =>
  requestEmpty(`/missions/${encodeURIComponent(missionId)}/reporter`, withBody("PUT", { by, muted }));
