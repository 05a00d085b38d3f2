// At most one sheet lies over the page.
import { signal } from "@preact/signals";

export type Overlay = "alerts" | "control" | "menu" | "settings" | "keys" | "tour" | "instruments";

export const overlay = signal<Overlay | null>(null);

/** A sheet belongs to the page it was opened on; the tour leads from page to page. */
addEventListener("hashchange", () => {
  if (overlay.peek() !== "tour") overlay.value = null;
});

export function toggle(which: Overlay): void {
  overlay.value = overlay.peek() === which ? null : which;
}
