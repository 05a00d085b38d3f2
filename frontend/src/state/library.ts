// The list of missions as far as it was read: the first page again and again, the others as they are asked for.
import type { MissionList, MissionSummary } from "../wire";

/** What is asked of the list; "" for any. box: west,south,east,north. since, until: days, until included. */
export interface Filter {
  named: string;
  emitter: string;
  vehicle: string;
  outcome: string;
  box: string;
  since: string;
  until: string;
  deleted: boolean;
}

export const ANY: Filter = { named: "", emitter: "", vehicle: "", outcome: "", box: "", since: "", until: "", deleted: false };

const DAY_MS = 86_400_000;

/** "" for what is no day of a year of four digits. */
function midnight(day: string, later = 0): string {
  const at = Date.parse(`${day}T00:00:00Z`) + later;
  return at < Date.UTC(9999, 11, 31) ? new Date(at).toISOString() : "";
}

/** As the address of the list says it: what is asked, and nothing besides. */
export function asQuery({ since, until, deleted, ...words }: Filter): Record<string, string> {
  const asked = { ...words, since: midnight(since), until: midnight(until, DAY_MS), deleted: deleted ? "true" : "" };
  return Object.fromEntries(Object.entries(asked).flatMap(([name, said]) => (said.trim() === "" ? [] : [[name, said.trim()]])));
}

export interface Library {
  readonly named: string;
  readonly missions: readonly MissionSummary[];
  /** What asks for the missions that follow; null: there are none. */
  readonly next: string | null;
  /** Has a further page than the first been read? */
  readonly further: boolean;
}

/** With the first page, read again: what it pushed out of it is kept, and what follows is still known. */
export function withFirstPage(before: Library | null, named: string, page: MissionList): Library {
  if (before === null || before.named !== named || !before.further) {
    return { named, missions: page.missions, next: page.next, further: false };
  }
  return { ...before, missions: merged(page.missions, before.missions) };
}

export function withNextPage(before: Library, page: MissionList): Library {
  return { ...before, missions: merged(page.missions, before.missions), next: page.next, further: true };
}

/** By id; of one that is in both, what was read now. */
function merged(now: readonly MissionSummary[], before: readonly MissionSummary[]): MissionSummary[] {
  const known = new Map([...before, ...now].map((mission) => [mission.mission_id, mission]));
  return [...known.values()].sort((a, b) => b.drafted_at_utc.localeCompare(a.drafted_at_utc) || (a.mission_id < b.mission_id ? -1 : 1));
}
