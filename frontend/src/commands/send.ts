// Sending a command and telling what became of it, at the place where it was given.
import { signal } from "@preact/signals";
import { RequestFailed, refusal, unreachable } from "../sources/problem";
import { source } from "../state/connection";
import type { Command, Problem } from "../wire";

/** Where on the page an answer belongs. */
export type Desk = "bar" | "plan" | "proposal" | "start" | "sweep" | "alerts" | "area";

export const problems = signal<Partial<Record<Desk, Problem>>>({});

export function report(desk: Desk, problem: Problem | null): void {
  const { [desk]: _old, ...others } = problems.value;
  problems.value = problem ? { ...others, [desk]: problem } : others;
}

export const asProblem = (error: unknown): Problem =>
  error instanceof RequestFailed ? error.problem : unreachable(error instanceof Error ? error.message : String(error)).problem;

/** True when the server accepted it; otherwise the reason stands at `desk`. */
export async function send(desk: Desk, missionId: string, command: Command): Promise<boolean> {
  const from = source.peek();
  if (!from) return false;
  report(desk, null);
  try {
    const reply = await from.send(missionId, command);
    if (reply.accepted) return true;
    report(desk, refusal(reply.reason));
  } catch (error) {
    report(desk, asProblem(error));
  }
  return false;
}
