import { signal } from "@preact/signals";

export type Language = "en" | "de";

/** For numbers: which mark groups thousands, which one parts the decimals. */
export const locale = signal<Language>("en");
