import { signal } from "@preact/signals";

/** Index of the candidate that table and map both point out. */
export const highlighted = signal<number | null>(null);
