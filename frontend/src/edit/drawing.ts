// What the pointer draws on the map now: search area, fence or no-fly area, as polygon or rectangle, or corners moved.
import { signal } from "@preact/signals";
import { t } from "../i18n";
import * as api from "../sources/api";
import { localProblem, RequestFailed } from "../sources/problem";
import { areaOf, polygonsOf, type Rings } from "../state/areas";
import { beside } from "../state/geometry";
import { TAP_MS } from "../state/tap";
import type { Area } from "../wire";
import { type Draft, draft, forget, update } from "./draft";
import { set } from "./path";
import { forgetSaving } from "./saving";

export type What = "area" | "fence" | "noFly";
export type Tool = "none" | "polygon" | "rectangle" | "corners";

export const what = signal<What>("area");
export const tool = signal<Tool>("none");

const zone = (rings: Rings): Area => ({ type: "Polygon", coordinates: rings });

const keepOff = (now: Draft, zones: Area[]): void => update({ ...now, spec: set(now.spec, "flight.no_fly", zones) });

/** What is drawn or imported takes the place of the area that is there, instead of joining it. */
export const replaces = signal(false);

/** Parts that overlap become one: their ground is searched, and counted, once. The server knows how. */
async function unite(): Promise<void> {
  const before = draft.peek();
  if (!before || polygonsOf(before.spec.area).length < 2) return;
  const united = await api.importArea(JSON.stringify(before.spec.area), "drawn.geojson").catch(() => null);
  const now = draft.peek();
  if (united && now?.spec.area === before.spec.area) update({ ...now, spec: { ...now.spec, area: united.area } });
}

/** A file that is being read, or parts that become one. */
interface Work {
  /** Of the draft that it is for; undefined: there was none yet, it is for the next one. */
  key: string | undefined;
  done: Promise<unknown>;
}

const settling = new Set<Work>();

function settle(done: Promise<unknown>, key = draft.peek()?.key): Work {
  const work = { key, done };
  const end = () => settling.delete(work);
  settling.add(work);
  done.then(end, end);
  return work;
}

/** Puts what is being read into the draft that is there now, unless that is left or discarded by then. Fails as the reading. */
export function addRead<T>(reading: Promise<T>, put: (found: T) => void): Promise<T> {
  const added = reading.then((found) => {
    if (settling.has(work) && (work.key === undefined || draft.peek()?.key === work.key)) put(found);
    return found;
  });
  const work = settle(added);
  return added;
}

/** Nothing that is still being read comes into the draft that takes its place. */
export function discard(key: string): void {
  for (const work of settling) if (work.key === key) settling.delete(work);
  forget(key);
  forgetSaving(key);
  if (draft.peek()?.key === key) draft.value = null;
}

/** What is put in or taken out while corners are moved would be undone by the next one that moves. */
function endMoving(): void {
  if (tool.peek() === "corners") tool.value = "none";
}

/** The Enter that finishes a drawing is the map's; not the one that is still pressed, nor of somebody who types or has gone
 * elsewhere. */
function focusMap(): void {
  const before = document.activeElement;
  if (before?.matches("input, textarea, select")) return;
  setTimeout(() => {
    if (document.activeElement === before) document.querySelector<HTMLElement>(".map-area canvas")?.focus();
  }, TAP_MS);
}

/** The draft, once corners are no longer moved, files are read and parts that overlap have become one. Fails as a reading,
 * and while something is being drawn. null: the page was left. */
export async function settledDraft(): Promise<Draft | null> {
  endMoving();
  const key = draft.peek()?.key;
  const isHere = () => draft.peek()?.key === key;
  const own = () => [...settling].filter((work) => work.key === undefined || work.key === key).map(({ done }) => done);
  while (isHere() && own().length > 0)
    await Promise.all(own()).catch((error: unknown) => {
      if (isHere()) throw error;
    });
  if (!isHere()) return null;
  if (tool.peek() !== "none") {
    focusMap();
    throw new RequestFailed(localProblem(t("edit.area"), t("edit.area.drawing")));
  }
  return draft.peek();
}

/** The map goes on beyond 180 degrees, a mission does not. */
const onEarth = (drawn: readonly Rings[]): Rings[] =>
  drawn.map((rings) => rings.map((ring) => ring.map(([lon, lat]) => [beside(lon, 0), lat])));

/** Puts polygons into the draft: they replace the suggested area, or any when they are to, else they are added. */
export function add(kind: What, drawn: readonly Rings[]): void {
  endMoving();
  const now = draft.peek();
  const polygons = onEarth(drawn);
  if (!now || polygons.length === 0) return;
  const { area, flight } = now.spec;
  if (kind === "area") {
    const joined = areaOf(now.hasArea && !now.suggested && !replaces.peek() ? [...polygonsOf(area), ...polygons] : polygons)!;
    update({ ...now, hasArea: true, suggested: false, spec: { ...now.spec, area: joined } });
    settle(unite());
  } else if (kind === "fence") {
    update({ ...now, spec: set(now.spec, "flight.fence", areaOf(polygons)) });
  } else {
    keepOff(now, [...(flight.no_fly as Area[]), ...polygons.map(zone)]);
  }
}

export function remove(kind: What, index = 0): void {
  endMoving();
  const now = draft.peek();
  if (!now) return;
  if (kind === "area") update({ ...now, hasArea: false, suggested: false });
  else if (kind === "fence") update({ ...now, spec: set(now.spec, "flight.fence", null) });
  else keepOff(now, now.spec.flight.no_fly.filter((_, i) => i !== index) as Area[]);
}

/** Replaces all polygons of a kind after their corners were moved. */
export function replace(kind: What, drawn: readonly Rings[]): void {
  const now = draft.peek();
  const polygons = onEarth(drawn);
  const joined = areaOf(polygons);
  if (!now || !joined) return;
  if (kind === "area") {
    update({ ...now, suggested: false, spec: { ...now.spec, area: joined } });
    settle(unite());
  } else if (kind === "fence") update({ ...now, spec: set(now.spec, "flight.fence", joined) });
  else keepOff(now, polygons.map(zone));
}

export function polygonsOfKind(kind: What): Rings[] {
  const now = draft.peek();
  if (!now) return [];
  if (kind === "area") return now.hasArea ? polygonsOf(now.spec.area) : [];
  if (kind === "fence") return now.spec.flight.fence ? polygonsOf(now.spec.flight.fence as Area) : [];
  return (now.spec.flight.no_fly as Area[]).flatMap(polygonsOf);
}
