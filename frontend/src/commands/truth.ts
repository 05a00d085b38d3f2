// Where an emitter was found, told by a tap, by writing, or by the phone that stands there.
import { effect, signal } from "@preact/signals";
import { type TruthWay, tellTruth } from "../sources/libraryApi";
import { source } from "../state/connection";
import { liveMission } from "../state/moment";
import type { Place } from "../wire";
import { asProblem, report } from "./send";

/** The next tap on the map tells the place, in this mission. */
export const tapping = signal(false);
effect(() => {
  void source.value;
  tapping.value = false;
});

/** False: it was not taken, and why stands at the card. */
export async function tell(
  place: Place | null,
  how: TruthWay,
  accuracyM: number | null = null,
  { missionId: id, emitterId } = liveMission.peek(),
): Promise<boolean> {
  tapping.value = false;
  report("truth", null);
  if (id === null) return false;
  try {
    await tellTruth(id, emitterId, place, how, accuracyM);
    return true;
  } catch (error) {
    if (liveMission.peek().missionId === id) report("truth", asProblem(error));
    return false;
  }
}

/** Asks the device; false: it does not tell, or may not. */
export function tellHere(): Promise<boolean> {
  const about = liveMission.peek();
  return new Promise((resolve) => {
    if (!("geolocation" in navigator)) return resolve(false);
    navigator.geolocation.getCurrentPosition(
      ({ coords: { latitude, longitude, accuracy } }) =>
        void tell({ lat: latitude, lon: longitude }, "phone", Math.min(10_000, accuracy), about).then(() => resolve(true)),
      () => resolve(false),
      { enableHighAccuracy: true, timeout: 20_000, maximumAge: 5000 },
    );
  });
}
