// At most one sheet lies over the page.
import { signal } from "@preact/signals";

export type Overlay = "alerts" | "control" | "menu" | "settings" | "keys" | "tour" | "instruments";

export const overlay = signal<Overlay | null>(null);

export function toggle(which: Overlay): void {
  overlay.value = overlay.peek() === which ? null : which;
}
