// The library: labels, deletion, the ground truth of an emitter, and what checked missions say together.
import type { Place } from "../wire";
import type { components } from "../wire/generated";
import { json, requestEmpty, withBody } from "./api";

type Schemas = components["schemas"];
export type Calibration = Schemas["Calibration"];
export type Suggested = NonNullable<Calibration["suggested"]>;
export type TruthWay = Schemas["TruthNoted"]["how"];

const path = (id: string) => `/missions/${encodeURIComponent(id)}`;

export interface Labels {
  name: string;
  tags: string[];
  notes: string;
}

export const label = (id: string, labels: Labels) => json<unknown>(`${path(id)}/labels`, withBody("PUT", labels));
export const remove = (id: string) => requestEmpty(path(id), { method: "DELETE" });
export const restore = (id: string) => json<unknown>(`${path(id)}/restore`, { method: "POST" });

/** place null: looked for and not found. */
export const tellTruth = (id: string, emitterId: string | null, place: Place | null, how: TruthWay, accuracyM: number | null) =>
  json<unknown>(`${path(id)}/truth`, withBody("PUT", { emitter_id: emitterId, place, accuracy_m: accuracyM, how }));

/** craft, antenna: "" for any. */
export const calibration = (craft: string, antenna: string) => json<Calibration>(`/calibration?${new URLSearchParams({ craft, antenna })}`);
