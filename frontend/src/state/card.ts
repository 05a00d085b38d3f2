// What a phone shows under its map: one card of the flight page at a time.
import { signal } from "@preact/signals";

export type Card = "checks" | "estimate" | "sweep" | "plan" | "truth" | "events";

/** The one chosen; where it is not there, the first one is shown. */
export const chosenCard = signal<Card>("estimate");

/** The card that holds what is rarely needed, files among it. */
export const drawersCard = (phase: string): Card => (phase === "draft" || phase === "ready" ? "checks" : "truth");
