// Missions that the server does not have: their address is wrong, or they were deleted for good.
import { signal } from "@preact/signals";
import type { Route } from "./route";

const gone = signal<ReadonlySet<string>>(new Set());

export const noteGone = (missionId: string): void => {
  gone.value = new Set([...gone.peek(), missionId]);
};

/** The mission that a page shows as it goes; null: it shows none. */
export const followed = (route: Route): string | null =>
  route.page === "mission" || route.page === "area" || route.page === "bearings" ? route.missionId : null;

export const isGone = (missionId: string | null): boolean => missionId !== null && gone.value.has(missionId);
