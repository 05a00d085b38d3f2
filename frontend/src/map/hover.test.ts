import type { Map as GlMap } from "maplibre-gl";
import { expect, it } from "vitest";
import { hover, watchHover } from "./hover";

it("asks of a place on earth where the map goes on across the antimeridian", () => {
  const handlers: Record<string, (event: unknown) => void> = {};
  const map = { on: (kind: string, handler: () => void) => (handlers[kind] = handler), off: () => undefined };
  const stop = watchHover(map as unknown as GlMap, () => null);
  handlers.mousemove!({ lngLat: { lng: 180.25, lat: 50 } });
  expect(hover.value.place).toEqual({ lon: -179.75, lat: 50 });
  stop();
});
