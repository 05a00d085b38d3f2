// The order of importance among emitters: groups one after the other, those of a group alike, the last one without a number.
import { t } from "../i18n";
import type { EmitterSpec } from "../wire";
import { emitterName } from "./emitterName";

/** By emitter id, 1 first; one that is not named comes last. */
export type Priorities = Readonly<Record<string, number>>;

type Groups = readonly (readonly string[])[];

/** Ids by importance; one group: all alike. */
export function groupsOf(emitters: readonly EmitterSpec[]): Groups {
  const rank = (emitter: EmitterSpec) => emitter.priority ?? Number.POSITIVE_INFINITY;
  const ranks = [...new Set(emitters.map(rank))].sort((a, b) => a - b);
  return ranks.map((of) => emitters.filter((emitter) => rank(emitter) === of).map(({ emitter_id: id }) => id));
}

/** As a specification has them. */
export const prioritiesOf = (emitters: readonly EmitterSpec[]): Priorities =>
  Object.fromEntries(emitters.flatMap(({ emitter_id: id, priority }) => (priority ? [[id, priority]] : [])));

/** The last group has no number: it comes after all others anyway. */
const numbered = (groups: Groups): Priorities =>
  Object.fromEntries(groups.slice(0, -1).flatMap((ids, index) => ids.map((id) => [id, index + 1])));

/** Its place in the order, from 1; null: all are alike, or it comes last. */
export function placeOf(emitters: readonly EmitterSpec[], id: string): number | null {
  const groups = groupsOf(emitters);
  const index = groups.findIndex((ids) => ids.includes(id));
  return index >= 0 && index < groups.length - 1 ? index + 1 : null;
}

const without = (groups: Groups, id: string): string[][] => groups.map((ids) => ids.filter((other) => other !== id));

/** Ahead of all others. */
export function putFirst(emitters: readonly EmitterSpec[], id: string): Priorities {
  return numbered([[id], ...without(groupsOf(emitters), id).filter((ids) => ids.length > 0)]);
}

/**
 * Half a step: ahead of those it is alike with, else alike with the group before (sooner) or behind. null: there is no
 * such step.
 */
export function move(emitters: readonly EmitterSpec[], id: string, by: "sooner" | "later"): Priorities | null {
  const groups = groupsOf(emitters);
  const at = groups.findIndex((ids) => ids.includes(id));
  const rest = without(groups, id);
  if (groups[at]!.length > 1) return numbered(rest.toSpliced(by === "sooner" ? at : at + 1, 0, [id]));
  const to = at + (by === "sooner" ? -1 : 1);
  if (to < 0 || to >= groups.length) return null;
  rest[to] = [...rest[to]!, id];
  return numbered(rest.filter((ids) => ids.length > 0));
}

/** As a specification holds it. */
export const inOrder = (emitters: readonly EmitterSpec[], priorities: Priorities): EmitterSpec[] =>
  emitters.map((emitter) => ({ ...emitter, priority: priorities[emitter.emitter_id] ?? null }));

/** "hare 3, then hare 1 and hare 2; then the others". */
export function importanceWords(emitters: readonly EmitterSpec[], priorities: Priorities): string {
  const groups = groupsOf(inOrder(emitters, priorities));
  if (groups.length < 2) return t("order.alike");
  const unnamed = groups.at(-1)!.some((id) => priorities[id] === undefined);
  const named = (unnamed ? groups.slice(0, -1) : groups).map((ids) => ids.map((id) => emitterName(emitters, id)).join(t("order.and")));
  return [...named, ...(unnamed ? [t("order.others")] : [])].join(t("order.then"));
}
