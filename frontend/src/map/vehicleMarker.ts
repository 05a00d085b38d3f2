// The vehicle on a map: where it is, where its nose points, dimmed when that is old.
import { effect } from "@preact/signals";
import { Marker, type Map as GlMap } from "maplibre-gl";
import { cursor, live, nowMs, vehicle } from "../app/store";
import { OLD_AFTER_S } from "../state/age";

function vehicleElement(): HTMLElement {
  const element = document.createElement("div");
  element.className = "vehicle";
  element.dataset["testid"] = "vehicle";
  element.innerHTML =
    '<svg viewBox="-16 -16 32 32" width="36" height="36" aria-hidden="true"><path d="M0 -14 L9 11 L0 6 L-9 11 Z"/></svg>';
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
      const received = live.peek().telemetry;
      const age = cursor.value !== null || !received ? 0 : (nowMs.value - received.atMs) / 1000 + (received.value.position_age_s ?? 0);
      marker.getElement().classList.toggle("old", age > OLD_AFTER_S);
    }),
  ];
  return () => {
    stops.forEach((stop) => stop());
    marker.remove();
  };
}
