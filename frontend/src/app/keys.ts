// Keys: '?' shows the sheet. Flight commands are chords, so that no single stray key flies anything.
import { landingArmed } from "../commands/landing";
import { sendUrgent, type Urgent } from "../commands/urgent";
import { flying } from "../state/flying";
import { look } from "../state/moment";
import { overlay, toggle } from "../state/overlay";
import { change, settings } from "../state/settings";

const CHORDS: Record<string, Urgent> = { KeyA: "abort", KeyH: "hold", KeyR: "return", KeyL: "land" };

const typing = (target: EventTarget | null) =>
  target instanceof HTMLElement && (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName));

function onKeyDown(event: KeyboardEvent): void {
  const chord = event.altKey && event.shiftKey && !event.ctrlKey ? CHORDS[event.code] : undefined;
  if (event.repeat) {
    // a key that is kept down orders once; Enter would press its button again and again
    if (chord || (event.key === "Enter" && !typing(event.target))) event.preventDefault();
    return;
  }
  if (chord) {
    event.preventDefault();
    const target = flying.peek();
    if (target && chord === "land") landingArmed.value = true;
    else if (target) void sendUrgent(target, chord);
    return;
  }
  if (event.key === "Escape") {
    overlay.value = null;
    return;
  }
  if (event.ctrlKey || event.altKey || event.metaKey || typing(event.target)) return;
  if (event.key === "?") toggle("keys");
  else if (event.key === "a") toggle("alerts");
  else if (event.key === "l") look(null);
  else if (event.key === "m") change("tones", !settings.peek().tones);
  else if (event.key === "g") location.hash = "#/";
}

export function watchKeys(): void {
  addEventListener("keydown", onKeyDown);
}
