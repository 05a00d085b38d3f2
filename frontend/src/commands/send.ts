// Sending a command and telling what became of it, at the place where it was given.
import { effect, signal } from "@preact/signals";
import { newCommandId } from "../sources/api";
import { RequestFailed, refusal, unreachable } from "../sources/problem";
import type { Source } from "../sources/source";
import { source } from "../state/connection";
import { fenceOf } from "../state/control";
import type { Command, CommandReply, Problem } from "../wire";

/** Where on the page an answer belongs. */
export type Desk = "bar" | "control" | "plan" | "proposal" | "start" | "sweep" | "alerts" | "area" | "truth" | "order";

export const problems = signal<Partial<Record<Desk, Problem>>>({});

/** What was refused in one mission says nothing of another, but the bar speaks of what flies. */
effect(() => {
  void source.value;
  const { bar } = problems.peek();
  problems.value = bar ? { bar } : {};
});

export function report(desk: Desk, problem: Problem | null): void {
  const { [desk]: _old, ...others } = problems.value;
  problems.value = problem ? { ...others, [desk]: problem } : others;
}

export const asFailure = (error: unknown): RequestFailed =>
  error instanceof RequestFailed ? error : unreachable(error instanceof Error ? error.message : String(error));

export const asProblem = (error: unknown): Problem => asFailure(error).problem;

const LOOKS = 60;
const LOOK_MS = 50;

interface Steering {
  /** Still, once control is taken. */
  isWanted?: () => boolean;
  press?: number;
  newId?: () => string;
}

/** When nobody controls the search, whoever orders takes control first: the order is a deliberate act already. */
export async function steered(
  from: Source,
  missionId: string,
  command: Command,
  { isWanted = () => true, press, newId = newCommandId }: Steering = {},
): Promise<CommandReply> {
  const reply = await from.send(missionId, command, { commandId: newId(), press, fence: fenceOf(missionId) });
  if (reply.accepted || reply.reason?.code !== "control_free") return reply;
  const taken = await from.send(missionId, { kind: "take_control" });
  if (!taken.accepted) return taken;
  const fence = await fenceComes(missionId);
  return isWanted() ? from.send(missionId, command, { commandId: newId(), press, fence }) : reply;
}

/** The change of hands comes as an event, a moment after the answer. */
async function fenceComes(missionId: string): Promise<number | null> {
  for (let looks = 0; looks < LOOKS && fenceOf(missionId) === null; looks++) await new Promise((resolve) => setTimeout(resolve, LOOK_MS));
  return fenceOf(missionId);
}

/** True when the server accepted it; otherwise the reason stands at `desk`. */
export async function send(desk: Desk, missionId: string, command: Command): Promise<boolean> {
  const from = source.peek();
  if (!from) return false;
  const tell = (problem: Problem) => {
    if (desk === "bar" || source.peek() === from) report(desk, problem);
  };
  report(desk, null);
  try {
    const reply = await steered(from, missionId, command);
    if (reply.accepted) return true;
    tell(refusal(reply.reason));
  } catch (error) {
    tell(asProblem(error));
  }
  return false;
}
