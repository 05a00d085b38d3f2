// How the operator wants quantities and places written; the settings keep it.
import { signal } from "@preact/signals";
import type { CoordinateFormat } from "./coordinates";
import type { UnitSystem } from "./quantities";

export const unitSystem = signal<UnitSystem>("metric");

export const coordinateFormat = signal<CoordinateFormat>("dd");
