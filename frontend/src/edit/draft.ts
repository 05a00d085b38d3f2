// What is being typed: kept in the browser until the server has taken it, so that nothing is lost.
import { signal } from "@preact/signals";
import type { MissionSpec } from "../wire";
import { set } from "./path";

export interface Draft {
  /** "new", or the id of the mission that is edited. */
  key: string;
  spec: MissionSpec;
  hasArea: boolean;
  /** The area is the server's suggestion: the first one drawn takes its place. */
  suggested: boolean;
  /** Raw text of fields whose text is not (yet) a number or a place, by path. */
  text: Record<string, string>;
}

const storageKey = (key: string) => `crossfix.draft.${key}`;

export const draft = signal<Draft | null>(null);

/** null when there is none, or one of an older page. */
export function storedDraft(key: string): Draft | null {
  const stored = localStorage.getItem(storageKey(key));
  if (!stored) return null;
  try {
    const parsed = JSON.parse(stored) as Draft;
    return parsed.key === key && parsed.spec?.area && parsed.spec.emitters?.length > 0 ? parsed : null;
  } catch {
    return null;
  }
}

export function update(next: Draft): void {
  draft.value = next;
  localStorage.setItem(storageKey(next.key), JSON.stringify(next));
}

export function forget(key: string): void {
  localStorage.removeItem(storageKey(key));
}

export function change(path: string, value: unknown): void {
  const now = draft.peek();
  if (now) update({ ...now, spec: set(now.spec, path, value) });
}

/** Keeps what was typed; null: the text was understood and is forgotten. */
export function type(path: string, text: string | null): void {
  const now = draft.peek();
  if (!now) return;
  const { [path]: _old, ...others } = now.text;
  update({ ...now, text: text === null ? others : { ...others, [path]: text } });
}
