// Nothing shown is silently old: how far a value has aged, and what that means for how it is drawn.

export type Freshness = "fresh" | "old" | "gone";

/** Seconds after which a value is greyed with its age, and after which it is no longer shown as a value. */
export const OLD_AFTER_S = 3;
export const GONE_AFTER_S = 30;

/** Age now, s: how old it was when it was sent plus the time since it arrived. null: never heard. */
export function ageS(sentAgeS: number | null | undefined, receivedMs: number | null, nowMs: number): number | null {
  if (receivedMs === null || sentAgeS === null || sentAgeS === undefined) return null;
  return sentAgeS + Math.max(0, nowMs - receivedMs) / 1000;
}

export function freshness(age: number | null): Freshness {
  if (age === null || age > GONE_AFTER_S) return "gone";
  return age > OLD_AFTER_S ? "old" : "fresh";
}
