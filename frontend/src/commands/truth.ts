// Where an emitter was found, told by a tap, by writing, or by the phone that stands there.
import { signal } from "@preact/signals";
import { type TruthWay, tellTruth } from "../sources/libraryApi";
import { liveMission } from "../state/moment";
import type { Place } from "../wire";
import { asProblem, report } from "./send";

/** The next tap on the map tells the place. */
export const tapping = signal(false);

export async function tell(place: Place | null, how: TruthWay, accuracyM: number | null = null): Promise<void> {
  const { missionId: id, emitterId } = liveMission.peek();
  tapping.value = false;
  report("truth", null);
  if (id === null) return;
  try {
    await tellTruth(id, emitterId, place, how, accuracyM);
  } catch (error) {
    report("truth", asProblem(error));
  }
}

/** Asks the device; false: it does not tell, or may not. */
export function tellHere(): Promise<boolean> {
  return new Promise((resolve) => {
    if (!("geolocation" in navigator)) return resolve(false);
    navigator.geolocation.getCurrentPosition(
      ({ coords: { latitude, longitude, accuracy } }) =>
        void tell({ lat: latitude, lon: longitude }, "phone", Math.min(10_000, accuracy)).then(() => resolve(true)),
      () => resolve(false),
      { enableHighAccuracy: true, timeout: 20_000, maximumAge: 5000 },
    );
  });
}
