// A mission's course over time, and its variants kept by name.
import type { components } from "../wire/generated";
import { json, requestEmpty, withBody } from "./api";

type Schemas = components["schemas"];
export type MissionCourses = Schemas["MissionCourses"];
export type Course = Schemas["Course"];
export type CoursePoint = Schemas["CoursePoint"];
/** What is not named is as it was flown. */
export type Supposition = Partial<Schemas["Supposition"]>;

const variant = (id: string, name: string) => `/missions/${encodeURIComponent(id)}/variants/${encodeURIComponent(name)}`;

/** emitter: by id; none: the first. */
export const courses = (id: string, emitter?: string) =>
  json<MissionCourses>(
    `/missions/${encodeURIComponent(id)}/courses${emitter === undefined ? "" : `?emitter=${encodeURIComponent(emitter)}`}`,
  );
export const keepVariant = (id: string, name: string, wanted: Supposition) => requestEmpty(variant(id, name), withBody("PUT", wanted));
export const dropVariant = (id: string, name: string) => requestEmpty(variant(id, name), { method: "DELETE" });
