// The mission that was asked for and that the server does not have: its address is wrong, or it was deleted for good.
import { signal } from "@preact/signals";
import type { Route } from "./route";

const gone = signal<string | null>(null);

/** null: another one is looked at; that one is asked for again the next time. */
export const noteGone = (missionId: string | null): void => {
  gone.value = missionId;
};

/** The mission that a page shows as it goes; null: it shows none. */
export const followed = (route: Route): string | null =>
  route.page === "mission" || route.page === "area" || route.page === "bearings" ? route.missionId : null;

export const isGone = (missionId: string | null): boolean => missionId !== null && missionId === gone.value;
