// Where this device is, from the moment it is asked.
import { useEffect, useState } from "preact/hooks";
import type { LonLat } from "../wire/beliefFrame";

export function useGps(onPlace: (at: LonLat) => void) {
  // silent: it does not know just now, and is still asked
  const [state, setState] = useState<"off" | "asking" | "on" | "silent" | "denied">("off");
  const [accuracy, setAccuracy] = useState<number | null>(null);
  const asked = state !== "off" && state !== "denied";
  useEffect(() => {
    if (!asked) return;
    const watch = navigator.geolocation?.watchPosition(
      ({ coords }) => {
        setState("on");
        setAccuracy(coords.accuracy);
        onPlace([coords.longitude, coords.latitude]);
      },
      ({ code, PERMISSION_DENIED }) => setState(code === PERMISSION_DENIED ? "denied" : "silent"),
      { enableHighAccuracy: true, maximumAge: 2000 },
    );
    if (watch === undefined) setState("denied");
    return () => {
      if (watch !== undefined) navigator.geolocation.clearWatch(watch);
    };
  }, [asked]);
  return { state, accuracy, start: () => setState("asking"), stop: () => setState("off") };
}
