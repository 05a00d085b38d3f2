// Where the top of the phone points, degrees clockwise from magnetic north; null while it does not say.
import { signal } from "@preact/signals";

export type CompassState = "off" | "asking" | "on" | "none" | "insecure" | "denied";

export const compassState = signal<CompassState>("off");
export const magneticDeg = signal<number | null>(null);

interface Orientation extends Event {
  absolute?: boolean;
  alpha?: number | null;
  /** Safari's own: clockwise from magnetic north. */
  webkitCompassHeading?: number;
}

/** null: the event says nothing of north. */
export function headingOf(event: Pick<Orientation, "absolute" | "alpha" | "webkitCompassHeading">, screenDeg: number): number | null {
  const { webkitCompassHeading: said, alpha } = event;
  if (typeof said === "number") return (said + screenDeg + 360) % 360;
  // alpha counts the other way round
  if (event.absolute && typeof alpha === "number") return (360 - alpha + screenDeg + 360) % 360;
  return null;
}

const SILENCE_MS = 3000;
let listening = false;

function hear(event: Event): void {
  const heading = headingOf(event as Orientation, screen.orientation?.angle ?? 0);
  if (heading === null) return;
  magneticDeg.value = heading;
  compassState.value = "on";
}

/** From a tap: some browsers ask the person first, and none tells it to a page without TLS. */
export async function startCompass(): Promise<void> {
  if (!isSecureContext) {
    compassState.value = "insecure";
    return;
  }
  compassState.value = "asking";
  const ask = (globalThis.DeviceOrientationEvent as unknown as { requestPermission?: () => Promise<string> } | undefined)
    ?.requestPermission;
  if (ask && (await ask().catch(() => "denied")) !== "granted") {
    compassState.value = "denied";
    return;
  }
  if (!listening) {
    listening = true;
    addEventListener("deviceorientationabsolute", hear);
    addEventListener("deviceorientation", hear);
  }
  setTimeout(() => {
    if (compassState.peek() === "asking") compassState.value = "none";
  }, SILENCE_MS);
}

export function stopCompass(): void {
  listening = false;
  removeEventListener("deviceorientationabsolute", hear);
  removeEventListener("deviceorientation", hear);
  magneticDeg.value = null;
  compassState.value = "off";
}
