// Leaves something out of the belief, or counts it again: a bearing, a turn, a leg, or all that somebody sent.
import { useEffect, useRef } from "preact/hooks";
import { problems, report, send } from "../commands/send";
import { type MessageKey, t } from "../i18n";
import { TAP_MS } from "../state/tap";
import type { Command, Problem } from "../wire";

/** What was accepted and is not told by then was undone at once by another console. */
const UNTOLD_MS = 5000;

interface Ordering {
  id: string;
  /** What it is about, and whether that is left out now: once either is another, the next press counts. */
  about: string;
  leftOut: boolean;
  order: Command;
  testId: string;
  isPressed?: boolean;
  words: string;
}

export function OrderButton({ id, about, leftOut, order, testId, isPressed, words }: Ordering) {
  const asked = useRef(false);
  const pressedAt = useRef(Number.NEGATIVE_INFINITY);
  const refused = useRef<{ about: string; problem: Problem | undefined } | null>(null);
  useEffect(() => {
    asked.current = false;
    // it stands as was wanted: what was refused says nothing more
    if (refused.current?.about === about && refused.current.problem === problems.peek().sweep) report("sweep", null);
    refused.current = null;
  }, [about, leftOut]);
  const press = async ({ timeStamp }: Event) => {
    if (asked.current || timeStamp - pressedAt.current < TAP_MS) return; // a thumb's second tap would be refused, or undo it
    pressedAt.current = timeStamp;
    asked.current = true;
    const again = () => {
      if (pressedAt.current === timeStamp) asked.current = false;
    };
    if (await send("sweep", id, order)) setTimeout(again, UNTOLD_MS);
    else {
      refused.current = { about, problem: problems.peek().sweep };
      again();
    }
  };
  return (
    <button type="button" class="small" data-testid={testId} aria-pressed={isPressed} onClick={press}>
      {words}
    </button>
  );
}

/** of: the bearing, the sweep of a turn that heard nothing, or the leg. */
export function CountButton({ id, of, leftOut, words }: { id: string; of: string; leftOut: boolean; words: MessageKey }) {
  const order = leftOut
    ? ({ kind: "include_bearing", bearing_id: of } as const)
    : ({ kind: "exclude_bearing", bearing_id: of, reason: "" } as const);
  return <OrderButton id={id} about={of} leftOut={leftOut} order={order} testId={leftOut ? "include" : "exclude"} words={t(words)} />;
}
