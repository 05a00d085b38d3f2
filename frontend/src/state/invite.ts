// How many others the first admin lets in right after their own account is made: their invitations are shown next.
import { signal } from "@preact/signals";

export const COUNTS = [1, 2, 3, 4, 6, 8] as const;

export const phonesNext = signal(0);
