// In the place of MapLibre's decoder of its own tile format, 17 kB: the server takes no packages of it (backend/maps/archive.py).
export const GEOMETRY_TYPE = {};

export function decodeTile(): never {
  throw new Error("these tiles are in a format that this server does not serve: bring MVT or pictures");
}
