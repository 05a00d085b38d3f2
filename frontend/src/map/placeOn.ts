import { beside } from "../state/geometry";
import type { Place } from "../wire";

/** A place of a map, which goes on beyond 180 degrees. */
export const placeOn = ({ lng, lat }: { lng: number; lat: number }): Place => ({ lat, lon: beside(lng, 0) });
