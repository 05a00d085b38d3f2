// What is being typed: kept in the browser until the server has taken it, so that nothing is lost.
import { signal } from "@preact/signals";
import { drop, keep, kept } from "../state/kept";
import type { MissionSpec } from "../wire";
import { set } from "./path";

export interface Draft {
  /** "new", "new:ID" of a mission that is used again, or the id of the one that is edited. */
  key: string;
  spec: MissionSpec;
  /** Of the stored specification that it began from; none: nothing is stored yet. */
  fromSeq?: number;
  hasArea: boolean;
  /** The area is the server's suggestion: the first one drawn takes its place. */
  suggested: boolean;
  /** Raw text of fields whose text is not (yet) a number or a place, by path. */
  text: Record<string, string>;
}

const storageKey = (key: string) => `crossfix.draft.${key}`;

export const draft = signal<Draft | null>(null);

/** Paths of the fields that are on the page: what was typed into others is asked for no more. */
export const shownFields = new Set<string>();

/** Is there a field on the page whose text is not understood? */
export const isUnread = ({ text }: Draft): boolean => Object.keys(text).some((path) => shownFields.has(path));

/** null when there is none, or one of an older page. */
export function storedDraft(key: string): Draft | null {
  const stored = kept(storageKey(key));
  if (!stored) return null;
  try {
    const parsed = JSON.parse(stored) as Draft;
    return parsed.key === key && parsed.spec?.area && parsed.spec.emitters?.length > 0 ? parsed : null;
  } catch {
    return null;
  }
}

/** False: the draft as it is now lives as long as the page, and an older one may be stored. */
export const isStored = signal(true);

/** Kept from the first change on. */
export function begin(fresh: Draft): void {
  draft.value = fresh;
  isStored.value = true;
}

export function update(next: Draft): void {
  draft.value = next;
  isStored.value = keep(storageKey(next.key), next);
}

export function forget(key: string): void {
  drop(storageKey(key));
}

/** Once the server has it; what was begun meanwhile in its place stays. */
export function forgetSent(key: string, spec: MissionSpec): void {
  if (!isStored.peek() || JSON.stringify(storedDraft(key)?.spec) === JSON.stringify(spec)) forget(key);
}

/** Raw text without that of fields whose value is another one now. */
export const textBeside = (text: Draft["text"], isReplaced: (path: string) => boolean): Draft["text"] =>
  Object.fromEntries(Object.entries(text).filter(([path]) => !isReplaced(path)));

/** Raw text below the path was of what has been replaced. */
export function change(path: string, value: unknown): void {
  const now = draft.peek();
  if (now) update({ ...now, spec: set(now.spec, path, value), text: textBeside(now.text, (at) => at.startsWith(`${path}.`)) });
}

/** Keeps what was typed; null: the text was understood and is forgotten. */
export function type(path: string, text: string | null): void {
  const now = draft.peek();
  if (!now) return;
  const others = textBeside(now.text, (at) => at === path);
  update({ ...now, text: text === null ? others : { ...others, [path]: text } });
}
