// The vehicle on a map: where it is, where its nose points, dimmed when that is old.
import { effect } from "@preact/signals";
import { type Map as GlMap, Marker } from "maplibre-gl";
import { OLD_AFTER_S } from "../state/age";
import { nowMs } from "../state/clock";
import { telemetry } from "../state/heard";
import { cursor } from "../state/moment";
import { vehicle } from "../state/vehicle";

function vehicleElement(): HTMLElement {
  const element = document.createElement("div");
  element.className = "vehicle";
  element.dataset.testid = "vehicle";
  element.innerHTML = '<svg viewBox="-16 -16 32 32" width="36" height="36" aria-hidden="true"><path d="M0 -14 L9 11 L0 6 L-9 11 Z"/></svg>';
  return element;
}

/** Until what is returned is called. */
export function showVehicle(map: GlMap): () => void {
  const marker = new Marker({ element: vehicleElement(), rotationAlignment: "map" });
  let shown = false;
  const stops = [
    effect(() => {
      const { at, headingDeg } = vehicle.value;
      if (!at) {
        marker.remove();
        shown = false;
        return;
      }
      marker.setLngLat(at).setRotation(headingDeg ?? 0);
      if (!shown) marker.addTo(map);
      shown = true;
    }),
    effect(() => {
      const received = telemetry.peek();
      const age = cursor.value !== null || !received ? 0 : (nowMs.value - received.atMs) / 1000 + (received.value.position_age_s ?? 0);
      marker.getElement().classList.toggle("old", age > OLD_AFTER_S);
    }),
  ];
  return () => {
    for (const stop of stops) stop();
    marker.remove();
  };
}
