// A list of frequencies, one a line, as people have it in a notebook, and the emitters of the search that it stands for.
import { type MessageKey, t } from "../i18n";
import type { EmitterSpec } from "../wire";

/** Key of the raw text in the draft, while a line of it is not understood. */
export const LIST = "emitters";
export const MOST_EMITTERS = 32;

const HZ: Record<string, number> = { hz: 1, khz: 1e3, mhz: 1e6, ghz: 1e9 };
/** MHz unless a unit is written; what follows is the name. */
const LINE = /^([\d.,]+)\s*(hz|khz|mhz|ghz)?(?:[\s;,:]+(.*))?$/i;
/** Behind the name: where it stands in the order of importance, 1 first. */
const PRIORITY = /\s!(\d{1,9})$/;

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

export const listOf = (emitters: readonly EmitterSpec[]): string =>
  emitters.map(({ frequency_hz, label, priority }) => `${shownMhz(frequency_hz)} ${label}${priority ? ` !${priority}` : ""}`).join("\n");

interface Read {
  hz: number;
  name: string;
  priority: number | null;
}

function frequency(line: string): Read | null {
  const ranked = PRIORITY.exec(line)?.[1];
  const [, digits, unit, name] = LINE.exec(line.replace(PRIORITY, "")) ?? [];
  const plain = digits?.replace(",", ".") ?? "";
  if (!/^(\d+\.?\d*|\.\d+)$/.test(plain)) return null;
  const hz = Number((Number(plain) * HZ[(unit ?? "MHz").toLowerCase()]!).toPrecision(12));
  return { hz, name: (name ?? "").trim(), priority: ranked === undefined ? null : Number(ranked) };
}

function problemOf(found: Read | null, emitters: readonly EmitterSpec[]): BadLine["problem"] | null {
  if (!found) return "edit.list.bad.frequency";
  if (!(found.hz > 0 && found.hz <= 1e12)) return "edit.list.bad.range";
  if (found.name.length > 80) return "edit.list.bad.name";
  if (found.priority !== null && !(found.priority >= 1 && found.priority <= MOST_EMITTERS)) return "edit.list.bad.priority";
  if (emitters.some((e) => e.frequency_hz === found.hz)) return "edit.list.bad.twice";
  return emitters.length === MOST_EMITTERS ? "edit.list.bad.many" : null;
}

/** A frequency that was in the list before keeps its emitter; a new one is like the first, under an id of its own. */
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
    const known = before.find((e) => e.frequency_hz === found.hz);
    const label = found.name || known?.label || first.label;
    emitters.push({ ...(known ?? { ...first, emitter_id: freshId(), frequency_hz: found.hz }), label, priority: found.priority });
  }
  return { emitters, bad };
}

export const badLineWords = ({ line, problem, text }: BadLine): string => t("edit.list.line", { line, text, problem: t(problem) });
