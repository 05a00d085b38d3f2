// The operator's own next place: asked what it costs first, flown to only after a slide.
import { signal } from "@preact/signals";
import { source } from "../state/connection";
import { liveMission } from "../state/moment";
import type { ExpectedTime, Place, Problem } from "../wire";
import { asProblem, report, send } from "./send";

export interface Proposal {
  place: Place;
  result: ExpectedTime | null;
  problem: Problem | null;
  /** It was compared with the planner's own choice, not with what an operator chose before. */
  withPlanner: boolean;
}

export const proposal = signal<Proposal | null>(null);

let asking: AbortController | null = null;

export function propose(place: Place): void {
  const from = source.peek();
  const id = liveMission.peek().missionId;
  if (!from || !id) return;
  asking?.abort();
  asking = new AbortController();
  const { signal: aborted } = asking;
  report("proposal", null);
  const planned = liveMission.peek().plan?.fact;
  const withPlanner = planned?.source !== "operator";
  proposal.value = { place, result: null, problem: null, withPlanner };
  void from.expectedTime(id, place, aborted, planned?.place).then(
    (result) => {
      if (!aborted.aborted) proposal.value = { place, result, problem: null, withPlanner };
    },
    (error: unknown) => {
      if (!aborted.aborted) proposal.value = { place, result: null, problem: asProblem(error), withPlanner };
    },
  );
}

export function cancelProposal(): void {
  asking?.abort();
  proposal.value = null;
}

export async function confirmProposal(): Promise<void> {
  const chosen = proposal.peek();
  const { missionId: id, craftId } = liveMission.peek();
  if (!chosen || !id) return;
  const { place } = chosen;
  const isAccepted = await send("proposal", id, { kind: "override", craft_id: craftId, place });
  if (isAccepted && proposal.peek()?.place === place) proposal.value = null;
}
