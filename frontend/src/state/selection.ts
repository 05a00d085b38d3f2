// Which craft and which emitter the panels and the map show; null: the first.
import { signal } from "@preact/signals";

export const selectedCraft = signal<string | null>(null);
export const selectedEmitter = signal<string | null>(null);
