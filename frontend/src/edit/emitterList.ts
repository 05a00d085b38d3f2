// A list of frequencies, one a line, as people have it in a notebook, and the emitters of the search that it stands for.
import { type MessageKey, t } from "../i18n";
import type { EmitterSpec } from "../wire";

/** Key of the raw text in the draft, while a line of it is not understood. */
export const LIST = "emitters";
export const MOST_EMITTERS = 32;

const HZ: Record<string, number> = { hz: 1, khz: 1e3, mhz: 1e6, ghz: 1e9 };
/** MHz unless a unit is written; behind a slash a tag's period in seconds; what follows is the name. */
const LINE = /^([\d.,]*[\d.])\s*(hz|khz|mhz|ghz)?(?:\s*\/\s*([\d.,]+)\s*s?)?(?:[\s;,:]+(.*))?$/i;
/** A name that would be read as a unit or a period stands behind a colon. */
const LIKE_UNIT = /^([kmg]?hz\b|\/)/i;
/** Behind the name: where it stands in the order of importance, 1 first. */
const PRIORITY = /\s!(\d{1,9})$/;
const LONGEST_PERIOD_S = 60;

export interface BadLine {
  line: number;
  problem: Extract<MessageKey, `edit.list.bad.${string}`>;
  text: string;
}

export interface EmitterList {
  emitters: EmitterSpec[];
  bad: BadLine[];
}

export const shownMhz = (hz: number): string => String(Number((hz / 1e6).toPrecision(12)));

/** Periods are shown where they differ. */
export function listOf(emitters: readonly EmitterSpec[]): string {
  const alike = new Set(emitters.map((e) => (e.kind === "pulsed" ? e.pulse_period_s : 0))).size === 1;
  const period = (e: EmitterSpec) => (alike || e.kind !== "pulsed" ? "" : `/${e.pulse_period_s}`);
  const rank = (e: EmitterSpec) => (e.priority ? ` !${e.priority}` : "");
  return emitters
    .map((e) => `${shownMhz(e.frequency_hz)}${period(e)}${LIKE_UNIT.test(e.label) ? ":" : ""} ${e.label}${rank(e)}`)
    .join("\n");
}

interface Read {
  hz: number;
  /** null: as the others. */
  periodS: number | null;
  name: string;
  priority: number | null;
}

function positive(digits: string | undefined): number | null {
  const plain = digits?.replace(",", ".") ?? "";
  return /^(\d+\.?\d*|\.\d+)$/.test(plain) ? Number(plain) : null;
}

function frequency(line: string): Read | null {
  const ranked = PRIORITY.exec(line)?.[1];
  const [, digits, unit, period, name] = LINE.exec(line.replace(PRIORITY, "")) ?? [];
  const [value, periodS] = [positive(digits), positive(period)];
  if (value === null || (period !== undefined && periodS === null)) return null;
  const hz = Number((value * HZ[(unit ?? "MHz").toLowerCase()]!).toPrecision(12));
  return { hz, periodS, name: (name ?? "").trim(), priority: ranked === undefined ? null : Number(ranked) };
}

const sendsAlike = (a: EmitterSpec, b: EmitterSpec): boolean =>
  a.frequency_hz === b.frequency_hz && (a.kind !== "pulsed" || b.kind !== "pulsed" || a.pulse_period_s === b.pulse_period_s);

function problemOf(found: Read | null, emitters: readonly EmitterSpec[]): BadLine["problem"] | null {
  if (!found) return "edit.list.bad.frequency";
  if (!(found.hz > 0 && found.hz <= 1e12)) return "edit.list.bad.range";
  if (found.name.length > 80) return "edit.list.bad.name";
  if (found.priority !== null && !(found.priority >= 1 && found.priority <= MOST_EMITTERS)) return "edit.list.bad.priority";
  if (found.periodS !== null && !(found.periodS > 0 && found.periodS <= LONGEST_PERIOD_S)) return "edit.list.bad.period";
  return emitters.length === MOST_EMITTERS ? "edit.list.bad.many" : null;
}

/** A frequency that was in the list before keeps its emitter, of several there the one of that period; a new one is like
 * the first, under an id of its own. */
export function readList(text: string, before: readonly EmitterSpec[]): EmitterList {
  const [emitters, bad, first] = [[] as EmitterSpec[], [] as BadLine[], before[0]!];
  const taken = new Set(before.map((e) => e.emitter_id));
  const freshId = () => {
    let number = 1;
    while (taken.has(`emitter-${number}`)) number += 1;
    taken.add(`emitter-${number}`);
    return `emitter-${number}`;
  };
  for (const [index, raw] of text.split(/\r?\n/).entries()) {
    const line = raw.trim();
    if (line === "") continue;
    const found = frequency(line);
    const problem = problemOf(found, emitters);
    if (problem !== null || found === null) {
      bad.push({ line: index + 1, problem: problem ?? "edit.list.bad.frequency", text: line.slice(0, 40) });
      continue;
    }
    const there = before.filter((e) => e.frequency_hz === found.hz && !emitters.some((o) => o.emitter_id === e.emitter_id));
    const known = there.find((e) => found.periodS === null || e.pulse_period_s === found.periodS) ?? there[0];
    const label = found.name || known?.label || first.label;
    const rhythm = found.periodS === null ? {} : { kind: "pulsed" as const, pulse_period_s: found.periodS };
    const read = { ...(known ?? { ...first, emitter_id: "", frequency_hz: found.hz }), ...rhythm, label, priority: found.priority };
    if (emitters.some((e) => sendsAlike(e, read))) {
      bad.push({ line: index + 1, problem: "edit.list.bad.twice", text: line.slice(0, 40) });
      continue;
    }
    emitters.push({ ...read, emitter_id: read.emitter_id || freshId() });
  }
  return { emitters, bad };
}

export const badLineWords = ({ line, problem, text }: BadLine): string => t("edit.list.line", { line, text, problem: t(problem) });
